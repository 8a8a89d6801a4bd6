#include "sim/stage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gonio::sim {
namespace {

constexpr View kPatch{.x = 608, .y = 488, .size = {64, 48}};  // about the middle

const Optics& optics() {
    static const Optics made("SIM-0001", {kSensorSize.width / 2.0, kSensorSize.height / 2.0});
    return made;
}

const FieldOfView& patch() {
    static const FieldOfView made(optics(), kPatch);
    return made;
}

/// f = constant wherever it is asked.
class Even : public Scatterer {
public:
    explicit Even(LedBands f) : f_(f) {}
    [[nodiscard]] Answer answer(const LightView&) const override { return {.f = f_}; }

private:
    LedBands f_;
};

Placement even(Role role, LedBands f) {
    return {.role = role, .surface = std::make_shared<const Even>(f), .wedge = {}};
}

RateImages ratesOf(const Placement& placement, int led, const ReferenceErrors& errors = {}) {
    return ledLight(placement, {.references = errors}, optics(), patch(), led).steady;
}

double at(const RateImages& rates, Band band, int x, int y) {
    return static_cast<double>(rates[index(band)].at(x, y));
}

/// Calls `visit` for each pixel of the patch with its direction.
template <class Visit>
void forEachPixel(Visit visit) {
    for (int y = 0; y < kPatch.size.height; ++y) {
        for (int x = 0; x < kPatch.size.width; ++x) {
            const auto wo = optics().directionAt({kPatch.x + x + 0.5, kPatch.y + y + 0.5});
            ASSERT_TRUE(wo);
            visit(x, y, *wo);
        }
    }
}

double lensAt(const Direction& wo) {
    return optics().relativeSolidAngle(wo) * optics().vignetting(wo);
}

TEST(FieldOfView, LooksThroughTheMiddleOfEachPixel) {
    EXPECT_EQ(patch().view(), kPatch);
    forEachPixel([](int x, int y, const Direction& wo) {
        EXPECT_EQ(angleBetween({patch().direction(x, y), wo}).value(), 0);
        // Stored as float: half an ulp, 6e-8.
        EXPECT_NEAR(patch().transmission(x, y) / lensAt(wo), 1, 1e-7);
    });
}

TEST(FieldOfView, SeesNothingOutsideTheFieldStop) {
    const FieldOfView corner(optics(), {.x = 0, .y = 0, .size = {16, 16}});
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) EXPECT_EQ(corner.transmission(x, y), 0);
    }
}

TEST(Stage, APixelIsLedRateTimesFCosineAndStrayLightThroughTheLens) {
    const LedBands f{{0.3, 0.1, 0.05}};
    for (int led : {0, 3}) {
        const RateImages rates = ratesOf(even(Role::Sample, f), led);
        forEachPixel([&](int x, int y, const Direction& wo) {
            for (Band b : kBands) {
                const double wanted =
                    ledRate(led, b) * lensAt(wo) * (f[b] * wo.z() + strayLight(led, wo));
                // Transmission and rate are stored as floats: half an ulp of each, 6e-8.
                EXPECT_NEAR(at(rates, b, x, y) / wanted, 1, 1.5e-7);
            }
        });
    }
}

TEST(Stage, NothingAndWhatDoesNotAnswerLeaveTheStrayLight) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const RateImages nothing = ratesOf({}, 1);
    EXPECT_GT(at(nothing, Band::G, 10, 10), 0);
    EXPECT_EQ(ratesOf(even(Role::Sample, LedBands::all(nan)), 1), nothing);
    EXPECT_EQ(ratesOf(even(Role::Sample, LedBands::all(0)), 1), nothing);
}

TEST(Stage, OutsideTheFieldStopThereIsNoLight) {
    const FieldOfView corner(optics(), {.x = 0, .y = 0, .size = {16, 16}});
    const RateImages rates =
        ledLight(even(Role::Sample, LedBands::all(1)), {}, optics(), corner, 0).steady;
    for (const Image<float>& band : rates) {
        for (float rate : band.pixels()) EXPECT_EQ(rate, 0);
    }
}

TEST(Stage, OnlyTheTilesHaveErrorsOfTheirCertificates) {
    const ReferenceErrors errors = ReferenceErrors::random(5);
    const LedBands f = LedBands::all(0.3);
    const RateImages sample = ratesOf(even(Role::Sample, f), 2, errors);
    EXPECT_EQ(sample, ratesOf(even(Role::Sample, f), 2));
    const RateImages white = ratesOf(even(Role::White, f), 2, errors);
    const RateImages black = ratesOf(even(Role::Black, f), 2, errors);
    const RateImages dark = ratesOf({}, 2);
    forEachPixel([&](int x, int y, const Direction& wo) {
        const double light = at(sample, Band::B, x, y) - at(dark, Band::B, x, y);
        // Two floats apart: the difference has a few 1e-7 of the larger.
        EXPECT_NEAR((at(white, Band::B, x, y) - at(dark, Band::B, x, y)) / light,
                    errors.white(2, Band::B, wo),
                    1e-6);
        EXPECT_NEAR(
            (at(black, Band::B, x, y) - at(dark, Band::B, x, y)) / light, errors.black(), 1e-6);
    });
}

