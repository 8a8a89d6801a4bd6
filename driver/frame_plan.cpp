#include "driver/frame_plan.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "driver/protocol/pixels.h"

namespace gonio::driver {
namespace {

/// The first disagreement between what was planned and what the rig says, as text.
class Comparison {
public:
    void check(const char* what, std::int64_t seen, std::int64_t planned) {
        if (seen == planned || !why_.empty()) return;
        why_ =
            std::string(what) + " " + std::to_string(seen) + ", planned " + std::to_string(planned);
    }
    [[nodiscard]] const std::string& why() const { return why_; }

private:
    std::string why_;
};

int channelsOf(const LedLevels& levels) {
    int bits = 0;
    for (Band band : kBands) bits |= levels[band] != 0 ? 1 << index(band) : 0;
    return bits;
}

std::string mismatch(const Leader& leader, const FramePlan& plan) {
    const Size sent = plan.window.sent();
    Comparison c;
    c.check("LEADER width", leader.width, sent.width);
    c.check("LEADER height", leader.height, sent.height);
    c.check("LEADER pixel_format", static_cast<int>(leader.format), static_cast<int>(plan.format));
    c.check("LEADER stride", leader.stride, strideOf(plan.format, sent.width).value_or(0));
    c.check(
        "LEADER frame_bytes", leader.frameBytes, frameBytes(plan.window, plan.format).value_or(0));
    c.check("LEADER x", leader.x, plan.window.x);
    c.check("LEADER y", leader.y, plan.window.y);
    c.check("LEADER binning", leader.binning, plan.window.binning);
    c.check("LEADER bit_depth", leader.bitDepth, plan.bitDepth);
    c.check("LEADER led", leader.led, plan.led.value_or(kDarkLed));
    c.check("LEADER channels", leader.channels, channelsOf(plan.levels));
    for (Band band : kBands)
        c.check("LEADER led_level", leader.ledLevel[index(band)], plan.levels[band]);
    c.check("LEADER exposure_requested_us",
            leader.exposureRequestedUs,
            plan.exposure.requested.count());
    // Above the largest int64 the granted time cannot be the planned one either.
    c.check("LEADER exposure_granted_ns",
            static_cast<std::int64_t>(std::min<std::uint64_t>(
                leader.exposureGrantedNs, std::numeric_limits<std::int64_t>::max())),
            plan.exposure.granted.count());
    c.check("LEADER gain", leader.gain, plan.gain);
    return c.why();
}

std::string invalidity(std::uint16_t bits) {
    if ((bits & validity::kInterlock) == 0) return "TRAILER: the interlock did not stay closed";
    if ((bits & validity::kCurrent) == 0) return "TRAILER: LED current left its tolerance";
    if ((bits & validity::kTemperature) == 0) return "TRAILER: a temperature is out of range";
    return {};
}

std::array<double, 3> milliamp(const std::array<std::uint16_t, 3>& tenths) {
    return {tenths[0] * 0.1, tenths[1] * 0.1, tenths[2] * 0.1};
}

Frame toFrame(const WireFrame& wire, const FramePlan& plan, Image<std::uint16_t>& memory) {
    if (memory.size() != plan.window.sent()) memory = Image<std::uint16_t>(plan.window.sent());
    unpackInto(memory, wire.bytes, plan.format);
    Frame frame{.pixels = std::move(memory),
                .captureId = wire.captureId,
                .index = wire.index,
                .number = wire.leader.frameNumber,
                .led = plan.led,
                .levels = plan.levels,
                .exposure = plan.exposure,
                .gainDb = plan.gain * 0.01,
                .window = plan.window,
                .bitDepth = wire.leader.bitDepth,
                .blackLevel = wire.leader.blackLevel,
                .celsius = {},
                .currentMinMilliamp = milliamp(wire.trailer.currentMin),
                .currentMaxMilliamp = milliamp(wire.trailer.currentMax),
                .saturatedPixels = wire.trailer.saturatedPixels,
                .start = Microseconds(static_cast<std::int64_t>(wire.leader.exposureStartUs))};
    for (std::size_t i = 0; i < frame.celsius.size(); ++i) {
        frame.celsius[i] = celsius(wire.leader.temperature[i]);
    }
    return frame;
}

}  // namespace

std::optional<std::uint32_t> frameBytes(const Window& window, PixelFormat format) {
    if (window.binning < 1) return std::nullopt;
    const Size sent = window.sent();
    constexpr int kMaxSide = std::numeric_limits<std::uint16_t>::max();
    if (sent.width < 1 || sent.height < 1 || sent.width > kMaxSide || sent.height > kMaxSide)
        return std::nullopt;
    const auto stride = strideOf(format, sent.width);
    if (!stride) return std::nullopt;
    const std::uint64_t bytes = std::uint64_t{*stride} * static_cast<std::uint64_t>(sent.height);
    if (bytes > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
    return static_cast<std::uint32_t>(bytes);
}

Verdict judge(const WireFrame& wire, const FramePlan& plan) {
    Image<std::uint16_t> memory;
    return judge(wire, plan, memory);
}

Verdict judge(const WireFrame& wire, const FramePlan& plan, Image<std::uint16_t>& memory) {
    // frame_number wraps like stream_seq would: the nearer way round decides.
    if (static_cast<std::int32_t>(wire.leader.frameNumber - plan.effectiveFrame) < 0)
        return Early{};
    if (std::string why = mismatch(wire.leader, plan); !why.empty()) return Rejected{why};
    if (std::string why = invalidity(wire.trailer.validity); !why.empty()) return Rejected{why};
    return toFrame(wire, plan, memory);
}

}  // namespace gonio::driver
