#include "proc/export/target_grid.h"

#include <cmath>
#include <string>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

constexpr std::size_t kMostIncidences = 181;
constexpr double kFinestStep = 0.1;
/// A gigabyte of text.
constexpr double kMostDirections = 4e7;

std::vector<std::string_view> split(std::string_view text, char at) {
    std::vector<std::string_view> parts;
    for (std::size_t end = text.find(at); end != std::string_view::npos; end = text.find(at)) {
        parts.push_back(text.substr(0, end));
        text.remove_prefix(end + 1);
    }
    parts.push_back(text);
    return parts;
}

Error wanted(std::string_view text) {
    return {
        ErrorKind::Usage,
        "--grid '" + std::string(text) +
            "': wanted incidences in [0, 90), as 0,20,40 or 0:10:80, and a step of views of 0.1 to "
            "30 degrees behind a slash, as 0:10:80/2 or /2; 40 million directions in all"};
}

/// FROM:STEP:TO
std::optional<std::vector<double>> rangeOf(std::string_view text) {
    const auto parts = split(text, ':');
    if (parts.size() != 3) return std::nullopt;
    const auto from = parseDouble(parts[0]);
    const auto step = parseDouble(parts[1]);
    const auto to = parseDouble(parts[2]);
    if (!from || !step || !to || *step <= 0 || *to < *from) return std::nullopt;
    const double count = std::floor((*to - *from) / *step + 1e-9) + 1;
    if (count > static_cast<double>(kMostIncidences)) return std::nullopt;
    std::vector<double> values;
    for (double i = 0; i < count; ++i) values.push_back(*from + i * *step);
    return values;
}

std::optional<std::vector<double>> listOf(std::string_view text) {
    std::vector<double> values;
    for (const std::string_view part : split(text, ',')) {
        const auto value = parseDouble(part);
        if (!value || (!values.empty() && *value <= values.back())) return std::nullopt;
        values.push_back(*value);
    }
    return values;
}

}  // namespace

Result<TargetGrid> parseTargetGrid(std::string_view text) {
    TargetGrid grid;
    const std::size_t slash = text.find('/');
    if (slash != std::string_view::npos) {
        grid.stepDeg = parseDouble(text.substr(slash + 1));
        if (!grid.stepDeg || *grid.stepDeg < kFinestStep || *grid.stepDeg > 30) return wanted(text);
    }
    const std::string_view incidences = text.substr(0, slash);
    if (incidences.empty() && grid.stepDeg) return grid;
    grid.incidenceDeg =
        incidences.find(':') == std::string_view::npos ? listOf(incidences) : rangeOf(incidences);
    const bool inside = grid.incidenceDeg && !grid.incidenceDeg->empty() &&
                        grid.incidenceDeg->front() >= 0 && grid.incidenceDeg->back() < 90 &&
                        grid.incidenceDeg->size() <= kMostIncidences;
    if (!inside) return wanted(text);
    const double step = grid.stepOr(1);
    const double incidencesAsked = static_cast<double>(grid.incidenceDeg->size());
    if (incidencesAsked * 360 / step * 180 / step > kMostDirections) return wanted(text);
    return grid;
}

std::vector<double> stepsTo(double last, double step) {
    std::vector<double> axis;
    for (int i = 0; i * step < last - 1e-9; ++i) axis.push_back(i * step);
    axis.push_back(last);
    return axis;
}

}  // namespace gonio::proc