TEST(Stage, ALightTrapLeavesWhatItsDrawSays) {
    const ReferenceErrors errors = ReferenceErrors::random(5);
    const Placement trap{.role = Role::Zero, .surface = nullptr, .wedge = {}};
    EXPECT_EQ(ratesOf(trap, 2), ratesOf({}, 2));
    const RateImages rates = ratesOf(trap, 2, errors);
    forEachPixel([&](int x, int y, const Direction& wo) {
        const double wanted =
            ledRate(2, Band::B) * lensAt(wo) * (errors.zero() * wo.z() + strayLight(2, wo));
        EXPECT_NEAR(at(rates, Band::B, x, y) / wanted, 1, 1.5e-7);
    });
}

TEST(Stage, AMirrorShowsTheLedAsADiscOfHalfADegree) {
    const FieldOfView whole(optics(), {.x = 128, .y = 0, .size = {1024, 1024}});
    for (int led : {0, 2}) {
        const Placement mirror{.role = Role::Mirror, .surface = nullptr, .wedge = {0_deg, 3_deg}};
        const Direction image = mirrored(ledDirection(led), mirror.wedge);
        const RateImages bright = ledLight(mirror, {}, optics(), whole, led).steady;
        const RateImages dark = ledLight({}, {}, optics(), whole, led).steady;
        double power = 0;
        for (int y = 0; y < 1024; ++y) {
            for (int x = 0; x < 1024; ++x) {
                const double light = at(bright, Band::G, x, y) - at(dark, Band::G, x, y);
                if (light < 1) continue;
                const Direction& wo = whole.direction(x, y);
                // A pixel is 0.15 degrees wide; those on the rim are in by part.
                EXPECT_LE(angleBetween({image, wo}).degrees(), 0.5 + 0.15);
                // Light over rate and lens is f cos(theta_o); times its solid angle: reflectance.
                power += light / (ledRate(led, Band::G) * optics().vignetting(wo));
            }
        }
        // Relative solid angles sum up to that of the disc in pixels of the middle.
        const ImagePoint a = optics().pixelOf(Direction());
        const ImagePoint b = optics().pixelOf(Direction::fromSpherical(Radians(1e-3), 45_deg));
        const double perRadian = std::hypot(a.x - b.x, a.y - b.y) / 1e-3;
        // The rim is sampled by 4 x 4 points, and the lens's ellipse makes one radius stand for
        // all.
        EXPECT_NEAR(power / (perRadian * perRadian), 0.9, 0.03) << led;
    }
}

TEST(Stage, AMirrorShowsAWideSourceAsItsDisc) {
    // Twice the diameter: the same light on four times the solid angle.
    const Placement mirror{.role = Role::Mirror, .surface = nullptr, .wedge = {}};
    const auto peak = [&](Radians diameter) {
        const LedLight light =
            ledLight(mirror, {.rig = {.sourceDiameter = diameter}}, optics(), patch(), 0);
        const auto pixels = light.steady[1].pixels();
        return static_cast<double>(*std::max_element(pixels.begin(), pixels.end()));
    };
    EXPECT_NEAR(peak(1_deg), peak(0_deg), 1e-6 * peak(0_deg));
    EXPECT_NEAR(peak(1_deg) / peak(2_deg), 4, 0.01);
}

TEST(Stage, OnlyASoftSampleHasALobeThatFades) {
    EXPECT_TRUE(
        ledLight(even(Role::Sample, LedBands::all(0.3)), {}, optics(), patch(), 1).lobe[0].empty());
    Placement soft = even(Role::Sample, LedBands::all(0.3));
    soft.errors.softness = 0.05;
    const LedLight light = ledLight(soft, {}, optics(), patch(), 0);
    forEachPixel([&](int x, int y, const Direction& wo) {
        const double wanted = ledRate(0, Band::G) * lensAt(wo) * 0.3 * wo.z() *
                              lobeShape(angleBetween({Direction(), wo}));
        EXPECT_NEAR(at(light.lobe, Band::G, x, y) / wanted, 1, 1.5e-7);
    });
    EXPECT_EQ(light.steady, ratesOf(even(Role::Sample, LedBands::all(0.3)), 0));
}

TEST(Stage, AmbientLightIsThatOfAnFOfItsSize) {
    const Image<float> leak = ambientLight({.ambient = 0.002}, patch());
    forEachPixel([&](int x, int y, const Direction& wo) {
        const double wanted = 0.002 * ledRate(0, Band::G) * lensAt(wo) * (1 + wo.y() / 2);
        EXPECT_NEAR(static_cast<double>(leak.at(x, y)) / wanted, 1, 1.5e-7);
    });
}

}  // namespace
}  // namespace gonio::sim
