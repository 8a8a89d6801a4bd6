#include "proc/report/budget_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "proc/calibrate/budget_text.h"
#include "proc/core/median.h"
#include "proc/core/number_text.h"
#include "proc/report/plot_request.h"
#include "proc/report/report_words.h"
#include "proc/report/sample_cells.h"

namespace gonio::proc {
namespace {

constexpr double kHigh = 0.95;  // the percentile that stands beside a median

/// A component in all states that have it.
struct Line {
    BudgetComponent first;
    std::array<std::vector<double>, 3> relative;  ///< by band, of its states
    std::vector<double> sizes;
    std::optional<double> freedom;  ///< the least

    /// Median over the states of a band; empty where none says.
    [[nodiscard]] std::optional<double> of(Band band) const {
        const auto& own = relative[index(band)];
        return own.empty() ? std::nullopt : std::optional(median(own));
    }
};

std::vector<Line> linesOf(const std::vector<StateBudget>& states) {
    std::vector<Line> lines;
    for (const StateBudget& state : states) {
        for (const BudgetComponent& one : state.components) {
            auto own = std::find_if(lines.begin(), lines.end(), [&](const Line& line) {
                return line.first.name == one.name;
            });
            if (own == lines.end()) own = lines.insert(own, {one, {}, {}, {}});
            if (std::isfinite(one.medianRelative))
                own->relative[index(state.band)].push_back(one.medianRelative);
            own->sizes.push_back(one.size);
            if (one.freedom) own->freedom = std::min(*one.freedom, own->freedom.value_or(HUGE_VAL));
        }
    }
    return lines;
}

constexpr const char* kNotKnown = "not known";

/// Of the components that say what they do to a band.
struct Total {
    double variance = 0;
    std::size_t known = 0, lines = 0;

    [[nodiscard]] bool whole() const { return known == lines; }
};

Total totalOf(const std::vector<Line>& lines, Band band) {
    Total total{.variance = 0, .known = 0, .lines = lines.size()};
    for (const Line& line : lines) {
        const auto relative = line.of(band);
        if (!relative) continue;
        total.variance += *relative * *relative;
        ++total.known;
    }
    return total;
}

/// `times` the root of a total.
std::string rootText(const Total& total, double times) {
    if (total.known == 0) return kNotKnown;
    return (total.whole() ? "" : "at least ") + relativeText(times * std::sqrt(total.variance));
}

/// Mean over the bands, where all components are known, of what share of the variance a line is.
std::string shareOf(const Line& line,
                    const std::vector<Line>& lines,
                    const std::vector<Band>& bands) {
    double sum = 0, counted = 0;
    for (const Band band : bands) {
        const Total total = totalOf(lines, band);
        if (!total.whole() || !(total.variance > 0)) continue;
        sum += std::pow(*line.of(band), 2) / total.variance;
        ++counted;
    }
    return counted > 0 ? shareText(sum / counted) : kNotKnown;
}

/// Welch and Satterthwaite [Gum2008, G.2b], where all components are known; empty: so many that it
/// is sure.
std::optional<double> effectiveFreedom(const std::vector<Line>& lines, Band band) {
    double sum = 0;
    for (const Line& line : lines) {
        if (line.freedom && *line.freedom > 0) sum += std::pow(*line.of(band), 4) / *line.freedom;
    }
    if (!(sum > 0)) return std::nullopt;
    return std::pow(totalOf(lines, band).variance, 2) / sum;
}

std::string sizeOf(const Line& line) {
    const double size = median(line.sizes);
    return size > 0 ? sizeText(size, line.first.unit) : "";
}

std::string freedomText(std::optional<double> freedom) {
    constexpr double kMany = 1000;  // beyond, k = 2 is what it says
    return freedom && *freedom < kMany ? significant(*freedom, 2) : "many";
}

template <class Text>
std::vector<std::string> totals(const std::string& name,
                                const std::vector<Band>& bands,
                                const Text& text) {
    std::vector<std::string> row{name, "", "", ""};
    for (const Band band : bands) row.push_back(text(band));
    row.insert(row.end(), 2, "");
    return row;
}

std::string percentile(std::vector<double> values, double share) {
    if (values.empty()) return "none";
    const auto last = static_cast<double>(values.size() - 1);
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::lround(share * last));
    std::nth_element(values.begin(), at, values.end());
    return relativeText(*at);
}

}  // namespace

HtmlTable budgetTable(const SampleSet& sample) {
    const std::vector<Band> bands = measuredBands(sample);
    HtmlTable table{.caption = "Relative standard uncertainty of f (k = 1) by component and band",
                    .head = {"component", "type", "correlation", "size of the input"},
                    .rows = {}};
    for (const Band band : bands) table.head.push_back("u(f)/f, " + bandName(band));
    table.head.insert(table.head.end(), {"share of variance", "degrees of freedom"});
    const std::vector<Line> lines = linesOf(readBudget(sample.info.budgetJson));
    for (const Line& line : lines) {
        std::vector<std::string> row{line.first.name,
                                     std::string(1, line.first.type),
                                     std::string(name(line.first.correlation)),
                                     sizeOf(line)};
        for (const Band band : bands) {
            const auto relative = line.of(band);
            row.push_back(relative ? relativeText(*relative) : kNotKnown);
        }
        row.push_back(shareOf(line, lines, bands));
        row.push_back(freedomText(line.freedom));
        table.add(row);
    }
    if (lines.empty()) return table;
    table.add(totals(
        "combined, k = 1", bands, [&](Band band) { return rootText(totalOf(lines, band), 1); }));
    table.add(totals("expanded, k = 2 (about 95 %)", bands, [&](Band band) {
        return rootText(totalOf(lines, band), kCoverageFactor);
    }));
    table.add(totals("effective degrees of freedom", bands, [&](Band band) {
        return totalOf(lines, band).whole() ? freedomText(effectiveFreedom(lines, band))
                                            : kNotKnown;
    }));
    return table;
}

HtmlTable achievedTable(const SampleSet& sample) {
    const std::vector<Band> bands = measuredBands(sample);
    HtmlTable table{.caption =
                        "Relative uncertainty that the measured cells have: median u (k = 1), "
                        "the u that 95 of 100 cells stay below, median U (k = 2)",
                    .head = {"light at"},
                    .rows = {}};
    for (const Band band : bands) table.head.push_back(bandName(band));
    for (const LedTable& led : sample.leds) {
        std::vector<std::string> row{lightLabel(led)};
        for (const Band band : bands) {
            const CellSamples* cells = cellsOf(led, band);
            const auto relative =
                cells != nullptr ? relativeUncertainties(*cells) : std::vector<double>{};
            row.push_back(relative.empty() ? "none measured"
                                           : "u " + percentile(relative, 0.5) + ", below " +
                                                 percentile(relative, kHigh) + ", U " +
                                                 relativeText(kCoverageFactor * median(relative)));
        }
        table.add(row);
    }
    return table;
}

std::size_t monteCarloCells(const SampleSet& sample) {
    std::size_t cells = 0;
    for (const StateBudget& state : readBudget(sample.info.budgetJson))
        cells += state.monteCarloCells;
    return cells;
}

}  // namespace gonio::proc
