#include "proc/plan/trade_study.h"

#include <optional>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

std::vector<TradeRigKind> bothRigs() {
    return {{.name = "USB 2, 25 fps", .timing = RigTiming::usb2()},
            {.name = "USB 3, 60 fps", .timing = RigTiming::usb3()}};
}

/// Under a heading that says per cent.
std::string hundredths(const Spread& spread) {
    const auto shown = [](double relative) { return fixed(100 * relative, 2); };
    return shown(spread.worst) + " / " + shown(spread.percentile95) + " / " + shown(spread.median);
}

void addCsv(std::string& text, const Spread& spread) {
    for (const double value : {spread.worst, spread.percentile95, spread.median})
        text += "," + shortest(value);
}

Result<TradeRow> rowOf(const PlanInput& input, const PlanGoal& goal) {
    const Result<Plan> plan = planCaptures(input, goal);
    if (!plan) return plan.error();
    return TradeRow{.wanted = plan->wanted,
                    .seconds = plan->seconds,
                    .predicted = plan->predicted,
                    .cramerRao = plan->cramerRao,
                    .counts = plan->counts};
}

}  // namespace

TradeSweep TradeSweep::full() {
    return {.rigs = bothRigs(),
            .levels = {1, 2, 3},
            .materials = tradeMaterials(),
            .wanted = {0.10, 0.03, 0.01, 0.005, 0.003},
            .goal = {}};
}

TradeSweep TradeSweep::quick() {
    TradeSweep sweep = full();
    sweep.materials = {tradeMaterials().front(), tradeMaterials().back()};
    sweep.wanted = {0.10, 0.03, 0.01};
    return sweep;
}

Result<std::vector<TradeRow>> tradeAcquisition(const TradeSweep& sweep,
                                               const TradeProgress& progress) {
    std::vector<TradeRow> rows;
    const std::size_t count =
        sweep.rigs.size() * sweep.levels.size() * sweep.materials.size() * sweep.wanted.size();
    for (const TradeRigKind& kind : sweep.rigs) {
        for (const int levels : sweep.levels) {
            const LevelChoice choice = levelChoice(levels);
            const RigModel rig = tradeRig(kind.timing, choice.levels);
            for (const TradeMaterial& material : sweep.materials) {
                const std::vector<StatePilot> states = tradeStates(material, choice.budget);
                for (const double wanted : sweep.wanted) {
                    if (progress) progress(rows.size(), count);
                    PlanGoal goal = sweep.goal;
                    goal.wanted = wanted;
                    Result<TradeRow> row =
                        rowOf({.rig = rig, .states = states, .floor = sweep.floor}, goal);
                    if (!row) return row.error();
                    row->rig = kind.name;
                    row->levels = levels;
                    row->material = material.name;
                    rows.push_back(std::move(*row));
                }
            }
        }
    }
    return rows;
}

std::string tradeCsv(const std::vector<TradeRow>& rows) {
    std::string text =
        "rig,led_levels,material,wanted,seconds,exposure_s,readout_s,settle_s,dark_s,pilot_s,"
        "latency_s,cramer_rao_s";
    for (const char* part : {"random", "systematic", "total", "cramer_rao"}) {
        for (const char* statistic : {"worst", "p95", "median"})
            text += std::string(",") + part + "_" + statistic;
    }
    text += ",cells,saturated,too_dim\n";
    for (const TradeRow& row : rows) {
        text += "\"" + row.rig + "\"," + std::to_string(row.levels) + ",\"" + row.material + "\"," +
                shortest(row.wanted);
        const TimeParts& s = row.seconds;
        for (const Seconds part : {s.total(),
                                   s.exposure,
                                   s.readout,
                                   s.settle,
                                   s.dark,
                                   s.pilot,
                                   s.latency,
                                   row.cramerRao})
            text += "," + fixed(part.count(), 6);
        addCsv(text, row.predicted.random);
        addCsv(text, row.predicted.systematic);
        addCsv(text, row.predicted.total);
        addCsv(text, row.predicted.cramerRao);
        text += "," + std::to_string(row.predicted.cells) + "," +
                std::to_string(row.counts.saturated) + "," + std::to_string(row.counts.tooDim) +
                "\n";
    }
    return text;
}

std::string tradeMarkdown(const std::vector<TradeRow>& rows) {
    std::string text =
        "| rig | levels | material | wanted % | s | pilot | exposure | readout | settle | dark | "
        "latency | Cramer-Rao s | random % | systematic % | total % |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const TradeRow& row : rows) {
        text += "| " + row.rig + " | " + std::to_string(row.levels) + " | " + row.material + " | " +
                shortest(100 * row.wanted) + " | **" + fixed(row.seconds.total().count(), 2) + "**";
        const TimeParts& s = row.seconds;
        for (const Seconds part : {s.pilot, s.exposure, s.readout, s.settle, s.dark, s.latency})
            text += " | " + fixed(part.count(), 2);
        text += " | " + fixed(row.cramerRao.count(), 2) + " | " + hundredths(row.predicted.random) +
                " | " + hundredths(row.predicted.systematic) + " | " +
                hundredths(row.predicted.total) + " |\n";
    }
    return text;
}

}  // namespace gonio::proc
