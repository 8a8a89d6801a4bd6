#pragma once
// The rows of the coverage report: decades of f, apart where f is even and on lobe flanks. A row
// gathers, repeat by repeat, which share of its cells has the truth within 1.96 u. Cells of one
// repeat share their references' errors; repeats are independent, so the standard error of a row's
// coverage is that of the mean of its repeats' shares.

#include <array>
#include <string>
#include <vector>

namespace gonio::study {

inline constexpr int kLowestDecade = -4, kHighestDecade = 2;  // 1e-4 .. 1e3 1/sr
inline constexpr double kFlankPerDegree = 0.2;                // relative slope
inline constexpr double kExpansion = 1.96;

/// One measured cell against its truth.
struct Verdict {
    double truth = 0;           ///< 1/sr
    double slopePerDegree = 0;  ///< of the truth, relative
    double error = 0;           ///< f - truth
    double u = 0, uRandom = 0;  ///< k = 1
};

/// Of one repeat.
struct Tally {
    double cells = 0, within = 0, withinRandom = 0;
    double relativeU = 0;      ///< sum
    double relativeError = 0;  ///< sum, signed
};

struct Row {
    int decade = 0;  ///< f from 10^decade to 10^(decade + 1)
    bool flank = false;
    std::vector<Tally> repeats;  ///< that have cells in it

    [[nodiscard]] double coverage() const;
    [[nodiscard]] double standardError() const;
    [[nodiscard]] double coverageRandom() const;
    [[nodiscard]] double meanRelativeU() const;
    [[nodiscard]] double meanRelativeError() const;
    [[nodiscard]] double cells() const;
    [[nodiscard]] std::string name() const;
};

class CoverageRows {
public:
    CoverageRows();
    void add(const std::vector<Verdict>& repeat);
    void add(const CoverageRows& others);
    [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }

    [[nodiscard]] std::string markdown() const;
    [[nodiscard]] std::string csv() const;

private:
    std::vector<Row> rows_;
};

/// The largest count that n trials of probability p stay below with a chance of `alarm` at most.
[[nodiscard]] int binomialLow(int n, double p, double alarm);

}  // namespace gonio::study
