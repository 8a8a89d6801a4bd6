#pragma once
// The trade of acquisition: for each rig, number of LED levels, material and wanted uncertainty
// what the best plan takes and achieves. Nothing is measured and nothing drawn at random: the rows
// are predictions, whose random part tests/plan holds against merged pictures.

#include <functional>
#include <string>
#include <vector>

#include "proc/plan/planner.h"
#include "proc/plan/trade_scene.h"

namespace gonio::proc {

struct TradeRigKind {
    std::string name;
    RigTiming timing;
};

/// What is swept: every combination.
struct TradeSweep {
    std::vector<TradeRigKind> rigs;
    std::vector<int> levels;  ///< numbers of LED levels, 1..3
    std::vector<TradeMaterial> materials;
    std::vector<double> wanted;  ///< relative random, k = 1
    PlanGoal goal;               ///< all but `wanted`
    SystematicFloor floor = SystematicFloor::typical(Zero::ZeroReference);

    /// Both rigs, 1..3 levels, all materials, 10, 3, 1, 0.5 and 0.3 %.
    [[nodiscard]] static TradeSweep full();
    /// Gloss metal and white, 10, 3 and 1 %: below, plans of hundreds of frames take long to prove.
    [[nodiscard]] static TradeSweep quick();
};

struct TradeRow {
    std::string rig;
    int levels = 0;
    std::string material;
    double wanted = 0;
    TimeParts seconds;
    Prediction predicted;
    Seconds cramerRao{0};
    CellCounts counts;
};

/// Told before each row: how many there will be, and how many are done.
using TradeProgress = std::function<void(std::size_t done, std::size_t rows)>;

/// In the order of the sweep: rigs, levels, materials, wanted. Usage error as of the planner.
[[nodiscard]] Result<std::vector<TradeRow>> tradeAcquisition(const TradeSweep& sweep,
                                                             const TradeProgress& progress = {});

/// Published time of a measurement with the MiniDiff V2 (radiometry.md 1).
inline constexpr Seconds kMiniDiffSeconds{135};

/// CSV with a heading; uncertainties relative, k = 1.
[[nodiscard]] std::string tradeCsv(const std::vector<TradeRow>& rows);
/// A Markdown table: rig, levels, material, wanted, seconds in parts, uncertainties in per cent.
[[nodiscard]] std::string tradeMarkdown(const std::vector<TradeRow>& rows);

}  // namespace gonio::proc
