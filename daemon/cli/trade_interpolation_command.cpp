// `gonio trade interpolation`: every estimator on surfaces of known truth.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/cli/commands.h"
#include "daemon/cli/goal_options.h"
#include "daemon/cli/output.h"
#include "driver/steady_clock.h"
#include "proc/core/number_text.h"
#include "proc/estimate/interpolation_table.h"
#include "proc/formats/file_bytes.h"
#include "proc/report/lobe_plot.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;
using Rows = std::vector<std::vector<std::string>>;
using proc::InterpolationRow;
using proc::RegionPart;

/// Per cent with the digits that matter.
std::string shown(double fraction) {
    if (std::isnan(fraction)) return "";
    const double percent = 100 * fraction;
    return fixed(percent, percent < 0.1 ? 3 : percent < 10 ? 2 : 0);
}

/// Median and worst, and of how many materials where a method refuses some.
std::string both(const std::vector<InterpolationRow>& rows,
                 const std::string& method,
                 bool inFamily,
                 std::size_t region,
                 RegionPart part) {
    const auto sum = proc::summaryOf(rows, method, inFamily, region, part);
    if (sum.answered == 0) return "";
    std::string text = shown(sum.median) + " (" + shown(sum.worst) + ")";
    if (sum.answered < sum.materials) {
        text += ", " + std::to_string(sum.answered) + " of " + std::to_string(sum.materials);
    }
    return text;
}

Rows summaryRows(const std::vector<InterpolationRow>& rows, bool inFamily) {
    Rows table{{"method", "10/30/50 hemi", "lobe"}};
    for (std::size_t r = 1; r < proc::studyRegions().size(); ++r) {
        table[0].push_back(proc::studyRegions()[r].name);
    }
    for (const std::string& method : proc::studyMethods()) {
        table.push_back({method,
                         both(rows, method, inFamily, 0, RegionPart::Hemisphere),
                         both(rows, method, inFamily, 0, RegionPart::Lobe)});
        for (std::size_t r = 1; r < proc::studyRegions().size(); ++r) {
            table.back().push_back(both(rows, method, inFamily, r, RegionPart::Hemisphere));
        }
    }
    return table;
}

/// `auto` on each material, with the share of values within 2 u.
Rows autoRows(const std::vector<InterpolationRow>& rows) {
    Rows table{{"material", "chosen between, beyond", "hemi", "lobe"}};
    for (const proc::StudyRegion& region : proc::studyRegions()) {
        if (&region != &proc::studyRegions().front()) table[0].push_back(region.name);
    }
    for (const InterpolationRow& row : rows) {
        if (row.method != "auto") continue;
        table.push_back({row.material, row.chosen});
        for (std::size_t r = 0; r < row.errors.size(); ++r) {
            const auto& error = row.errors[r];
            table.back().push_back(shown(error.hemisphere) + " (" + fixed(error.within2u, 2) + ")");
            if (r == 0) table.back().push_back(shown(error.lobe));
        }
    }
    return table;
}

Rows costRows(const std::vector<InterpolationRow>& rows) {
    Rows table{{"method", "to the first answer, s", "us per answer"}};
    for (const std::string& method : proc::studyMethods()) {
        double make = 0;
        double ask = 0;
        double count = 0;
        for (const InterpolationRow& row : rows) {
            if (row.method != method || std::isnan(row.microseconds)) continue;
            make += row.makeSeconds;
            ask += row.microseconds;
            ++count;
        }
        if (count > 0) {
            table.push_back({method, fixed(make / count, 2), fixed(ask / count, 2)});
        }
    }
    return table;
}

Json toJson(const InterpolationRow& row) {
    const auto number = [](double v) { return std::isnan(v) ? Json(nullptr) : Json(v); };
    Json json{{"method", row.method},
              {"material", row.material},
              {"in_family", row.inFamily},
              {"in_library", row.inLibrary},
              {"make_s", row.makeSeconds},
              {"answer_us", number(row.microseconds)}};
    if (!row.chosen.empty()) json["chosen"] = row.chosen;
    for (std::size_t r = 0; r < row.errors.size(); ++r) {
        const auto& error = row.errors[r];
        json["regions"][proc::studyRegions()[r].name] = {{"hemisphere", number(error.hemisphere)},
                                                         {"lobe", number(error.lobe)},
                                                         {"within_2u", number(error.within2u)},
                                                         {"unanswered", error.unanswered}};
    }
    return json;
}

/// A lobe between two LEDs, and one beyond the last: truth, the seed's way, ours.
Result<void> drawLobes(const std::filesystem::path& folder) {
    const auto materials = proc::studyMaterials();
    for (const auto& [material, degrees] :
         {std::pair("metal .1", 30), std::pair("plastic .1", 50), std::pair("plastic .1", 70)}) {
        for (const proc::StudyMaterial& one : materials) {
            if (one.name != material) continue;
            const auto curves = proc::lobeCurves(
                one, Radians::fromDegrees(degrees), {"specular-linear", "grid-linear", "auto"});
            const std::string at = std::to_string(degrees);
            const std::string picture = proc::lobePlot(
                one.name + " at " + at + " degrees, measured at 0, 20, 40 and 60", curves);
            std::string file = "lobe-" + one.name + "-" + at + ".svg";
            std::replace(file.begin(), file.end(), ' ', '-');
            if (auto done = proc::writeFile(folder / file, picture); !done) return done;
        }
    }
    return {};
}

}  // namespace

Result<void> tradeInterpolation(const CommonOptions& common,
                                const TradeInterpolationOptions& options) {
    const std::optional<double> noise = options.noise == "0" ? 0 : parsePercent(options.noise);
    if (!noise) {
        return Error{ErrorKind::Usage,
                     "trade interpolation: --noise '" + options.noise +
                         "', wanted 0 or a share up to 100 %, such as 1%"};
    }
    if (!options.output.empty()) {
        if (auto made = makeOutputFolder(options.output); !made)
            return made.error().in("trade interpolation");
    }
    const auto rows = proc::interpolationTable({.relativeNoise = *noise, .quick = options.quick},
                                               driver::SteadyClock(),
                                               [&](const std::string& what) {
                                                   if (!common.quiet) std::cerr << what << "\n";
                                               });
    const Rows inside = summaryRows(rows, true);
    const Rows outside = summaryRows(rows, false);
    if (!options.output.empty()) {
        const std::string text = "In the family of Lambert + GGX\n\n" + markdownTable(inside) +
                                 "\nOther materials\n\n" + markdownTable(outside) +
                                 "\nThe estimator `auto`\n\n" + markdownTable(autoRows(rows)) +
                                 "\nCost\n\n" + markdownTable(costRows(rows));
        if (auto done = proc::writeFile(options.output / "interpolation.md", text); !done)
            return done;
        if (auto done = drawLobes(options.output); !done) return done;
    }
    if (common.json) {
        Json all = Json::array();
        for (const InterpolationRow& row : rows) all.push_back(toJson(row));
        printJson({{"schema", "gonio/trade-interpolation/1"}, {"noise", *noise}, {"rows", all}});
        return {};
    }
    std::cout << "Relative error, median (worst), per cent. In the family of Lambert + GGX:\n";
    printTable(inside);
    std::cout << "\nOther materials:\n";
    printTable(outside);
    std::cout << "\nauto, with the share within 2 u:\n";
    printTable(autoRows(rows));
    std::cout << "\n";
    printTable(costRows(rows));
    return {};
}

}  // namespace gonio::daemon
