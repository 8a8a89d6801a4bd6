// Samples at the ends of what can come, through the whole of the tilt: found, corrected or put into
// the uncertainties, cells held against the lobes; with floating-point traps on.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <random>

#include "proc/models/spec.h"
#include "proc/quality/seen_direction.h"
#include "proc/quality/tilt_correction.h"
#include "tests/optics/lenses.h"
#include "tests/support/floating_point_traps.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

/// A gloss metal, tilted by 0.5 degrees; what becomes of its cells.
struct Case {
    std::string name;
    std::function<void(CellSamples& cells, std::size_t cell, std::mt19937_64& random)> spoil;
    std::string spec = "ggx,alpha=0.1,f0=0.9";
    bool oneLed = false;
    bool found = true;  ///< whether the tilt must be
};
std::ostream& operator<<(std::ostream& out, const Case& one) { return out << one.name; }

void lose(CellSamples& cells, std::size_t cell, Flag why) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    cells.f[cell] = cells.uRandom[cell] = cells.uSystematic[cell] = nan;
    cells.nEff[cell] = 0;
    cells.flags[cell] = Flags{why};
}

double noise(std::mt19937_64& random) { return std::normal_distribution<double>()(random); }

class TiltExtremes : public ::testing::TestWithParam<Case> {
protected:
    SampleSet sample() {
        const auto surface = makeModel(GetParam().spec);
        EXPECT_TRUE(surface);
        const Direction normal = Direction::fromSpherical(0.5_deg, 70_deg);
        const auto turn =
            Eigen::Quaterniond::FromTwoVectors(normal.vector(), Eigen::Vector3d::UnitZ());
        SampleSet set = test::sampleSet([&](Radians incidence, const Direction& wo) {
            const Direction wi = Direction::fromSpherical(incidence, Radians(0));
            const LightView own{*Direction::fromVector(turn * wi.vector()),
                                *Direction::fromVector(turn * wo.vector())};
            return (*surface)->answer(own).f[Band::G] * own.out.z() / wo.z();
        });
        if (GetParam().oneLed) set.leds.resize(1);
        std::mt19937_64 random(5);
        for (LedTable& led : set.leds) {
            for (CellSamples& cells : led.bands) {
                for (std::size_t cell = 0; cell < cells.size(); ++cell) {
                    if (cells.present(cell)) GetParam().spoil(cells, cell, random);
                }
            }
        }
        return set;
    }
};

/// Each cell is a number with a finite uncertainty no smaller than before, or missing with a word.
void expectSound(const SampleSet& before, const SampleSet& after) {
    ASSERT_EQ(after.leds.size(), before.leds.size());
    for (std::size_t led = 0; led < after.leds.size(); ++led) {
        for (std::size_t band = 0; band < 3; ++band) {
            const CellSamples& was = before.leds[led].bands[band];
            const CellSamples& is = after.leds[led].bands[band];
            for (std::size_t cell = 0; cell < is.size(); ++cell) {
                const bool has = is.present(cell);
                ASSERT_EQ(std::isfinite(is.f[cell]), has) << cell;
                ASSERT_EQ(std::isfinite(is.uRandom[cell]), has) << cell;
                ASSERT_EQ(std::isfinite(is.uSystematic[cell]), has) << cell;
                ASSERT_NE(is.flags[cell], Flags{}) << "a cell without a word";
                if (!has) continue;
                ASSERT_GE(is.uRandom[cell], 0);
                ASSERT_GE(is.uSystematic[cell], 0);
                // Without a correction nothing moves, and nothing becomes surer.
                if (is.flags[cell].has(Flag::TiltCorrected)) continue;
                ASSERT_EQ(is.f[cell], was.f[cell]);
                ASSERT_GE(is.uSystematic[cell], was.uSystematic[cell] * (1 - 1e-12));
            }
        }
    }
}

TEST_P(TiltExtremes, NothingCrashesAndWhatIsSaidIsSound) {
    const SampleSet seen = sample();
    constexpr auto kParameters = static_cast<Eigen::Index>(LensMap::kParameters);
    const LensFit lens{.map = test::crookedLens(),
                       .covariance = 1e-6 * Eigen::MatrixXd::Identity(kParameters, kParameters)};
    const test::FloatingPointTraps on;
    const auto estimate = estimateTilt(seen, 0.01_deg);
    EXPECT_EQ(estimate && estimate->determined, GetParam().found);
    if (!estimate) return;  // no lobe: nothing is said, and nothing is done
    EXPECT_TRUE(std::isfinite(estimate->joint.u.value()));
    EXPECT_GT(estimate->joint.u.value(), 0);
    EXPECT_TRUE(std::isfinite(estimate->waviness.value()));
    expectSound(seen, withTiltUncertainty(seen, *estimate));
    if (!estimate->determined) return;
    // Whatever was lost: the normal is what it is, within what is said of it.
    const Direction truth = Direction::fromSpherical(0.5_deg, 70_deg);
    EXPECT_LT(angleBetween({estimate->joint.direction, truth}).value(),
              5 * estimate->joint.u.value());
    expectSound(seen, tiltCorrected(seen, *estimate));
    std::vector<Radians> incidences;
    for (const LedTable& led : seen.leds) incidences.push_back(led.incidence);
    const SeenDirection against(lens, incidences, *estimate);
    for (std::size_t led = 0; led < incidences.size(); ++led) {
        for (std::size_t cell = 0; cell < CellGrid::count(); cell += 97)
            ASSERT_TRUE(
                std::isfinite(against.uncertainty(led, CellGrid::centre(cell)).perAxis().value()));
    }
}

