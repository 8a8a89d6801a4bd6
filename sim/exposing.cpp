#include "sim/exposing.h"

#include <algorithm>

#include "driver/protocol/pixels.h"
#include "sim/light.h"

namespace gonio::sim {

using namespace driver;  // the wire's words

namespace {

std::uint64_t microseconds(Nanoseconds t) { return static_cast<std::uint64_t>(t.count() / 1000); }

}  // namespace

void Settings::darken() {
    led = -1;
    levels = {};
}

std::array<std::uint16_t, 3> currents(const std::array<std::uint16_t, 3>& levels) {
    std::array<std::uint16_t, 3> current{};
    for (std::size_t c = 0; c < 3; ++c) {
        current[c] = static_cast<std::uint16_t>((levels[c] * kFullCurrent[c] + 32767U) / 65535U);
    }
    return current;
}

Leader leaderOf(const Exposing& done,
                const Format& format,
                Size sent,
                const Digits& digits,
                const Temperatures& temperatures) {
    const Settings& s = done.settings;
    Leader leader;
    leader.width = static_cast<std::uint16_t>(sent.width);
    leader.height = static_cast<std::uint16_t>(sent.height);
    leader.stride = *strideOf(format.format, sent.width);
    leader.format = format.format;
    leader.led = s.led >= 0 ? static_cast<std::uint8_t>(s.led) : kDarkLed;
    for (unsigned c = 0; c < 3; ++c) {
        if (s.led >= 0 && s.levels[c] != 0) leader.channels |= static_cast<std::uint8_t>(1U << c);
    }
    leader.exposureRequestedUs = s.exposureUs;
    leader.exposureGrantedNs = static_cast<std::uint64_t>(grantedExposure(s.exposureUs).count());
    leader.gain = s.gain;
    if (s.led >= 0) leader.ledLevel = s.levels;
    leader.temperature = temperatures;
    leader.bitDepth = static_cast<std::uint8_t>(digits.bits);
    leader.blackLevel = digits.blackLevel;
    leader.x = static_cast<std::uint16_t>(format.view.x);
    leader.y = static_cast<std::uint16_t>(format.view.y);
    leader.binning = static_cast<std::uint8_t>(format.binning);
    leader.frameBytes = leader.stride * static_cast<std::uint32_t>(sent.height);
    leader.exposureStartUs = microseconds(done.start) + done.clockUs;
    leader.frameNumber = done.number;
    return leader;
}

Trailer trailerOf(const Exposing& done, const Image<std::uint16_t>& image, const Digits& digits) {
    Trailer trailer;
    trailer.exposureEndUs = microseconds(done.end) + done.clockUs;
    if (done.settings.led >= 0) {
        trailer.currentMin = trailer.currentMax = currents(done.settings.levels);
    }
    trailer.validity = done.seated ? validity::kAll : validity::kCurrent | validity::kTemperature;
    if (done.flaw == FrameFlaw::LedDrift && done.settings.led >= 0) {
        for (std::uint16_t& current : trailer.currentMax)
            current = static_cast<std::uint16_t>(current + current / kDriftedPart);
        trailer.validity &= static_cast<std::uint16_t>(~validity::kCurrent);
    }
    trailer.saturatedPixels = static_cast<std::uint32_t>(
        std::count(image.pixels().begin(), image.pixels().end(), digits.fullScale));
    return trailer;
}

}  // namespace gonio::sim
