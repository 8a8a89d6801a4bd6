#include "tests/study/study_rig.h"

#include <cmath>
#include <stdexcept>

#include "proc/optics/mirror.h"
#include "proc/radiance/merge.h"
#include "sim/light.h"
#include "sim/random.h"

namespace gonio::study {
namespace {

constexpr const char* kSerial = "SIM-0001";
constexpr double kSpotPixels = 0.03;  // k = 1, of either coordinate
constexpr double kPixelsPerDegree = 6.6;
constexpr Radians kField = 75_deg;
constexpr std::uint32_t kExposuresUs[] = {40000, 5120, 320, 20};
constexpr double kDimLevels[] = {0.05, 0.0025};
constexpr std::size_t kMattExposures = 3;
constexpr int kDarkFrames = 4;
constexpr std::uint64_t kDarkCapture = 1000;  // captures of a repeat are below it

template <class T>
T orThrow(Result<T> result) {
    if (!result) throw std::runtime_error(result.error().message);
    return std::move(*result);
}

}  // namespace

double Draw::normal(std::string_view what, std::uint64_t number) const {
    std::uint64_t key = seed_;
    for (const char c : what) key = sim::mixed(key, static_cast<unsigned char>(c));
    return sim::gaussian(key, number);
}

sim::Flaws Draw::flaws() const {
    return {.references = sim::ReferenceErrors::random(seed_), .rig = {}, .seed = seed_};
}

sim::Wedge Draw::tilt(std::uint64_t material) const {
    return {.aboutX = kSampleTilt * normal("tilt x", material),
            .aboutY = kSampleTilt * normal("tilt y", material)};
}

StudyRig::StudyRig(const sim::View& strip)
    : strip_(strip),
      optics_(kSerial, {sim::kSensorSize.width / 2.0, sim::kSensorSize.height / 2.0}),
      sensor_(kSerial),
      field_(optics_, strip) {}

Window StudyRig::window() const {
    return {.x = strip_.x, .y = strip_.y, .size = strip_.size, .binning = 1};
}

proc::LensFit StudyRig::lensMap(const Draw& draw) const {
    std::vector<proc::MirrorSpot> spots;
    for (const proc::Wedge& nominal : proc::mirrorWedges()) {
        const sim::Wedge ground =
            sim::asGround({nominal.aboutX, nominal.aboutY}, draw.seed(), kWedgeTolerance);
        for (int led = 0; led < sim::kLeds; ++led) {
            const Direction light = sim::ledDirection(led);
            const Direction seen = sim::mirrored(light, ground);
            if (seen.theta() > kField) continue;
            const sim::ImagePoint at = optics_.pixelOf(seen);
            const std::uint64_t number = spots.size();
            spots.push_back({.wedge = nominal,
                             .light = light,
                             .at = {at.x + kSpotPixels * draw.normal("spot x", number),
                                    at.y + kSpotPixels * draw.normal("spot y", number)},
                             .sigma = kSpotPixels});
        }
    }
    return orThrow(proc::fitLens(spots,
                                 {sim::kSensorSize.width / 2.0, sim::kSensorSize.height / 2.0},
                                 kPixelsPerDegree,
                                 kWedgeTolerance));
}

Frame StudyRig::frame(const Image<float>* rate,
                      double output,
                      double level,
                      std::uint32_t exposureUs,
                      const sim::NoiseKey& key) const {
    constexpr double kFullLevel = 65535;
    const auto drive = static_cast<std::uint16_t>(std::lround(level * kFullLevel));
    const Nanoseconds granted = sim::grantedExposure(exposureUs);
    Frame frame;
    frame.pixels = sensor_.expose(rate, drive / kFullLevel * output, granted, strip_, key, 1);
    frame.levels = LedLevels::only(kBand, drive);
    if (rate != nullptr) frame.led = 0;
    frame.exposure = {.requested = Microseconds(exposureUs), .granted = granted};
    frame.window = window();
    frame.blackLevel = sim::kBlackLevel;
    frame.number = static_cast<std::uint32_t>(key.planStep * 100 + key.frameIndex);
    return frame;
}

proc::DarkLibrary StudyRig::darks(const Draw& draw) const {
    proc::DarkLibrary library;
    for (std::size_t i = 0; i < std::size(kExposuresUs); ++i) {
        std::vector<Frame> frames;
        for (std::uint64_t n = 0; n < kDarkFrames; ++n) {
            frames.push_back(
                frame(nullptr, 1, 0, kExposuresUs[i], {draw.seed(), kDarkCapture + i, n}));
        }
        library.add(orThrow(proc::averageDark(frames, {})));
    }
    return library;
}

proc::CellSignal StudyRig::signal(const sim::Placement& placement,
                                  int led,
                                  bool glossy,
                                  std::uint64_t number,
                                  const Draw& draw,
                                  const proc::DarkLibrary& darks,
                                  const proc::Binning& binning) const {
    const sim::LedLight light = sim::ledLight(placement, draw.flaws(), optics_, field_, led);
    const double output = 1 + kLedDrift * draw.normal("drift", number);
    std::vector<Frame> bracket;
    const auto add = [&](double level, std::uint32_t exposureUs) {
        bracket.push_back(frame(&light.steady[index(kBand)],
                                output,
                                level,
                                exposureUs,
                                {draw.seed(), number, bracket.size()}));
    };
    const std::size_t exposures = glossy ? std::size(kExposuresUs) : kMattExposures;
    for (std::size_t i = 0; i < exposures; ++i) add(1, kExposuresUs[i]);
    if (glossy) {
        for (const double level : kDimLevels) add(level, kExposuresUs[exposures - 1]);
    }
    return binning.bin(orThrow(proc::merge(bracket, kBand, darks, {})));
}

}  // namespace gonio::study