INSTANTIATE_TEST_SUITE_P(
    Ends,
    TiltExtremes,
    ::testing::Values(Case{.name = "AsItIs", .spoil = [](auto&, auto, auto&) {}},
                      Case{.name = "OneLed", .spoil = [](auto&, auto, auto&) {}, .oneLed = true},
                      Case{.name = "OneElectronPerPixel",
                           .spoil =
                               [](CellSamples& cells, std::size_t cell, std::mt19937_64& random) {
                                   cells.uRandom[cell] = 0.2;
                                   cells.f[cell] += 0.2 * noise(random);
                               }},
                      Case{.name = "LobesAreSaturated",
                           .spoil =
                               [](CellSamples& cells, std::size_t cell, std::mt19937_64&) {
                                   if (cells.f[cell] > 1) lose(cells, cell, Flag::Saturated);
                               }},
                      Case{.name = "ATwentiethIsSaturated",
                           .spoil =
                               [](CellSamples& cells, std::size_t cell, std::mt19937_64&) {
                                   if (cell % 20 == 0) lose(cells, cell, Flag::Saturated);
                               }},
                      Case{.name = "AllButOneCellIsLost",
                           .spoil =
                               [](CellSamples& cells, std::size_t cell, std::mt19937_64&) {
                                   if (cell != 700) lose(cells, cell, Flag::BelowNoise);
                               },
                           .found = false},
                      Case{.name = "NothingIsLeft",
                           .spoil = [](CellSamples& cells,
                                       std::size_t cell,
                                       std::mt19937_64&) { lose(cells, cell, Flag::BelowNoise); },
                           .found = false},
                      Case{.name = "FIsZero",
                           .spoil =
                               [](CellSamples& cells, std::size_t cell, std::mt19937_64&) {
                                   cells.f[cell] = 0;
                                   cells.uRandom[cell] = 1e-4;
                                   cells.uSystematic[cell] = 0;
                               },
                           .found = false},
                      Case{.name = "NegativeDifferences",
                           .spoil =
                               [](CellSamples& cells, std::size_t cell, std::mt19937_64& random) {
                                   cells.uRandom[cell] = 1e-3;
                                   cells.f[cell] = -1e-4 + 1e-3 * noise(random);
                               },
                           .found = false},
                      Case{.name = "FIsFourThousand",
                           .spoil = [](auto&, auto, auto&) {},
                           .spec = "ggx,alpha=0.009,f0=0.9"},
                      Case{.name = "FIsALot",
                           .spoil =
                               [](CellSamples& cells, std::size_t cell, std::mt19937_64&) {
                                   cells.f[cell] *= 1e12;
                                   cells.uRandom[cell] *= 1e12;
                                   cells.uSystematic[cell] *= 1e12;
                               }},
                      Case{.name = "FIsNextToNothing",
                           .spoil =
                               [](CellSamples& cells, std::size_t cell, std::mt19937_64&) {
                                   cells.f[cell] *= 1e-12;
                                   cells.uRandom[cell] *= 1e-12;
                                   cells.uSystematic[cell] *= 1e-12;
                               }},
                      Case{.name = "AlmostWithoutUncertainty",
                           .spoil =
                               [](CellSamples& cells, std::size_t cell, std::mt19937_64&) {
                                   cells.uRandom[cell] = 1e-12 * cells.f[cell];
                                   cells.uSystematic[cell] = 0;
                               }},
                      Case{.name = "WithoutAnyUncertainty",
                           .spoil =
                               [](CellSamples& cells, std::size_t cell, std::mt19937_64&) {
                                   cells.uRandom[cell] = cells.uSystematic[cell] = 0;
                               }},
                      Case{.name = "UncertainBeyondAllMeasure",
                           .spoil = [](CellSamples& cells,
                                       std::size_t cell,
                                       std::mt19937_64&) { cells.uRandom[cell] = 1e9; },
                           .found = false}),
    [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace gonio::proc
