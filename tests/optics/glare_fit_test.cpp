#include "proc/optics/glare_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <optional>
#include <random>

#include "tests/optics/lenses.h"

namespace gonio::proc {
namespace {

constexpr Radians kField = 75_deg;
constexpr double kNoise = 0.05;  // of a pixel whose stray light is about 10
const Window kWindow = test::middleWindow();
const LensMap kLens = test::crookedLens();

double stray(int x, int y) { return 10 + 0.004 * x - 0.002 * y; }

/// A spot of light 1e9 in all about (x, y), spread by `halo(r)`, which is brought to its share.
class Pictures {
public:
    explicit Pictures(unsigned seed) : field_(kLens, kWindow, kField), random_(seed) {}

    template <class Halo>
    MergedState lit(SensorPoint spot, double everywhere, double share, const Halo& halo) {
        MergedState state = unlit(1 + 0.002);  // the LED has drifted by one standard size
        const double cx = spot.x - kWindow.x, cy = spot.y - kWindow.y;
        double landing = 0, spotPixels = 0;
        forEach([&](int x, int y) {
            const double r = std::hypot(x + 0.5 - cx, y + 0.5 - cy);
            landing += halo(r);
            spotPixels += r < 3 ? 1 : 0;
        });
        forEach([&](int x, int y) {
            const double r = std::hypot(x + 0.5 - cx, y + 0.5 - cy);
            const double glare = kLight * (everywhere / field_.count() + share * halo(r) / landing);
            const double spotLight = r < 3 ? kLight * (1 - everywhere - share) / spotPixels : 0;
            state.radiance.at(x, y) += static_cast<float>(glare + spotLight);
        });
        return state;
    }
    MergedState unlit(double level = 1) {
        MergedState state{
            .radiance = Image<float>(kWindow.sent()),
            .variance = Image<float>(kWindow.sent(), static_cast<float>(kNoise * kNoise)),
            .used = {},
            .saturated = {},
            .window = kWindow};
        forEach([&](int x, int y) {
            state.radiance.at(x, y) =
                static_cast<float>(level * stray(x, y) + kNoise * noise_(random_));
        });
        return state;
    }
    [[nodiscard]] double count() const { return field_.count(); }
    static constexpr double kLight = 1e9;

private:
    template <class Visit>
    void forEach(Visit visit) {
        for (int y = 0; y < kWindow.size.height; ++y) {
            for (int x = field_.inRow(y).begin; x < field_.inRow(y).end; ++x) visit(x, y);
        }
    }
    FieldPixels field_;
    std::mt19937 random_;
    std::normal_distribution<double> noise_;
};

const SensorPoint kMiddle{700, 520}, kRim{1000, 480};

TEST(GlareFit, FindsShareAndShape) {
    for (const double share : {1e-4, 1e-3, 1e-2}) {
        Pictures pictures(11);
        const auto halo = [](double r) { return haloShape(r, 80, 1.3); };
        const MergedState dark = pictures.unlit();
        const MergedState one = pictures.lit(kMiddle, 0.4 * share, 0.6 * share, halo);
        const MergedState two = pictures.lit(kRim, 0.4 * share, 0.6 * share, halo);
        const std::vector<MirrorPair> pairs{{one, dark}, {two, dark}};
        const auto found = fitGlare(pairs, kLens, kField, 0.002);
        ASSERT_TRUE(found) << found.error().message;
        std::cout << share << ": " << found->everywhere << " + " << found->halo << ", radius "
                  << found->radius << ", exponent " << found->exponent << ", u " << found->uShare
                  << "\n";
        EXPECT_NEAR(found->share(), share, std::max(4 * found->uShare, 0.05 * share));
        if (share < 1e-3) continue;  // seen, but not its shape
        EXPECT_NEAR(found->radius, 80, 8);
        EXPECT_NEAR(found->exponent, 1.3, 0.13);
        EXPECT_NEAR(found->halo, 0.6 * share, 0.06 * share);
        EXPECT_EQ(found->uRelative, 0.25);
    }
}

TEST(GlareFit, WithoutGlareThereIsNone) {
    Pictures pictures(12);
    const MergedState dark = pictures.unlit();
    const MergedState one = pictures.lit(kMiddle, 0, 0, [](double) { return 1.0; });
    const std::vector<MirrorPair> pairs{{one, dark}};
    const auto found = fitGlare(pairs, kLens, kField, 0.002);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(found->share(), 0);
    EXPECT_GT(found->uShare, 0);
    // 0.2 % of a light of 12 drifts; over 730 000 pixels that is 0.024 * 7.3e5 / 1e9 = 2e-5 of the
    // spot's.
    EXPECT_LT(found->uShare, 3e-5);
}

TEST(GlareFit, AHaloOfAnotherShapeIsTakenOffWithinWhatItSays) {
    Pictures pictures(13);
    const auto halo = [](double r) { return std::exp(-r / 90); };
    const MergedState dark = pictures.unlit();
    const MergedState one = pictures.lit(kMiddle, 0.002, 0.003, halo);
    const MergedState two = pictures.lit(kRim, 0.002, 0.003, halo);
    const std::vector<MirrorPair> pairs{{one, dark}, {two, dark}};
    const auto found = fitGlare(pairs, kLens, kField, 0.002);
    ASSERT_TRUE(found) << found.error().message;
    std::cout << "exponential halo: " << found->everywhere << " + " << found->halo << ", radius "
              << found->radius << ", exponent " << found->exponent << ", u relative "
              << found->uRelative << "\n";
    EXPECT_NEAR(found->share(), 0.005, 0.005 * found->uRelative);
    const GlareFilter filter(*found, kLens, kWindow, kField);
    const Image<float> clean = filter.clean(one.radiance).radiance;
    double glare = 0, left = 0;
    for (int y = 200; y < 800; y += 10) {
        for (int x = 200; x < 800; x += 10) {
            if (std::hypot(x + kWindow.x - kMiddle.x, y - kMiddle.y) < 40) continue;
            const double truth = 1.002 * stray(x, y);
            glare += double{one.radiance.at(x, y)} - truth;
            left += std::abs(double{clean.at(x, y)} - truth);
        }
    }
    EXPECT_LT(left, found->uRelative * glare);
}

TEST(GlareFit, NeedsAPairAndASpot) {
    EXPECT_EQ(fitGlare({}, kLens, kField, 0.002).error().kind, ErrorKind::Quality);
    Pictures pictures(14);
    const MergedState dark = pictures.unlit();
    const std::vector<MirrorPair> pairs{{dark, dark}};
    const auto none = fitGlare(pairs, kLens, kField, 0.002);
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("no bright spot"), std::string::npos);
}

}  // namespace
}  // namespace gonio::proc
