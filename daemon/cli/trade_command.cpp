#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>

#include "daemon/cli/commands.h"
#include "daemon/cli/output.h"
#include "daemon/cli/progress.h"
#include "driver/steady_clock.h"
#include "proc/core/number_text.h"
#include "proc/core/stopwatch.h"
#include "proc/formats/file_bytes.h"
#include "proc/plan/trade_study.h"
#include "proc/report/trade_plot.h"

namespace gonio::daemon {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json toJson(const proc::Spread& spread) {
    return {{"worst", spread.worst}, {"p95", spread.percentile95}, {"median", spread.median}};
}

Json toJson(const proc::TradeRow& row) {
    const proc::TimeParts& s = row.seconds;
    return {{"rig", row.rig},
            {"led_levels", row.levels},
            {"material", row.material},
            {"wanted", row.wanted},
            {"seconds",
             {{"total", s.total().count()},
              {"exposure", s.exposure.count()},
              {"readout", s.readout.count()},
              {"settle", s.settle.count()},
              {"dark", s.dark.count()},
              {"pilot", s.pilot.count()},
              {"latency", s.latency.count()},
              {"cramer_rao", row.cramerRao.count()}}},
            {"random", toJson(row.predicted.random)},
            {"systematic", toJson(row.predicted.systematic)},
            {"total", toJson(row.predicted.total)},
            {"cells", row.predicted.cells},
            {"saturated_cells", row.counts.saturated},
            {"too_dim_cells", row.counts.tooDim}};
}

void printRows(const std::vector<proc::TradeRow>& rows) {
    std::vector<std::vector<std::string>> table{
        {"rig", "levels", "material", "wanted", "seconds", "random", "systematic", "total"}};
    for (const proc::TradeRow& row : rows) {
        table.push_back({row.rig,
                         std::to_string(row.levels),
                         row.material,
                         shortest(100 * row.wanted) + " %",
                         fixed(row.seconds.total().count(), 2),
                         perCent(row.predicted.random.worst),
                         perCent(row.predicted.systematic.worst),
                         perCent(row.predicted.total.worst)});
    }
    printTable(table);
}

Result<std::vector<proc::TradeRow>> swept(const CommonOptions& common,
                                          const TradeOptions& options) {
    Progress progress("trade acquisition", !common.quiet && !common.json);
    const driver::SteadyClock clock;
    const Stopwatch watch(clock);
    proc::TradeSweep sweep = options.quick ? proc::TradeSweep::quick() : proc::TradeSweep::full();
    if (!options.levels.empty()) {
        const std::set<int> levels(options.levels.begin(), options.levels.end());
        sweep.levels.assign(levels.begin(), levels.end());
    }
    return proc::tradeAcquisition(sweep, [&](std::size_t done, std::size_t rows) {
        const auto share = static_cast<double>(done) / static_cast<double>(rows);
        progress.show({.step = static_cast<int>(done),
                       .steps = static_cast<int>(rows),
                       .what = "plans",
                       .left = done > 0 ? watch.elapsed() * ((1 - share) / share) : Seconds(0)});
    });
}

}  // namespace

Result<void> tradeAcquisition(const CommonOptions& common, const TradeOptions& options) {
    if (auto done = makeOutputFolder(options.output); !done) {
        return done.error().in("trade acquisition");
    }
    const Result<std::vector<proc::TradeRow>> rows = swept(common, options);
    if (!rows) return rows.error();
    Json files = Json::array();
    const auto write = [&](const std::string& ending, const std::string& text) {
        const fs::path file = options.output / ("trade-acquisition" + ending);
        files.push_back(file.string());
        return proc::writeFile(file, text);
    };
    if (auto done = write(".csv", proc::tradeCsv(*rows)); !done) return done;
    if (auto done = write(".md", proc::tradeMarkdown(*rows)); !done) return done;
    if (auto done = write(".svg", proc::tradePlot(*rows)); !done) return done;
    if (common.json) {
        Json list = Json::array();
        for (const proc::TradeRow& row : *rows) list.push_back(toJson(row));
        printJson({{"schema", "gonio/trade-acquisition/1"},
                   {"published_seconds", proc::kMiniDiffSeconds.count()},
                   {"rows", list},
                   {"files", files}});
    } else if (!common.quiet) {
        printRows(*rows);
        std::cout << "worst cells, k = 1, predicted; the MiniDiff V2 takes "
                  << shortest(proc::kMiniDiffSeconds.count()) << " s (published)\n";
        for (const Json& file : files) std::cout << file.get<std::string>() << "\n";
    }
    return {};
}

}  // namespace gonio::daemon
