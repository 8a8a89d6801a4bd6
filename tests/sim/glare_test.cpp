#include "sim/glare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace gonio::sim {
namespace {

const Optics& optics() {
    static const Optics made("SIM-0001", {kSensorSize.width / 2.0, kSensorSize.height / 2.0});
    return made;
}

/// The field's left edge cuts through it: some pixels do not see the field.
const FieldOfView& edge() {
    static const FieldOfView made(optics(), {.x = 110, .y = 480, .size = {110, 70}});
    return made;
}

double sumOf(const Image<float>& image) {
    return std::accumulate(image.pixels().begin(), image.pixels().end(), 0.0);
}

Image<float> pointAt(int x, int y, float rate) {
    Image<float> image(edge().view().size);
    image.at(x, y) = rate;
    return image;
}

TEST(Glare, TheFixtureHasPixelsOnBothSidesOfTheEdge) {
    EXPECT_EQ(edge().transmission(0, 35), 0);
    EXPECT_GT(edge().transmission(109, 35), 0);
}

TEST(Glare, SpreadsItsShareOfTheLightAndLosesNone) {
    const Image<float> point = pointAt(80, 30, 1e6F);
    for (const double share : {0.0, 0.001, 0.01}) {
        const Image<float> seen = withGlare({point, point, point}, edge(), share)[1];
        // Each of 7700 pixels is rounded to a float.
        EXPECT_NEAR(sumOf(seen) / 1e6, 1, 1e-6) << share;
        // The source keeps the rest and what the halo brings back, less than a thousandth of it.
        const double elsewhere = sumOf(seen) - double{seen.at(80, 30)};
        EXPECT_NEAR(elsewhere, share * 1e6, 0.001 * share * 1e6) << share;
    }
}

TEST(Glare, OfShareZeroIsTheSameImage) {
    Image<float> image(edge().view().size);
    for (int x = 80; x < 110; ++x) image.at(x, 20) = 3.5F * static_cast<float>(x);
    EXPECT_EQ(withGlare({image, image, image}, edge(), 0)[2], image);
}

TEST(Glare, OutsideTheFieldItIsDark) {
    const Image<float> point = pointAt(80, 30, 1e6F);
    const Image<float> seen = withGlare({point, point, point}, edge(), 0.01)[0];
    for (int y = 0; y < 70; ++y) {
        for (int x = 0; x < 110; ++x) {
            EXPECT_EQ(seen.at(x, y) == 0, edge().transmission(x, y) == 0) << x << ' ' << y;
        }
    }
}

TEST(Glare, TheGridMatchesTheReference) {
    // A peak, another near the edge, and an even part.
    Image<float> image(edge().view().size);
    for (int y = 0; y < 70; ++y) {
        for (int x = 0; x < 110; ++x) {
            if (edge().transmission(x, y) != 0) image.at(x, y) = 50;
        }
    }
    image.at(88, 33) = 2e6F;
    image.at(61, 3) = 5e5F;
    const Image<float> fast = withGlare({image, image, image}, edge(), 0.01)[0];
    const Image<float> slow = withGlareReference(image, edge(), 0.01);
    double most = 0, peak = 0;
    for (std::size_t i = 0; i < fast.pixels().size(); ++i) {
        if (image.pixels()[i] > 100) continue;
        most = std::max(most, std::abs(double{fast.pixels()[i]} - double{slow.pixels()[i]}));
        peak = std::max(peak, double{slow.pixels()[i]} - 50);
    }
    EXPECT_GT(peak, 1);
    EXPECT_LT(most, 0.02 * peak);
}

TEST(Glare, IsHalfEvenAndHalfAHalo) {
    // In the reference, of a lone point: (a + b halo(r)), the same a and b all over the field.
    constexpr double kShare = 0.01;
    const Image<float> point = pointAt(80, 30, 1e6F);
    const Image<float> seen = withGlareReference(point, edge(), kShare);
    double pixels = 0, halo = 0;
    const auto haloAt = [](int x, int y) {
        return 1 / (1 + (std::pow(x - 80, 2) + std::pow(y - 30, 2)) / (64.0 * 64));
    };
    for (int y = 0; y < 70; ++y) {
        for (int x = 0; x < 110; ++x) {
            if (edge().transmission(x, y) == 0) continue;
            ++pixels;
            halo += haloAt(x, y);
        }
    }
    for (const auto& [x, y] : {std::pair{109, 69}, {100, 30}, {60, 10}, {81, 30}}) {
        ASSERT_NE(edge().transmission(x, y), 0);
        const double wanted = kShare * 1e6 / 2 * (1 / pixels + haloAt(x, y) / halo);
        EXPECT_NEAR(double{seen.at(x, y)} / wanted, 1, 1e-6) << x << ' ' << y;
    }
}

}  // namespace
}  // namespace gonio::sim
