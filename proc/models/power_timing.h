#pragma once
// Time of one evaluation of each form of powers.h, in loops over 4096 powers and cosines, per
// number type and kind of code: one at a time, or as many as an instruction set holds. The vector
// loops are compiled for each instruction set and run where the processor has it; the models' own
// loops (kernel_model.h) run the richest of them. n is drawn evenly in its logarithm out of
// 8..1000, n (1 - cos) evenly out of 0..12. A loop is given n and cos, and takes 1 - cos from it
// where a form needs that, as the published forms do. The cubic's coefficients, of n alone, are
// worked out beforehand, and their time is not counted. The least of all repeats counts; they are
// taken in turn, so that a disturbance meets every form.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proc/core/stopwatch.h"
#include "proc/models/power_errors.h"

namespace gonio::proc {

enum class PowerCode {
    Scalar,    ///< one at a time, x86-64
    Baseline,  ///< x86-64: 128 bits
    Avx2,      ///< x86-64-v3: 256 bits
    Avx512     ///< x86-64-v4: 256 bits and the newer instructions, as compilers choose
};
[[nodiscard]] std::string_view name(PowerCode code);
/// Those that this processor runs.
[[nodiscard]] std::vector<PowerCode> powerCodes();

struct PowerTime {
    std::string form;  ///< of powers.h, or "std::pow"
    Precision precision = Precision::Double;
    PowerCode code = PowerCode::Scalar;
    double nanoseconds = 0;
};

struct TimingEffort {
    int repeats = 40;
    Seconds each{200e-6};  ///< of one repeat of one loop, about
};

/// A step for each repeat.
[[nodiscard]] std::vector<PowerTime> timePowers(const Stopwatch& watch,
                                                const TimingEffort& effort,
                                                const StudyProgress& progress = {});

/// Between the values of one form in the loops of all codes, in units of its peak: the loops work
/// the same numbers out. What the library rounds otherwise counts, too.
[[nodiscard]] double largestLoopDifference();

/// A published form with which none of ours keeps up: each has a larger error or takes longer.
struct NotBeaten {
    PowerForm form = PowerForm::Bps;
    Precision precision = Precision::Double;
    PowerCode code = PowerCode::Scalar;
    double nanoseconds = 0;
    PowerForm ours = PowerForm::Sq8;  ///< the fastest that errs no more
    double oursNanoseconds = 0;
};

/// `errors` and `times` of all forms; the absolute error over n in 8..1000.
[[nodiscard]] std::vector<NotBeaten> notBeaten(std::span<const PowerErrors> errors,
                                               std::span<const PowerTime> times);

}  // namespace gonio::proc
