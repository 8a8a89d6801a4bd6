#pragma once
// How much brighter one capture's light is than that of others of the same state: k_i and its
// uncertainty as average.h has them.

#include <cstddef>
#include <span>
#include <vector>

#include "proc/calibrate/cell_samples.h"
#include "proc/table/cell_mean.h"
#include "proc/table/consistency.h"

namespace gonio::proc {

/// One state as one capture has it. The cells stay the capture's, for as long as it is averaged.
struct CapturePart {
    std::size_t capture = 0;
    const CellSamples* cells = nullptr;
    double shared = 0;  ///< relative part of u_systematic that the captures share
    double light = 0;   ///< relative part of one capture's light
    double scale = 1;   ///< k_i
};

/// The values of a cell that are there, and the scales of the captures that they are of.
struct PresentValues {
    std::vector<CellValue> values;
    std::vector<std::size_t> captures;
    std::vector<double> scales;
};
[[nodiscard]] PresentValues presentIn(std::span<const CapturePart> parts, std::size_t cell);
/// Each value and its uncertainties over its scale.
[[nodiscard]] PresentValues withoutLight(PresentValues present);

/// By part; empty, and without freedom, where the light cannot be told apart: of a single capture,
/// and where more than a third of the cells contradict each other but for a common factor.
struct CaptureLight {
    std::vector<double> scale;  ///< k_i
    std::vector<double> u;      ///< of k_i, k = 1
    std::vector<double> away;   ///< k_i - 1 over u(k_i - 1)
    ConsistencySum::Group group;
};
[[nodiscard]] CaptureLight lightOf(std::vector<CapturePart> parts);

}  // namespace gonio::proc
