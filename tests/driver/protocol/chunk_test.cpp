#include "driver/protocol/chunk.h"

#include <gtest/gtest.h>

#include "driver/protocol/crc.h"
#include "tests/support/hex.h"

namespace gonio::driver {
namespace {

ChunkHeader goldenHeader() {
    return {.type = ChunkType::Data,
            .bootId = 0xB0071D01,
            .streamSequence = 42,
            .captureId = 0x0102030405060708,
            .frameIndex = 3,
            .chunkIndex = 1,
            .chunkCount = 8,
            .resent = false,
            .offset = 0,
            .length = 9,
            .timeUs = 1234567};
}

std::vector<std::uint8_t> goldenChunk() {
    return test::hex(
        "47 4E 46 31 01 02 40 00 01 1D 07 B0 2A 00 00 00 08 07 06 05 04 03 02 01 03 00 01 00 08 00 "
        "00 00 "
        "00 00 00 00 09 00 00 00 87 D6 12 00 00 00 00 00 83 92 06 E3 00 00 00 00 00 00 00 00 A1 93 "
        "53 91 "
        "31 32 33 34 35 36 37 38 39");
}

Leader goldenLeader() {
    return {.width = 3,
            .height = 2,
            .stride = 5,
            .format = PixelFormat::Mono12Packed,
            .led = 2,
            .channels = 1,
            .bitDepth = 12,
            .exposureRequestedUs = 1000,
            .exposureGrantedNs = 1004260,
            .gain = 0,
            .ledLevel = {65535, 0, 0},
            .temperature = {2600, 2900, 2500, 2300},
            .blackLevel = 60,
            .x = 0,
            .y = 0,
            .binning = 1,
            .frameBytes = 10,
            .exposureStartUs = 1234567,
            .frameNumber = 7};
}

TEST(Golden, ChunkHeader) {
    const auto payload = test::hex("31 32 33 34 35 36 37 38 39");
    EXPECT_EQ(encodeChunk(goldenHeader(), payload), goldenChunk());
    const auto bytes = goldenChunk();
    const auto chunk = decodeChunk(bytes);
    ASSERT_TRUE(chunk);
    EXPECT_EQ(chunk->header, goldenHeader());
    EXPECT_EQ(chunk->payload.size(), 9U);
}

TEST(Golden, Leader) {
    const auto bytes = test::hex(
        "03 00 02 00 05 00 00 00 01 02 01 0C E8 03 00 00 E4 52 0F 00 00 00 00 00 00 00 FF FF 00 00 "
        "00 00 "
        "28 0A 54 0B C4 09 FC 08 3C 00 00 00 00 00 01 00 0A 00 00 00 87 D6 12 00 00 00 00 00 07 00 "
        "00 00");
    EXPECT_EQ(encode(goldenLeader()), bytes);
    EXPECT_EQ(crc32c(bytes), 0x1E0CB1A3U);
    const auto back = decodeLeader(bytes);
    ASSERT_TRUE(back);
    EXPECT_EQ(*back, goldenLeader());
}

TEST(Chunk, TrailerAndAbortedRoundTrip) {
    const Trailer trailer{.frameBytes = 10,
                          .frameCrc = 0xB4ED3658,
                          .exposureEndUs = 99,
                          .currentMin = {1, 2, 3},
                          .currentMax = {4, 5, 6},
                          .validity = 7,
                          .saturatedPixels = 8};
    const auto back = decodeTrailer(encode(trailer));
    ASSERT_TRUE(back);
    EXPECT_EQ(*back, trailer);
    const Aborted aborted{.reason = status::kInterlock, .frameNumber = 12};
    const auto backAborted = decodeAborted(encode(aborted));
    ASSERT_TRUE(backAborted);
    EXPECT_EQ(*backAborted, aborted);
}

TEST(Chunk, RejectsEveryTruncation) {
    const auto bytes = goldenChunk();
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        EXPECT_FALSE(decodeChunk(std::span(bytes).first(length))) << length;
    }
    const auto leader = encode(goldenLeader());
    EXPECT_FALSE(decodeLeader(std::span(leader).first(63)));
    EXPECT_FALSE(decodeTrailer({}));
    EXPECT_FALSE(decodeAborted({}));
}

TEST(Chunk, RejectsEveryFlippedBit) {
    const auto bytes = goldenChunk();
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        auto flipped = bytes;
        flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ (1U << (bit % 8)));
        EXPECT_FALSE(decodeChunk(flipped)) << "bit " << bit;
    }
}

