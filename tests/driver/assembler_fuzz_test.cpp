// Streams with chunks lost, doubled, swapped, cut, flipped and forged through the assembler: no
// crash, no read or write past an end (sanitizers watch), and no frame that was not sent.

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "driver/assembler.h"
#include "tests/driver/wire_frames.h"

namespace gonio::driver {
namespace {

using test::Bytes;

constexpr Size kSize{8, 6};
constexpr int kFrames = 3;
constexpr std::uint64_t kNext = 0x60001;

int cases() { return std::getenv("GONIO_NIGHTLY") != nullptr ? 1'000'000 : 20'000; }

void mutate(std::vector<Bytes>& chunks, std::mt19937_64& random) {
    Bytes& chunk = chunks[random() % chunks.size()];
    switch (random() % 6) {
        case 0: chunk.clear(); break;
        case 1: chunk.resize(random() % (chunk.size() + 9)); break;
        case 2: chunks.push_back(chunk); break;
        case 3: std::swap(chunk, chunks[random() % chunks.size()]); break;
        case 4:
            if (!chunk.empty())
                chunk[random() % chunk.size()] ^= static_cast<std::uint8_t>(random());
            break;
        default: {  // sound by every CRC, but a lie
            const auto decoded = decodeChunk(chunk);
            if (!decoded) break;
            ChunkHeader header = decoded->header;
            header.type = static_cast<ChunkType>(random() % 7);
            header.frameIndex = static_cast<std::uint16_t>(random() % 5);
            header.chunkIndex = static_cast<std::uint16_t>(random() % 9);
            header.offset = static_cast<std::uint32_t>(random());
            chunk = encodeChunk(header, decoded->payload);
        }
    }
}

TEST(AssemblerFuzz, NeverMakesAFrameThatWasNotSent) {
    std::mt19937_64 random(21);
    std::vector<Bytes> sound;
    for (int i = 0; i < kFrames; ++i) {
        for (Bytes& chunk : test::toChunks({.index = i, .pixels = test::picture(kSize, i)}, 1))
            sound.push_back(std::move(chunk));
    }
    for (Bytes& chunk : test::toChunks({.captureId = kNext, .pixels = test::picture(kSize, 0)}, 22))
        sound.push_back(std::move(chunk));
    const auto expected = [](std::uint64_t capture, int frames) {
        return ExpectedCapture{.bootId = test::kBoot,
                               .captureId = capture,
                               .frames = frames,
                               .frameBytes = 72,
                               .maxChunkPayload = test::kPayload};
    };
    int finished = 0;
    for (int i = 0; i < cases(); ++i) {
        Assembler assembler;
        ASSERT_TRUE(assembler.expect(expected(0x50001, kFrames)));
        ASSERT_TRUE(assembler.expectNext(expected(kNext, 1)));
        std::vector<Bytes> chunks = sound;
        for (std::uint64_t k = random() % 6; k > 0; --k) mutate(chunks, random);
        for (const Bytes& chunk : chunks) {
            assembler.feed(chunk);
            for (const MissingChunks& lost : assembler.lost()) {
                ASSERT_LE(lost.first, lost.last);
                if (random() % 2 == 0) assembler.askedFor(lost);
            }
        }
        for (const std::uint64_t capture : {std::uint64_t{0x50001}, kNext}) {
            while (const auto frame = assembler.take()) {
                ++finished;
                const auto sent = test::picture(kSize, frame->index);
                ASSERT_EQ(frame->captureId, capture);
                ASSERT_EQ(frame->bytes, packPixels(sent, PixelFormat::Mono12Packed)) << i;
            }
            assembler.moveOn();
        }
    }
    EXPECT_GT(finished, cases()) << "mutations must leave something to assemble";
}

}  // namespace
}  // namespace gonio::driver
