// Scenes and references at the ends of what can come, from frames to f: merged with their dark
// frames, binned and calibrated, with floating-point traps on.

#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "proc/calibrate/two_point.h"
#include "proc/radiance/merge.h"
#include "tests/optics/lenses.h"
#include "tests/radiance/frames.h"

namespace gonio::proc {
namespace {

using test::Shot;

constexpr double kRate = 4.5e7;  // electrons per second for f cos(theta_o) = 1 / sr
constexpr double kStray = 3e-4;  // in units of f cos(theta_o)
constexpr double kWhite = 0.98 / kPi, kBlack = 0.001 / kPi;
constexpr Window kWindow{.x = 800, .y = 470, .size = {72, 72}, .binning = 1};

using F = std::function<double(const Direction&)>;
F even(double f) {
    return [f](const Direction&) { return f; };
}

/// One line of the table: what lies under the rig, how it is taken, and what must come of it.
struct Case {
    std::string name;
    F sample = even(0.1);
    std::vector<Shot> shots{{.seconds = 20e-6}, {.seconds = 320e-6}, {.seconds = 5e-3}};
    double white = kWhite, black = kBlack;  ///< what the tiles really show
    double light = kRate;
    SensorNoise noise{};
    bool present = true;         ///< cells are measured, f is the truth within u_random
    Flag flag = Flag::Measured;  ///< that the cells, or some of them, have
};
std::ostream& operator<<(std::ostream& out, const Case& one) { return out << one.name; }

const Direction& towards(std::size_t pixel) {
    static const std::vector<Direction> directions = [] {
        const LensMap lens = test::crookedLens();
        std::vector<Direction> all;
        for (int y = 0; y < kWindow.size.height; ++y) {
            for (int x = 0; x < kWindow.size.width; ++x) {
                all.push_back(*lens.directionAt({kWindow.x + x + 0.5, kWindow.y + y + 0.5}));
            }
        }
        return all;
    }();
    return directions[pixel];
}

class CalibrateExtremes : public ::testing::TestWithParam<Case> {
protected:
    CalibrateExtremes() { feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW); }
    ~CalibrateExtremes() override { fedisableexcept(FE_ALL_EXCEPT); }
    CalibrateExtremes(const CalibrateExtremes&) = delete;
    CalibrateExtremes& operator=(const CalibrateExtremes&) = delete;

    DarkLibrary darks() {
        DarkLibrary library;
        for (Shot shot : GetParam().shots) {
            shot.level = 0;
            std::vector<Frame> frames;
            for (int i = 0; i < 4; ++i) {
                frames.push_back(test::take(shot, kWindow.size, random_, {}, GetParam().noise));
                frames.back().window = kWindow;
            }
            library.add(*averageDark(frames, GetParam().noise));
        }
        return library;
    }
    /// f cos(theta_o) and stray light, in frames, merged and binned.
    CellSignal signal(const F& f, const DarkLibrary& library) {
        std::vector<Frame> frames;
        for (const Shot& shot : GetParam().shots) {
            frames.push_back(test::unexposed(shot, kWindow.size));
            Frame& frame = frames.back();
            frame.window = kWindow;
            const double tau = shot.seconds * shot.level / 65535.0;
            for (std::size_t i = 0; i < frame.pixels.pixels().size(); ++i) {
                const Direction& wo = towards(i);
                const double light = GetParam().light * (f(wo) * wo.z() + kStray);
                const double dark = GetParam().noise.darkElectronsPerSecond * shot.seconds;
                frame.pixels.pixels()[i] =
                    test::Exposed(std::max(0.0, light * tau) + dark, GetParam().noise)(random_);
            }
        }
        const auto merged = merge(frames, Band::G, library, GetParam().noise);
        EXPECT_TRUE(merged);
        return Binning(test::crookedLens(), kWindow, 75_deg).bin(*merged);
    }