TEST(Chunk, RejectsTrailingBytes) {
    auto bytes = goldenChunk();
    bytes.push_back(0);
    EXPECT_FALSE(decodeChunk(bytes));
}

TEST(Chunk, ResentDiffersInSequenceFlagsAndHeaderCrcOnly) {
    auto bytes = goldenChunk();
    restamp(bytes, 77, true);
    const auto original = goldenChunk();
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const bool may = (i >= 12 && i < 16) || (i >= 30 && i < 32) || (i >= 60 && i < 64);
        if (!may) {
            EXPECT_EQ(bytes[i], original[i]) << i;
        }
    }
    const auto chunk = decodeChunk(bytes);
    ASSERT_TRUE(chunk);
    EXPECT_TRUE(chunk->header.resent);
    EXPECT_EQ(chunk->header.streamSequence, 77U);
}

TEST(CheckChunk, NamesWhatIsWrongAndKeepsWhatCanBeBelieved) {
    const auto good = goldenChunk();
    const auto check = [&](auto change) {
        auto bytes = good;
        change(bytes);
        return checkChunk(bytes);
    };
    const auto reseal = [](std::vector<std::uint8_t>& bytes) { restamp(bytes, 42, false); };

    const CheckedChunk sound = checkChunk(good);
    EXPECT_EQ(sound.fault, ChunkFault::None);
    EXPECT_EQ(sound.headerBytes, kChunkHeaderBytes);
    EXPECT_EQ(sound.chunk.header, goldenHeader());
    EXPECT_EQ(sound.chunk.payload.size(), 9U);

    EXPECT_EQ(checkChunk({}).fault, ChunkFault::Empty);
    EXPECT_EQ(checkChunk(std::span(good).first(63)).fault, ChunkFault::Short);
    EXPECT_EQ(check([](auto& b) { b[0] ^= 1; }).fault, ChunkFault::Magic);
    EXPECT_EQ(check([](auto& b) { b[12] ^= 1; }).fault, ChunkFault::HeaderCrc);
    EXPECT_EQ(check([&](auto& b) {
                  b[4] = 2;
                  reseal(b);
              }).fault,
              ChunkFault::Version);
    // After Length and PayloadCrc the header still holds, and no payload is handed out.
    for (const CheckedChunk& seen : {check([](auto& b) { b.pop_back(); }),
                                     check([](auto& b) { b.push_back(0); }),
                                     check([](auto& b) { b.back() ^= 1; })}) {
        EXPECT_TRUE(seen.fault == ChunkFault::Length || seen.fault == ChunkFault::PayloadCrc);
        EXPECT_EQ(seen.chunk.header, goldenHeader());
        EXPECT_TRUE(seen.chunk.payload.empty());
    }
}

TEST(CheckChunk, ALongerHeaderOfALaterMinorIsSkipped) {
    auto bytes = goldenChunk();
    bytes.insert(bytes.begin() + kChunkHeaderBytes, 4, 0xEE);
    bytes[6] = 68;  // header_len
    restamp(bytes, 42, false);
    const CheckedChunk seen = checkChunk(bytes);
    EXPECT_EQ(seen.fault, ChunkFault::None);
    EXPECT_EQ(seen.headerBytes, 68U);
    ASSERT_EQ(seen.chunk.payload.size(), 9U);
    EXPECT_EQ(seen.chunk.payload[0], '1');
    bytes[6] = 63;  // shorter than the fields that we read, the length as it then would be
    bytes[36] = static_cast<std::uint8_t>(bytes.size() - 63);
    restamp(bytes, 42, false);
    EXPECT_EQ(checkChunk(bytes).fault, ChunkFault::Length);
}

}  // namespace
}  // namespace gonio::driver
