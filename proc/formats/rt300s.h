#pragma once
// Scans of an RT-300S goniophotometer: the raw readings as CSV, with the columns azimuth_deg,
// incidence_deg, receive_deg and RT, one row per reading; and its JDV text export, whose values
// the instrument calls BRDF. Angles are the instrument's: azimuth and receive are the plane through
// the normal and the signed angle in it (proc/formats/rt300s_brdf.h has the geometry).
//
// Negative readings are what the instrument gives without light, and its exports hold zeros and
// numbers of any size where nothing was measured: all are read, and counted in the warnings.

#include <string>
#include <string_view>
#include <vector>

#include "proc/core/result.h"
#include "proc/formats/file_read.h"

namespace gonio::proc {

struct Rt300sReading {
    double azimuthDeg = 0;    ///< [-360, 360]
    double incidenceDeg = 0;  ///< [0, 90)
    double receiveDeg = 0;    ///< (-90, 90)
    double value = 0;         ///< RT: relative signal; in JDV: 1/sr
};

/// Each triple of angles once.
struct Rt300sScan {
    std::vector<Rt300sReading> readings;
};

/// `name` stands in errors: "rt300s: NAME: line 12: RT: 'banana', wanted a number". Columns in any
/// order; others are refused, and two readings at the same angles.
[[nodiscard]] Result<FileRead<Rt300sScan>> parseRt300sCsv(std::string_view text,
                                                          std::string_view name);

/// One block of a JDV file: one incidence.
struct JdvBlock {
    std::string sampleId;
    std::string date;
    Rt300sScan scan;
};

/// "jdv: NAME: line 12: ..."; lines end in a bare CR, LF or both, fields in tabs. The grid of a
/// block must be the one that its Polar and Azimuth lines (first, last, step) promise. An incidence
/// may come again: the export of several runs.
[[nodiscard]] Result<FileRead<std::vector<JdvBlock>>> parseJdv(std::string_view text,
                                                               std::string_view name);

/// The text is a JDV export.
[[nodiscard]] bool isJdv(std::string_view text);

}  // namespace gonio::proc
