#include "sim/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "proc/models/spec.h"
#include "sim/light.h"
#include "sim/random.h"

namespace gonio::sim {
namespace {

using namespace std::chrono_literals;

// Frames of windows: what the errors do to DN, in electrons at 2.6 e-/DN.

constexpr View kMiddle{.x = 600, .y = 480, .size = {80, 64}};
constexpr double kPixels = 80 * 64;

Format window(const View& view) { return {.view = view}; }

Placement model(const char* spec, const SampleErrors& errors = {}) {
    return {.role = Role::Sample, .surface = *proc::makeModel(spec), .wedge = {}, .errors = errors};
}

Settings lit(int led, Band band, std::uint32_t exposureUs, std::uint16_t level = 65535) {
    Settings settings{.led = led, .exposureUs = exposureUs};
    settings.levels[index(band)] = level;
    return settings;
}

Camera camera(const RigErrors& rig, const Placement& placement = model("lambert,albedo=0.5")) {
    Camera made("SIM-0001", {.rig = rig});
    made.place(placement);
    return made;
}

/// Mean electrons of a pixel over so many frames.
double meanElectrons(Camera& camera,
                     const Settings& settings,
                     int frames = 1,
                     const Moment& moment = {}) {
    double sum = 0;
    for (int i = 0; i < frames; ++i) {
        const NoiseKey key{.seed = 3, .planStep = 7, .frameIndex = static_cast<std::uint64_t>(i)};
        const auto frame = camera.expose(settings, moment, window(kMiddle), key);
        for (std::uint16_t dn : frame.pixels()) sum += dn - kBlackLevel;
    }
    return 2.6 * sum / (kPixels * frames);
}

/// The mean rate at full level in the window, e-/s, without noise.
double meanRate(const Placement& placement, int led, Band band, const RigErrors& rig = {}) {
    const Optics optics("SIM-0001", {kSensorSize.width / 2.0, kSensorSize.height / 2.0});
    const LedLight light =
        ledLight(placement, {.rig = rig}, optics, FieldOfView(optics, kMiddle), led);
    double sum = 0;
    for (float rate : light.steady[index(band)].pixels()) sum += static_cast<double>(rate);
    return sum / kPixels;
}

/// Pixel by pixel, from what the headers say of a rig with nothing wrong.
Image<std::uint16_t> plainFrame(const Image<float>& rate, double seconds, const NoiseKey& key) {
    const Sensor sensor("SIM-0001");
    const std::uint64_t shot = mixed(mixed(mixed(key.seed, key.planStep), key.frameIndex), 1);
    const std::uint64_t read = mixed(shot, 2);
    Image<std::uint16_t> frame(rate.size());
    for (int y = 0; y < frame.height(); ++y) {
        for (int x = 0; x < frame.width(); ++x) {
            const auto pixel =
                static_cast<std::uint64_t>((kMiddle.y + y) * kSensorSize.width + kMiddle.x + x);
            const auto response = static_cast<double>(static_cast<float>(sensor.response(pixel)));
            const double mean = static_cast<double>(rate.at(x, y)) * seconds * response +
                                sensor.darkCurrent(pixel) * seconds;
            const double electrons = std::min(kFullWell, poisson(mean, uniform(shot, pixel))) +
                                     2.4 * gaussian(read, pixel);
            const double dn = std::clamp(electrons / 2.6 + 60, 0.0, 4095.0);
            frame.at(x, y) = static_cast<std::uint16_t>(dn + 0.5);
        }
    }
    return frame;
}

TEST(Camera, WithAllErrorsOffAFrameIsTheVerySameAsThePlainRigs) {
    const Placement placement = model("lambert,albedo=0.5/0.2/0.1+ggx,alpha=0.1,f0=0.3");
    const Optics optics("SIM-0001", {kSensorSize.width / 2.0, kSensorSize.height / 2.0});
    const LedLight light = ledLight(placement, {}, optics, FieldOfView(optics, kMiddle), 1);
    Camera plain = camera({}, placement);
    Camera off = camera(*parseRigErrors("glare=0,drift=0,step=0@1,offset_us=0,column_e=0,inl=0,"
                                        "crosstalk=0,source_deg=0,celsius=25,bits=12",
                                        {}),
                        placement);
    const NoiseKey key{.seed = 9, .planStep = 4, .frameIndex = 2};
    for (const std::uint32_t exposureUs : {20U, 320U, 5120U}) {
        const double seconds =
            1.0 * static_cast<double>(grantedExposure(exposureUs).count()) * 1e-9;
        const auto wanted = plainFrame(light.steady[0], seconds, key);
        const Settings settings = lit(1, Band::R, exposureUs);
        EXPECT_EQ(plain.expose(settings, {}, window(kMiddle), key), wanted) << exposureUs;
        EXPECT_EQ(off.expose(settings, {}, window(kMiddle), key), wanted) << exposureUs;
    }
}

TEST(Camera, AnExposureOffsetAddsItsTimeAtTheFluxOfTheShortestExposure) {
    const Placement placement = model("lambert,albedo=0.5");
    const double rate = meanRate(placement, 0, Band::G);
    Camera right = camera({}, placement);
    for (const Nanoseconds offset : {Nanoseconds(200ns), Nanoseconds(14us), Nanoseconds(-2us)}) {
        Camera late = camera({.exposureOffset = offset}, placement);
        constexpr int kFrames = 8;
        const double added = meanElectrons(late, lit(0, Band::G, 20), kFrames) -
                             meanElectrons(right, lit(0, Band::G, 20), kFrames);
        const double seconds = static_cast<double>(offset.count()) * 1e-9;
        // Two means of 40,960 pixels with some 140 electrons: 4 sqrt(2 x 250 / 40960) e-. The same
        // uniforms make most of the noise common.
        EXPECT_NEAR(added, rate * seconds, 0.45) << offset.count();
        EXPECT_GT(std::abs(rate * seconds), 1.4);
    }
}

/// The pixels that see the field, each weighted, by every fourth each way.
template <class Weight>
double sumOverField(const Optics& optics, Weight weight) {
    double sum = 0;
    for (int y = 2; y < kSensorSize.height; y += 4) {
        for (int x = 2; x < kSensorSize.width; x += 4) {
            if (optics.directionAt({double(x), double(y)})) sum += 16 * weight(x, y);
        }
    }
    return sum;
}

TEST(Camera, GlareAddsItsShareOfTheFieldsLightFromOutsideTheWindowToo) {
    // A mirror whose image is 600 pixels from the window: what the window gains is glare alone.
    const Placement mirror{.role = Role::Mirror, .surface = nullptr, .wedge = {0_deg, -5_deg}};
    const Optics optics("SIM-0001", {kSensorSize.width / 2.0, kSensorSize.height / 2.0});
    const Direction toward = mirrored(ledDirection(3), mirror.wedge);
    const ImagePoint image = optics.pixelOf(toward);
    const auto halo = [&](int x, int y) {
        return 1 / (1 + (std::pow(x - image.x, 2) + std::pow(y - image.y, 2)) / (64.0 * 64));
    };
    // Reflectance 0.9; the relative solid angles of its pixels sum up to its solid angle.
    const ImagePoint a = optics.pixelOf(Direction());
    const ImagePoint b = optics.pixelOf(Direction::fromSpherical(Radians(1e-3), 45_deg));
    const double perRadian = std::hypot(a.x - b.x, a.y - b.y) / 1e-3;
    const double light =
        0.9 * ledRate(3, Band::G) * optics.vignetting(toward) * perRadian * perRadian;
    const double evenly = 1 / sumOverField(optics, [](int, int) { return 1; });
    const double haloThere = halo(kMiddle.x + 40, kMiddle.y + 32) / sumOverField(optics, halo);
    Camera glaring = camera({.glare = 0.01}, mirror);
    Camera clear = camera({}, mirror);
    const Settings settings = lit(3, Band::G, 10'000);
    const double seconds = static_cast<double>(grantedExposure(10'000).count()) * 1e-9;
    const double added = meanElectrons(glaring, settings) - meanElectrons(clear, settings);
    // As well as the image's rim is sampled and one radius stands for all: 3 %.
    EXPECT_NEAR(added / (0.01 * light / 2 * (evenly + haloThere) * seconds), 1, 0.04);
}

TEST(Camera, CrosstalkTakesItsShareFromTheOtherBands) {
    // Red without any f of its own shows c of the green one.
    const Placement placement = model("lambert,albedo=0/0.8/0");
    const double pure = meanRate(placement, 0, Band::R);
    const double mixed = meanRate(placement, 0, Band::R, {.crosstalk = 0.01});
    const double seconds = static_cast<double>(grantedExposure(5000).count()) * 1e-9;
    Camera crossed = camera({.crosstalk = 0.01}, placement);
    Camera right = camera({}, placement);
    const double added =
        meanElectrons(crossed, lit(0, Band::R, 5000)) - meanElectrons(right, lit(0, Band::R, 5000));
    EXPECT_NEAR(added, (mixed - pure) * seconds, 1);
    // 1 % of 0.8 / pi, seen at nearly the normal in red.
    EXPECT_NEAR((mixed - pure) / (ledRate(0, Band::R) * 0.008 / kPi), 1, 0.01);
}

TEST(Camera, AmbientLightIsThereWhetherLedsAreOnOrOff) {
    const SampleErrors leaking{.ambient = 0.002};
    Camera tight = camera({}, model("lambert,albedo=0.05"));
    Camera leaky = camera({}, model("lambert,albedo=0.05", leaking));
    const Settings dark{.exposureUs = 10'000};
    const double added = meanElectrons(leaky, dark) - meanElectrons(tight, dark);
    const double seconds = static_cast<double>(grantedExposure(10'000).count()) * 1e-9;
    // In the middle of the field, 0.6 degrees off at most: vignetting and wo.y change it by 1 %.
    EXPECT_NEAR(added / (0.002 * ledRate(0, Band::G) * seconds), 1, 0.02);
    const Settings on = lit(2, Band::B, 10'000);
    EXPECT_NEAR(meanElectrons(leaky, on) - meanElectrons(tight, on), added, 4);
    Camera empty = camera({}, {});
    EXPECT_NEAR(meanElectrons(empty, dark), meanElectrons(tight, dark), 0.01);
}

TEST(Camera, ASoftSamplesLobeFadesWithTheTimeSinceItWasPlaced) {
    const SampleErrors soft{.softness = 0.1};
    Camera firm = camera({}, model("lambert,albedo=0.5"));
    Camera pressed = camera({}, model("lambert,albedo=0.5", soft));
    const Settings settings = lit(0, Band::G, 500);  // the mirror direction is in the window
    const double truth = meanElectrons(firm, settings);
    const auto excess = [&](Nanoseconds since) {
        return meanElectrons(pressed, settings, 1, {.sincePlaced = since}) / truth - 1;
    };
    // Nearly in the middle of a lobe of 10 degrees, and 3500 e- in each of 5120 pixels: 1e-3.
    EXPECT_NEAR(excess(0s), 0.1, 0.01);
    EXPECT_NEAR(excess(1s), 0.1 * std::exp(-1.0), 0.005);
    EXPECT_NEAR(excess(20s), 0, 2e-3);
}

TEST(Camera, TheLedsOutputAndSeveralBandsAddUpAsTheyDidWithoutErrors) {
    Camera made = camera({});
    Settings both = lit(1, Band::R, 200, 30000);
    both.levels[index(Band::B)] = 20000;
    const double sum = meanElectrons(made, both, 4);
    const double red = meanElectrons(made, lit(1, Band::R, 200, 30000), 4);
    const double blue = meanElectrons(made, lit(1, Band::B, 200, 20000), 4);
    EXPECT_NEAR(sum, red + blue, 1);
    const double half =
        meanElectrons(made, lit(1, Band::R, 200, 30000), 4, {.output = LedBands::all(0.5)});
    EXPECT_NEAR(half, red / 2, 1);
}

}  // namespace
}  // namespace gonio::sim
