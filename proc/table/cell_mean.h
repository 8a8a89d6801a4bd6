#pragma once
// The mean of several measurements of one quantity. Each has, beside u_random and u_systematic, the
// part u_apart of both that the others do not share (its own noise, and what of u_systematic does
// not come from what they have in common). With weights w_i = 1 / u_apart,i^2, made to sum to 1,
//     f = sum w_i f_i,   u_random^2 = sum (w_i u_random,i)^2,   u_systematic = sum w_i
//     u_systematic,i:
// what is random averages down, what is systematic does not.
//
// Of three and more values one that is further than kOutlier u_apart from their median is weighed
// down by kOutlier over that distance [Huber1964]; none is dropped. Where one of the values is so
// far from the mean, the values contradict their uncertainties, and the mean is no better than they
// agree [Birge1932]: u_random is then at least
//     u_agreed = sqrt(chi^2 / (n - 1)) / sqrt(sum 1 / u_apart,i^2).
//
// Negative values are values. One value is its own mean, to the bit. An uncertainty below the
// rounding of a float is taken as that.

#include <optional>
#include <span>
#include <vector>

#include "proc/calibrate/cell_samples.h"
#include "proc/core/measured.h"
#include "proc/table/consistency.h"

namespace gonio::proc {

/// f and its uncertainties are finite.
struct CellValue {
    Measured<double> value;
    double uApart = 0;
};

struct CellMean {
    Measured<double> mean;
    ConsistencySum::Group group;
    /// Of each value from the mean, over the standard uncertainty of that difference,
    /// u_apart,i sqrt(1 - w_i).
    std::vector<double> away;

    double uAgreed = 0;  ///< 0 where no value is an outlier

    /// The mean's, and no less than u_agreed.
    [[nodiscard]] double uRandom() const;
};

/// A cell that can be averaged: present, with a value and uncertainties.
[[nodiscard]] bool canAverage(const CellSamples& cells, std::size_t cell);

/// At least one value.
[[nodiscard]] CellMean meanOf(std::span<const CellValue> values);

/// u_apart of a value that has the relative part `shared` of its u_systematic in common with the
/// others: sqrt(u_random^2 + u_systematic^2 - (shared f)^2), never below u_random.
[[nodiscard]] double apartFrom(const Measured<double>& value, double shared);

}  // namespace gonio::proc
