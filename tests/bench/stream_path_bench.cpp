// What a frame costs between the USB library and the Frame: both checksums, the one copy out of the
// transfer's buffer, the assembly, the verdict, the unpacking; and its parts. A full frame of 1024
// x 1024 pixels, 12 bit packed. Times 25 or 60 a second is the stream path's share of a core. Rates
// are of the bytes as sent.

#include <benchmark/benchmark.h>

#include <cstring>
#include <span>
#include <variant>

#include "driver/assembler.h"
#include "driver/frame_plan.h"
#include "driver/protocol/crc.h"
#include "driver/protocol/pixels.h"
#include "sim/frame_chunks.h"

namespace gonio {
namespace {

using namespace driver;
using Bytes = std::vector<std::uint8_t>;

constexpr Size kSize{1024, 1024};
constexpr Window kWindow{.x = 128, .y = 0, .size = kSize, .binning = 1};
constexpr std::uint32_t kBoot = 7;
constexpr std::uint64_t kCapture = 0x10001;
constexpr std::int64_t kGranted = 320'000;

struct Sent {
    std::uint32_t frameBytes = 0;
    std::vector<Bytes> chunks;
};

Sent oneFrame() {
    Image<std::uint16_t> image(kSize);
    std::uint32_t value = 1;
    for (auto& pixel : image.pixels()) {
        value = value * 1664525U + 1013904223U;
        pixel = static_cast<std::uint16_t>(value >> 20U);
    }
    const Bytes pixels = packPixels(image, PixelFormat::Mono12Packed);
    const auto bytes = static_cast<std::uint32_t>(pixels.size());
    Leader leader;
    leader.width = leader.height = 1024;
    leader.stride = *strideOf(PixelFormat::Mono12Packed, kSize.width);
    leader.format = PixelFormat::Mono12Packed;
    leader.led = kDarkLed;
    leader.bitDepth = 12;
    leader.exposureRequestedUs = 320;
    leader.exposureGrantedNs = kGranted;
    leader.x = 128;
    leader.binning = 1;
    leader.frameBytes = bytes;
    leader.frameNumber = 1;
    Trailer trailer;
    trailer.frameBytes = bytes;
    trailer.frameCrc = crc32c(pixels);
    trailer.validity = validity::kAll;
    return {
        bytes,
        sim::frameChunks(
            {.bootId = kBoot, .captureId = kCapture, .frameIndex = 0}, leader, pixels, trailer)};
}

void setRate(benchmark::State& state, std::size_t bytes) {
    state.SetBytesProcessed(static_cast<std::int64_t>(bytes) * state.iterations());
}

void streamPath(benchmark::State& state) {
    const Sent sent = oneFrame();
    const FramePlan plan{
        .window = kWindow,
        .format = PixelFormat::Mono12Packed,
        .led = std::nullopt,
        .levels = {},
        .exposure = {.requested = Microseconds(320), .granted = Nanoseconds(kGranted)},
        .effectiveFrame = 1};
    Assembler assembler;
    Image<std::uint16_t> memory(kSize);
    for (auto _ : state) {
        const auto expected = assembler.expect({.bootId = kBoot,
                                                .captureId = kCapture,
                                                .frames = 1,
                                                .frameBytes = sent.frameBytes,
                                                .maxChunkPayload = sim::kMaxChunkPayload});
        if (!expected) state.SkipWithError("not expected");
        for (const Bytes& chunk : sent.chunks) assembler.feed(chunk);
        auto wire = assembler.take();
        if (!wire) {
            state.SkipWithError("no frame");
            break;
        }
        auto verdict = judge(*wire, plan, memory);
        auto* frame = std::get_if<Frame>(&verdict);
        if (!frame) {
            state.SkipWithError("not as planned");
            break;
        }
        benchmark::DoNotOptimize(frame);
        memory = std::move(frame->pixels);
        assembler.giveBack(std::move(*wire));
    }
    setRate(state, sent.frameBytes);
    const auto rate = [&](double fps) {
        return benchmark::Counter(
            fps,
            static_cast<benchmark::Counter::Flags>(benchmark::Counter::kIsIterationInvariantRate |
                                                   benchmark::Counter::kInvert));
    };
    state.counters["core_share_25_fps"] = rate(1.0 / 25);
    state.counters["core_share_60_fps"] = rate(1.0 / 60);
}
BENCHMARK(streamPath)->Unit(benchmark::kMicrosecond)->Repetitions(5)->ReportAggregatesOnly();

/// The yardstick: the same bytes, copied.
void copied(benchmark::State& state) {
    const Sent sent = oneFrame();
    Bytes to(sent.frameBytes);
    const Bytes from(sent.frameBytes, 1);
    for (auto _ : state) {
        std::memcpy(to.data(), from.data(), from.size());
        benchmark::ClobberMemory();
    }
    setRate(state, sent.frameBytes);
}
BENCHMARK(copied)->Unit(benchmark::kMicrosecond)->Repetitions(5)->ReportAggregatesOnly();

template <std::uint32_t (*sum)(std::span<const std::uint8_t>)>
void summed(benchmark::State& state) {
    const Bytes bytes = oneFrame().chunks[1];
    for (auto _ : state) benchmark::DoNotOptimize(sum(bytes));
    setRate(state, bytes.size());
}
BENCHMARK(summed<crc32c>)->Name("crc")->Repetitions(5)->ReportAggregatesOnly();
BENCHMARK(summed<crc32cByTable>)->Name("crcByTable")->Repetitions(5)->ReportAggregatesOnly();

/// Pixels from their bytes, and with that the checksum of the bytes.
void unpacked(benchmark::State& state) {
    const bool checked = state.range(0) != 0;
    const Bytes bytes(*strideOf(PixelFormat::Mono12Packed, kSize.width) * 1024U, 0x5A);
    Image<std::uint16_t> image(kSize);
    for (auto _ : state) {
        if (checked) benchmark::DoNotOptimize(crc32c(bytes));
        unpackInto(image, bytes, PixelFormat::Mono12Packed);
        benchmark::ClobberMemory();
    }
    setRate(state, bytes.size());
}
BENCHMARK(unpacked)
    ->ArgName("crc")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMicrosecond)
    ->Repetitions(5)
    ->ReportAggregatesOnly();

}  // namespace
}  // namespace gonio

BENCHMARK_MAIN();
