#pragma once
// The samples and rigs that the trade study of acquisition plans for (radiometry.md 4): materials
// by the range of their f, a photon budget, twelve states of four LEDs and three bands, cells of
// CellGrid out to 75 degrees.
//
// A material is f = base + (peak - base) (1 + (d / w)^2)^-2, d the angle from the mirror direction,
// w its width: the peak is in the cell that holds the mirror direction, the base is what is left
// far from it.
//
// Light: a pixel in the middle of the field collects f cos(theta_o) times a rate; elsewhere it is
// less by the solid angle that an even f-theta lens gives it and by the lens's fall-off. Three LED
// levels 1, 1/20, 1/400 have the power that lets the peak of 4170 / sr just fit into the shortest
// exposure at the dimmest; with fewer levels the power must be less so that it still does.

#include <string>
#include <vector>

#include "proc/core/direction.h"
#include "proc/plan/pilot.h"
#include "proc/plan/rig_model.h"

namespace gonio::proc {

struct TradeMaterial {
    std::string name;
    double base = 0;  ///< 1/sr
    double peak = 0;  ///< 1/sr
    Radians width;

    [[nodiscard]] double f(Radians fromMirror) const;
};

/// White, satin (0.02..3), gloss black (1e-3..170), gloss metal (1e-3..4170): the last is the
/// worst.
[[nodiscard]] const std::vector<TradeMaterial>& tradeMaterials();

/// What the light of the rig is worth.
struct PhotonBudget {
    double ratePerSr = 4.5e7;  ///< e-/s of green LED 0 for f cos(theta_o) = 1 / sr, full level
    double pixelsPerDegree = 6.6;
    double falloff = 0.12;  ///< of the lens at 75 degrees
    /// Stray light in units of f cos(theta_o).
    double stray = 0;
};

/// 1..3 of the LED levels 1, 1/20, 1/400, and the budget that goes with them.
struct LevelChoice {
    std::vector<double> levels;
    PhotonBudget budget;
};
[[nodiscard]] LevelChoice levelChoice(int levels);

/// All twelve states.
[[nodiscard]] std::vector<StatePilot> tradeStates(const TradeMaterial& material,
                                                  const PhotonBudget& budget);

/// A rig as of config/rigs with these LED levels. The ladder of exposures is theirs; with fewer
/// than three levels, whose light is less, it goes on to a second.
[[nodiscard]] RigModel tradeRig(const RigTiming& timing, const std::vector<double>& levels);

}  // namespace gonio::proc
