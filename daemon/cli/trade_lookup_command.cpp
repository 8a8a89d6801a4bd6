// `gonio trade lookup` and `gonio trade neighbours`.

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/cli/commands.h"
#include "daemon/cli/output.h"
#include "driver/steady_clock.h"
#include "proc/estimate/lookup_study.h"
#include "proc/formats/file_bytes.h"
#include "proc/report/lookup_plot.h"
#include "proc/report/neighbour_plot.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

Json toJson(const proc::LookupRow& row) {
    return {{"material", row.material},
            {"method", row.method},
            {"resolution", row.resolution},
            {"storage", row.storage},
            {"bytes", row.bytes},
            {"worst", number(row.worst())},
            {"p99", number(std::max(row.cosine.p99, row.lobe.p99))},
            {"mean", number(row.cosine.mean)},
            {"scalar_ns", number(row.scalarNs)},
            {"batch_ns", number(row.batchNs)},
            {"draw_ns", number(row.drawNs)},
            {"draw_variance", number(row.draws)},
            {"draw_variance_by_cosine", number(row.drawsByCosine)},
            {"on_front", row.onFront},
            {"knee", row.knee}};
}

Json toJson(const proc::NeighbourCost& row) {
    return {{"samples", row.samples},
            {"build_s", row.build.count()},
            {"query_s", row.query.count()},
            {"tree_bytes", row.treeBytes}};
}

}  // namespace

Result<void> tradeLookup(const CommonOptions& common, const TradeLookupOptions& options) {
    if (auto made = makeOutputFolder(options.output); !made) return made.error().in("trade lookup");
    const driver::SteadyClock clock;
    const auto rows = proc::lookupStudy(
        options.quick ? proc::LookupSweep::quick() : proc::LookupSweep::full(), Stopwatch(clock));
    if (!rows) return rows.error().in("trade lookup");
    const std::string table = proc::markdown(*rows);
    if (!options.output.empty()) {
        if (auto done = proc::writeFile(options.output / "trade-lookup.md", table); !done)
            return done;
        const std::string plot = proc::lookupPlot(*rows);
        if (auto done = proc::writeFile(options.output / "trade-lookup.svg", plot); !done)
            return done;
    }
    if (common.json) {
        Json all = Json::array();
        for (const proc::LookupRow& row : *rows) all.push_back(toJson(row));
        printJson({{"schema", "gonio/trade-lookup/1"}, {"rows", all}});
    } else {
        std::cout << table;
    }
    return {};
}

Result<void> tradeNeighbours(const CommonOptions& common, const TradeLookupOptions& options) {
    if (auto made = makeOutputFolder(options.output); !made)
        return made.error().in("trade neighbours");
    proc::NeighbourStudyOptions how;
    if (options.quick) how.sizes = {1'000, 10'000, 100'000};
    const driver::SteadyClock clock;
    const auto rows = proc::studyNeighbours(Stopwatch(clock), how);
    const std::string csv = proc::neighbourCsv(rows);
    if (!options.output.empty()) {
        if (auto done = proc::writeFile(options.output / "trade-neighbours.csv", csv); !done)
            return done;
        const std::string plot = proc::neighbourPlot(rows);
        if (auto done = proc::writeFile(options.output / "trade-neighbours.svg", plot); !done)
            return done;
    }
    if (common.json) {
        Json all = Json::array();
        for (const proc::NeighbourCost& row : rows) all.push_back(toJson(row));
        printJson({{"schema", "gonio/trade-neighbours/1"}, {"rows", all}});
    } else {
        std::cout << csv;
    }
    return {};
}

}  // namespace gonio::daemon
