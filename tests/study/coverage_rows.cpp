#include "tests/study/coverage_rows.h"

#include <algorithm>
#include <cmath>

#include "proc/core/number_text.h"

namespace gonio::study {
namespace {

double sumOf(const std::vector<Tally>& repeats, double Tally::*part) {
    double sum = 0;
    for (const Tally& one : repeats) sum += one.*part;
    return sum;
}

double perCell(const std::vector<Tally>& repeats, double Tally::*part) {
    return sumOf(repeats, part) / sumOf(repeats, &Tally::cells);
}

/// Mean over the repeats of the share of their cells.
double meanShare(const std::vector<Tally>& repeats, double Tally::*part) {
    double sum = 0;
    for (const Tally& one : repeats) sum += one.*part / one.cells;
    return sum / static_cast<double>(repeats.size());
}

std::string percent(double share, int digits = 2) { return fixed(100 * share, digits); }

}  // namespace

double Row::coverage() const { return meanShare(repeats, &Tally::within); }
double Row::coverageRandom() const { return meanShare(repeats, &Tally::withinRandom); }
double Row::meanRelativeU() const { return perCell(repeats, &Tally::relativeU); }
double Row::meanRelativeError() const { return perCell(repeats, &Tally::relativeError); }
double Row::cells() const {
    return sumOf(repeats, &Tally::cells) / static_cast<double>(repeats.size());
}

double Row::standardError() const {
    const double mean = coverage();
    double squares = 0;
    for (const Tally& one : repeats) squares += std::pow(one.within / one.cells - mean, 2);
    const auto n = static_cast<double>(repeats.size());
    return std::sqrt(squares / (n * std::max(1.0, n - 1)));
}

std::string Row::name() const {
    return "1e" + std::to_string(decade) + " to 1e" + std::to_string(decade + 1);
}

CoverageRows::CoverageRows() {
    for (const bool flank : {false, true}) {
        for (int decade = kLowestDecade; decade <= kHighestDecade; ++decade) {
            rows_.push_back({.decade = decade, .flank = flank, .repeats = {}});
        }
    }
}

void CoverageRows::add(const std::vector<Verdict>& repeat) {
    std::vector<Tally> tallies(rows_.size());
    for (const Verdict& one : repeat) {
        const int decade = static_cast<int>(std::floor(std::log10(one.truth)));
        if (decade < kLowestDecade || decade > kHighestDecade) continue;
        const bool flank = one.slopePerDegree > kFlankPerDegree;
        const auto decades = static_cast<std::size_t>(kHighestDecade - kLowestDecade + 1);
        Tally& tally =
            tallies[static_cast<std::size_t>(decade - kLowestDecade) + (flank ? decades : 0)];
        const double off = std::abs(one.error);
        tally.cells += 1;
        tally.within += off <= kExpansion * one.u ? 1 : 0;
        tally.withinRandom += off <= kExpansion * one.uRandom ? 1 : 0;
        tally.relativeU += one.u / one.truth;
        tally.relativeError += one.error / one.truth;
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        if (tallies[i].cells > 0) rows_[i].repeats.push_back(tallies[i]);
    }
}

void CoverageRows::add(const CoverageRows& others) {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const std::vector<Tally>& more = others.rows_[i].repeats;
        rows_[i].repeats.insert(rows_[i].repeats.end(), more.begin(), more.end());
    }
}

std::string CoverageRows::markdown() const {
    std::string text =
        "| f, 1/sr | where | repeats | cells each | u, mean | mean error | within 1.96 u | "
        "standard "
        "error | within 1.96 u_random |\n|---|---|---|---|---|---|---|---|---|\n";
    for (const Row& row : rows_) {
        if (row.repeats.empty()) continue;
        text += "| " + row.name() + " | " + (row.flank ? "flank" : "even") + " | " +
                std::to_string(row.repeats.size()) + " | " + fixed(row.cells(), 0) + " | " +
                percent(row.meanRelativeU()) + " % | " + percent(row.meanRelativeError()) +
                " % | " + percent(row.coverage()) + " % | " + percent(row.standardError()) +
                " % | " + percent(row.coverageRandom(), 1) + " % |\n";
    }
    return text;
}

std::string CoverageRows::csv() const {
    std::string text =
        "decade,flank,repeats,cells_each,mean_relative_u,mean_relative_error,coverage,"
        "standard_error,coverage_random\n";
    for (const Row& row : rows_) {
        if (row.repeats.empty()) continue;
        text += std::to_string(row.decade) + "," + (row.flank ? "1" : "0") + "," +
                std::to_string(row.repeats.size());
        for (const double value : {row.cells(),
                                   row.meanRelativeU(),
                                   row.meanRelativeError(),
                                   row.coverage(),
                                   row.standardError(),
                                   row.coverageRandom()}) {
            text += "," + shortest(value);
        }
        text += "\n";
    }
    return text;
}

int binomialLow(int n, double p, double alarm) {
    double below = 0;
    for (int k = 0; k <= n; ++k) {
        below += std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) +
                          k * std::log(p) + (n - k) * std::log1p(-p));
        if (below >= alarm) return k;
    }
    return n;
}

}  // namespace gonio::study