    std::mt19937_64 random_{17};
};

TEST_P(CalibrateExtremes, NothingCrashesAndWhatIsSaidIsHonest) {
    const Case& wanted = GetParam();
    const DarkLibrary library = darks();
    const CellSignal sample = signal(wanted.sample, library);
    const CellSignal white = signal(even(wanted.white), library);
    const CellSignal black = signal(even(wanted.black), library);
    const ReferenceTable certifiedWhite = ReferenceTable::lambertian("white", 0.98, 0.005);
    const ReferenceTable certifiedBlack = ReferenceTable::lambertian("black", 0.001, 0.1);
    const std::vector angle(CellGrid::count(), DirectionSpread::even(0.01_deg));
    const Calibrated out = calibrate(sample,
                                     {white, black, certifiedWhite, certifiedBlack},
                                     Direction::fromSpherical(20_deg, 0_deg),
                                     Band::G,
                                     {.angle = angle, .ledDrift = 0.002});
    const CellSamples& cells = out.samples;
    double pulls = 0, present = 0, seen = 0, flagged = 0;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        const bool has = cells.present(cell);
        ASSERT_EQ(std::isfinite(cells.f[cell]), has);
        ASSERT_EQ(std::isfinite(cells.uRandom[cell]), has);
        ASSERT_EQ(std::isfinite(cells.uSystematic[cell]), has);
        ASSERT_NE(cells.flags[cell], Flags{}) << "a cell without a word";
        if (cells.flags[cell].has(Flag::Blocked)) continue;
        ++seen;
        flagged += cells.flags[cell].has(wanted.flag) ? 1 : 0;
        if (!has) continue;
        ++present;
        ASSERT_GT(cells.uRandom[cell], 0);
        const double error = cells.f[cell] - wanted.sample(CellGrid::centre(cell));
        pulls += std::pow(error / cells.uRandom[cell], 2);
    }
    ASSERT_GT(seen, 60);
    EXPECT_GT(flagged, 0);
    EXPECT_EQ(present > 0, wanted.present);
    if (present == 0) return;
    // The mean square of 60 pulls or more is 1 to 4 sqrt(2 / 60); never too small an uncertainty,
    // and where light is lost in noise it may be a quarter too large.
    EXPECT_LT(pulls / present, 1 + 4 * std::sqrt(2 / present));
    EXPECT_GT(pulls / present, 0.75 - 4 * std::sqrt(2 / present));
}

const std::vector<Shot> kOne{{.seconds = 0.5e-3}};
const std::vector<Shot> kDimmed{
    {.seconds = 20e-6, .level = 164}, {.seconds = 20e-6}, {.seconds = 320e-6}, {.seconds = 5e-3}};

INSTANTIATE_TEST_SUITE_P(
    Ends,
    CalibrateExtremes,
    ::testing::Values(
        Case{.name = "OneElectronPerPixel",
             .sample = even(1 / (kRate * 1e-3)),
             .shots = {{.seconds = 20e-6}, {.seconds = 1e-3}},
             .flag = Flag::BelowNoise},
        Case{.name = "ATwentiethIsSaturated",
             .sample = [](const Direction& wo) { return wo.y() > 0.08 ? 1e6 : 0.1; },
             .flag = Flag::Saturated},
        Case{.name = "WhiteAsBlack", .white = kBlack, .present = false, .flag = Flag::BelowNoise},
        Case{.name = "WhiteBelowBlack",
             .white = kBlack,
             .black = kWhite,
             .present = false,
             .flag = Flag::BelowNoise},
        Case{.name = "ZeroLight", .light = 0, .present = false, .flag = Flag::BelowNoise},
        Case{.name = "ExposureRatioOneToOne",
             .shots = {{.seconds = 0.5e-3}, {.seconds = 1e-3, .level = 32768}}},
        Case{.name = "OneFrame", .shots = kOne},
        Case{.name = "AllPixelsHot", .noise = {.darkElectronsPerSecond = 3000}},
        Case{.name = "EightyDegrees",
             .noise = {.darkElectronsPerSecond = 3 * std::pow(2, 55 / 7.0)}},
        Case{.name = "FIsZero", .sample = even(0), .flag = Flag::BelowNoise},
        Case{.name = "DarkerThanBlack",
             .sample = even(0.5 * kBlack),
             .shots = {{.seconds = 320e-6}, {.seconds = 5e-3}, {.seconds = 40e-3}}},
        Case{.name = "FIsFourThousand", .sample = even(4000), .shots = kDimmed}),
    [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace gonio::proc
