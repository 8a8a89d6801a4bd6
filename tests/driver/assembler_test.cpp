#include "driver/assembler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <string>

#include "tests/driver/wire_frames.h"

namespace gonio::driver {
namespace {

using test::Bytes;

constexpr std::uint64_t kCapture = 0x50001;
constexpr Size kSize{8, 6};                // 12 bytes a row in format 1: 72 bytes, 5 DATA chunks
constexpr std::uint32_t kFrameBytes = 72;  // so chunks 0..6: LEADER, 5 x DATA, TRAILER
constexpr std::uint16_t kTrailer = 6;

std::vector<Bytes> frame(int index, std::uint32_t sequence, std::uint64_t capture = kCapture) {
    return test::toChunks({.captureId = capture,
                           .index = index,
                           .leader = {},
                           .trailer = {},
                           .pixels = test::picture(kSize, index)},
                          sequence);
}

Assembler expecting(int frames) {
    Assembler assembler;
    EXPECT_TRUE(assembler.expect({.bootId = test::kBoot,
                                  .captureId = kCapture,
                                  .frames = frames,
                                  .frameBytes = kFrameBytes,
                                  .maxChunkPayload = test::kPayload}));
    return assembler;
}

void feedAll(Assembler& assembler, const std::vector<Bytes>& chunks) {
    for (const Bytes& chunk : chunks) assembler.feed(chunk);
}

/// Chunk `at` of `chunks` with its header changed and sealed again.
template <class Change>
Bytes altered(const std::vector<Bytes>& chunks, std::size_t at, Change change) {
    const auto chunk = decodeChunk(chunks[at]);
    EXPECT_TRUE(chunk);
    ChunkHeader header = chunk->header;
    change(header);
    return encodeChunk(header, chunk->payload);
}

Bytes resent(Bytes chunk, std::uint32_t sequence) {
    restamp(chunk, sequence, true);
    return chunk;
}

TEST(Assembler, MakesAFrameOfItsChunks) {
    Assembler assembler = expecting(1);
    for (const Bytes& chunk : frame(0, 1)) {
        EXPECT_FALSE(assembler.take());
        EXPECT_TRUE(assembler.feed(chunk));
    }
    const auto done = assembler.take();
    ASSERT_TRUE(done);
    EXPECT_EQ(done->captureId, kCapture);
    EXPECT_EQ(done->bytes, packPixels(test::picture(kSize, 0), PixelFormat::Mono12Packed));
    EXPECT_TRUE(assembler.finished(0));
    EXPECT_FALSE(assembler.missing(0));
    EXPECT_EQ(assembler.anomalies(), Anomalies{});
}

TEST(Assembler, MakesItInAnyOrder) {
    std::mt19937 random(3);
    for (int round = 0; round < 50; ++round) {
        Assembler assembler = expecting(3);
        std::vector<Bytes> chunks;
        for (int i = 0; i < 3; ++i) {
            for (Bytes& chunk : frame(i, 1)) chunks.push_back(std::move(chunk));
        }
        std::shuffle(chunks.begin(), chunks.end(), random);
        feedAll(assembler, chunks);
        int frames = 0;
        while (const auto done = assembler.take()) {
            const auto pixels = test::picture(kSize, done->index);
            EXPECT_EQ(done->bytes, packPixels(pixels, PixelFormat::Mono12Packed));
            ++frames;
        }
        EXPECT_EQ(frames, 3);
    }
}

TEST(Assembler, ExpectsNothingBeforeItIsTold) {
    Assembler assembler;
    feedAll(assembler, frame(0, 1));
    EXPECT_FALSE(assembler.take());
    EXPECT_EQ(assembler.anomalies().stale, 7U);
}

TEST(Assembler, SaysWhichChunksAreLostOnceTheFrameHasEnded) {
    Assembler assembler = expecting(1);
    const auto chunks = frame(0, 1);
    for (std::size_t i : {0U, 1U, 3U, 5U}) assembler.feed(chunks[i]);
    EXPECT_TRUE(assembler.lost().empty()) << "the rest may still come";
    assembler.feed(chunks[kTrailer]);
    EXPECT_EQ(assembler.lost(), (std::vector<MissingChunks>{{.frame = 0, .first = 2, .last = 4}}));
    EXPECT_EQ(assembler.anomalies().lostChunks, 2U);
}

TEST(Assembler, LaterFrameEndsOneWhoseTrailerIsLost) {
    Assembler assembler = expecting(2);
    auto chunks = frame(0, 1);
    chunks.pop_back();
    feedAll(assembler, chunks);
    EXPECT_TRUE(assembler.lost().empty());
    assembler.feed(frame(1, 8)[0]);
    EXPECT_EQ(assembler.lost(),
              (std::vector<MissingChunks>{{.frame = 0, .first = kTrailer, .last = kTrailer}}));
}

TEST(Assembler, ResentChunksCompleteAFrame) {
    Assembler assembler = expecting(1);
    auto chunks = frame(0, 1);
    chunks[2][70] ^= 1;  // in the payload
    feedAll(assembler, chunks);
    EXPECT_EQ(assembler.anomalies().badPayloads, 1U);
    ASSERT_EQ(assembler.lost().size(), 1U);
    assembler.askedFor(assembler.lost()[0]);
    EXPECT_TRUE(assembler.lost().empty()) << "asked for, not yet lost again";
    assembler.feed(resent(frame(0, 1)[2], 8));
    ASSERT_TRUE(assembler.take());
    EXPECT_EQ(assembler.anomalies().total(), 1U);
}

TEST(Assembler, ResendThatIsBadAgainIsLostAgain) {
    Assembler assembler = expecting(1);
    auto chunks = frame(0, 1);
    const Bytes good = chunks[2];
    chunks[2][70] ^= 1;
    feedAll(assembler, chunks);
    assembler.askedFor(assembler.lost()[0]);
    Bytes bad = resent(good, 8);
    bad[70] ^= 1;
    assembler.feed(bad);
    EXPECT_EQ(assembler.lost(), (std::vector<MissingChunks>{{.frame = 0, .first = 2, .last = 2}}));
}

TEST(Assembler, FrameOfWhichNothingCameLacksEverything) {
    const Assembler assembler = expecting(2);
    EXPECT_EQ(assembler.missing(1), (MissingChunks{.frame = 1, .first = 0, .last = kTrailer}));
    EXPECT_FALSE(assembler.missing(2));
    EXPECT_FALSE(assembler.missing(-1));
}

TEST(Assembler, CountsEachKindOfBadTransfer) {
    Assembler assembler = expecting(1);
    const auto chunks = frame(0, 1);
    assembler.feed({});
    assembler.feed(std::span(chunks[0]).first(63));
    Bytes longer = chunks[1];
    longer.push_back(0);
    assembler.feed(longer);
    assembler.feed(std::span(chunks[1]).first(chunks[1].size() - 1));
    Bytes header = chunks[2];
    header[20] ^= 4;
    assembler.feed(header);
    EXPECT_EQ(assembler.anomalies().emptyTransfers, 1U);
    EXPECT_EQ(assembler.anomalies().badLengths, 3U);
    EXPECT_EQ(assembler.anomalies().badHeaders, 1U);
    EXPECT_FALSE(assembler.finished(0));
}

TEST(Assembler, IgnoresOtherBootsAndCaptures) {
    Assembler assembler = expecting(1);
    const auto chunks = frame(0, 1);
    assembler.feed(altered(chunks, 0, [](ChunkHeader& h) { h.bootId = 1; }));
    feedAll(assembler, frame(0, 1, kCapture + 1));
    EXPECT_EQ(assembler.anomalies().stale, 8U);
    EXPECT_FALSE(assembler.take());
}

TEST(Assembler, IgnoresDuplicatesAndCountsThoseNotResent) {
    Assembler assembler = expecting(1);
    const auto chunks = frame(0, 1);
    assembler.feed(chunks[1]);
    EXPECT_FALSE(assembler.feed(altered(chunks, 1, [](ChunkHeader& h) { ++h.streamSequence; })));
    EXPECT_FALSE(assembler.feed(resent(chunks[1], 4)));
    EXPECT_EQ(assembler.anomalies().duplicates, 1U);
}

TEST(Assembler, SkipsUnknownTypes) {
    Assembler assembler = expecting(1);
    assembler.feed(
        altered(frame(0, 1), 1, [](ChunkHeader& h) { h.type = static_cast<ChunkType>(9); }));
    EXPECT_EQ(assembler.anomalies().unknownTypes, 1U);
    EXPECT_EQ(assembler.anomalies().total(), 1U);
}

TEST(Assembler, RefusesChunksThatContradictTheFrame) {
    const auto chunks = frame(0, 1);
    const auto refused = [&](std::size_t at, auto change) {
        Assembler assembler = expecting(1);
        EXPECT_FALSE(assembler.feed(altered(chunks, at, change)));
        return assembler.anomalies().contradictions;
    };
    EXPECT_EQ(refused(1, [](ChunkHeader& h) { h.frameIndex = 1; }), 1U);
    EXPECT_EQ(refused(1, [](ChunkHeader& h) { h.chunkCount = 65535; }), 1U);
    EXPECT_EQ(refused(1, [](ChunkHeader& h) { h.offset = 0xFFFFFFF0; }), 1U);
    EXPECT_EQ(refused(1, [](ChunkHeader& h) { h.chunkIndex = 2; }), 1U);
    EXPECT_EQ(refused(1, [](ChunkHeader& h) { h.chunkIndex = 0; }), 1U);
    EXPECT_EQ(refused(1, [](ChunkHeader& h) { h.chunkIndex = 7; }), 1U);
    EXPECT_EQ(refused(5, [](ChunkHeader& h) { h.type = ChunkType::Trailer; }), 1U);
    EXPECT_EQ(refused(0, [](ChunkHeader& h) { h.chunkIndex = 1; }), 1U);
}

TEST(Assembler, RefusesATrailerOfAnotherSize) {
    Assembler assembler = expecting(1);
    auto chunks = frame(0, 1);
    const auto header = decodeChunk(chunks[kTrailer])->header;
    chunks[kTrailer] = encodeChunk(header, encode(Trailer{.frameBytes = 71}));
    feedAll(assembler, chunks);
    EXPECT_EQ(assembler.anomalies().badFrames, 1U);
    EXPECT_EQ(assembler.lost().size(), 1U);
}

TEST(Assembler, AsksForTheWholeFrameWhenItsCrcDisagrees) {
    Assembler assembler = expecting(1);
    auto chunks = frame(0, 1);
    const auto header = decodeChunk(chunks[3])->header;
    chunks[3] = encodeChunk(header, Bytes(test::kPayload, 0xEE));  // sound, but not of this frame
    feedAll(assembler, chunks);
    EXPECT_FALSE(assembler.take());
    EXPECT_EQ(assembler.anomalies().badFrames, 1U);
    const std::vector<MissingChunks> all{{.frame = 0, .first = 0, .last = kTrailer}};
    ASSERT_EQ(assembler.lost(), all);
    assembler.askedFor(all[0]);
    std::uint32_t sequence = 8;
    for (const Bytes& chunk : frame(0, 1)) assembler.feed(resent(chunk, sequence++));
    EXPECT_TRUE(assembler.take());
}

TEST(Assembler, SequenceWrapsWithoutLoss) {
    Assembler assembler = expecting(1);
    feedAll(assembler, frame(0, 0xFFFFFFFD));
    EXPECT_TRUE(assembler.take());
    EXPECT_EQ(assembler.anomalies(), Anomalies{});
}

TEST(Assembler, FlushIsNoLossAndMakesOlderChunksStale) {
    Assembler assembler = expecting(2);
    const auto first = frame(0, 1);
    assembler.feed(first[0]);
    assembler.flushed(100);
    assembler.feed(first[1]);
    EXPECT_EQ(assembler.anomalies().stale, 1U);
    feedAll(assembler, frame(1, 100));
    EXPECT_TRUE(assembler.take());
    EXPECT_EQ(assembler.anomalies().lostChunks, 0U);
}

TEST(Assembler, TellsWhyAFrameWasAborted) {
    Assembler assembler = expecting(1);
    const auto header = decodeChunk(frame(0, 1)[0])->header;
    ChunkHeader abort = header;
    abort.type = ChunkType::Aborted;
    abort.chunkCount = 0;
    const Aborted reason{.reason = status::kInterlock, .frameNumber = 7};
    assembler.feed(encodeChunk(abort, encode(reason)));
    ASSERT_TRUE(assembler.aborted());
    EXPECT_EQ(*assembler.aborted(), reason);
    EXPECT_EQ(assembler.anomalies().aborted, 1U);
}

TEST(Assembler, RefusesSizesThatCannotBe) {
    const ExpectedCapture good{
        .bootId = 1, .captureId = 1, .frames = 1, .frameBytes = 100, .maxChunkPayload = 10};
    const auto refused = [&](auto change) {
        ExpectedCapture bad = good;
        change(bad);
        Assembler assembler;
        return !assembler.expect(bad).has_value();
    };
    EXPECT_FALSE(refused([](ExpectedCapture&) {}));
    EXPECT_TRUE(refused([](ExpectedCapture& c) { c.frames = 0; }));
    EXPECT_TRUE(refused([](ExpectedCapture& c) { c.frames = 65536; }));
    EXPECT_TRUE(refused([](ExpectedCapture& c) { c.frameBytes = 0; }));
    EXPECT_TRUE(refused([](ExpectedCapture& c) { c.frameBytes = 0xFFFFFFFF; }));
    EXPECT_TRUE(refused([](ExpectedCapture& c) { c.maxChunkPayload = 0; }));
    // 65533 chunks and the TRAILER's index 65534 is the last that RESEND can name.
    EXPECT_FALSE(refused([](ExpectedCapture& c) { c.frameBytes = 65533, c.maxChunkPayload = 1; }));
    EXPECT_TRUE(refused([](ExpectedCapture& c) { c.frameBytes = 65534, c.maxChunkPayload = 1; }));
}

TEST(Assembler, GivesUpTheOldestFrameRatherThanMemory) {
    Assembler assembler;
    const std::uint32_t bytes = 150U << 20;
    const std::uint32_t payload = 4096;
    ASSERT_TRUE(assembler.expect({.bootId = test::kBoot,
                                  .captureId = kCapture,
                                  .frames = 2,
                                  .frameBytes = bytes,
                                  .maxChunkPayload = payload}));
    for (std::uint16_t i = 0; i < 2; ++i) {
        const ChunkHeader header{.type = ChunkType::Data,
                                 .bootId = test::kBoot,
                                 .streamSequence = i,
                                 .captureId = kCapture,
                                 .frameIndex = i,
                                 .chunkIndex = 1,
                                 .chunkCount = static_cast<std::uint16_t>(bytes / payload)};
        EXPECT_TRUE(assembler.feed(encodeChunk(header, Bytes(payload))));
    }
    EXPECT_EQ(assembler.anomalies().givenUp, 1U);
}

constexpr std::uint64_t kNext = 0x60001;

/// Two frames of kCapture, and one of kNext after them.
Assembler expectingBoth() {
    Assembler assembler = expecting(2);
    EXPECT_TRUE(assembler.expectNext({.bootId = test::kBoot,
                                      .captureId = kNext,
                                      .frames = 1,
                                      .frameBytes = kFrameBytes,
                                      .maxChunkPayload = test::kPayload}));
    return assembler;
}

TEST(Assembler, FramesOfTheNextCaptureWaitForTheirTurn) {
    Assembler assembler = expectingBoth();
    const auto next = frame(0, 1, kNext);
    for (const Bytes& chunk : next) EXPECT_FALSE(assembler.feed(chunk)) << "not of the present one";
    EXPECT_FALSE(assembler.take());
    feedAll(assembler, frame(0, 8));
    EXPECT_EQ(assembler.take()->captureId, kCapture);
    EXPECT_FALSE(assembler.take());
    assembler.moveOn();
    EXPECT_EQ(assembler.take()->captureId, kNext);
    feedAll(assembler, frame(1, 15));
    EXPECT_FALSE(assembler.take()) << "its turn is over";
    EXPECT_EQ(assembler.anomalies(), (Anomalies{.stale = 7}));
}

TEST(Assembler, TheNextCaptureShowsWhatThePresentOneLacks) {
    Assembler assembler = expectingBoth();
    auto present = frame(0, 1);
    present.pop_back();
    feedAll(assembler, present);
    EXPECT_TRUE(assembler.lost().empty());
    assembler.feed(resent(frame(0, 1, kNext)[0], 15));
    EXPECT_TRUE(assembler.lost().empty()) << "sent again out of its turn";
    assembler.feed(frame(0, 16, kNext)[0]);
    const std::vector<MissingChunks> lost = assembler.lost();
    ASSERT_EQ(lost.size(), 2U);
    EXPECT_EQ(lost[0], (MissingChunks{.frame = 0, .first = kTrailer, .last = kTrailer}));
    EXPECT_EQ(lost[1], (MissingChunks{.frame = 1, .first = 0, .last = kTrailer}));
    for (const MissingChunks& chunks : lost) assembler.askedFor(chunks);
    EXPECT_TRUE(assembler.lost().empty());
    feedAll(assembler, {resent(frame(0, 1).back(), 17)});
    EXPECT_EQ(assembler.take()->index, 0);
}

TEST(Assembler, AFrameHasBegunWithAnyOfItsChunks) {
    Assembler assembler = expecting(2);
    EXPECT_FALSE(assembler.begun(0));
    assembler.feed(frame(0, 1)[3]);
    EXPECT_TRUE(assembler.begun(0));
    feedAll(assembler, frame(1, 8));
    EXPECT_TRUE(assembler.begun(1));
    EXPECT_FALSE(assembler.begun(2));
}

TEST(Assembler, AForgottenNextCaptureIsStale) {
    Assembler assembler = expectingBoth();
    feedAll(assembler, frame(0, 1, kNext));
    assembler.forgetNext();
    feedAll(assembler, frame(0, 8, kNext));
    assembler.moveOn();
    EXPECT_FALSE(assembler.take());
    EXPECT_EQ(assembler.anomalies(), (Anomalies{.stale = 7}));
}

TEST(Anomalies, ReadAsAList) {
    EXPECT_EQ(Anomalies{}.text(), "none");
    const Anomalies some{.badPayloads = 2, .lostChunks = 1};
    EXPECT_EQ(some.text(), "2 bad payloads, 1 lost chunk");
    EXPECT_EQ(some.total(), 3U);
    EXPECT_EQ(some.since(some), Anomalies{});
}

constexpr std::array kCounts{&Anomalies::emptyTransfers,
                             &Anomalies::badLengths,
                             &Anomalies::badHeaders,
                             &Anomalies::badPayloads,
                             &Anomalies::badFrames,
                             &Anomalies::lostChunks,
                             &Anomalies::disordered,
                             &Anomalies::duplicates,
                             &Anomalies::stale,
                             &Anomalies::unknownTypes,
                             &Anomalies::contradictions,
                             &Anomalies::aborted,
                             &Anomalies::givenUp};
static_assert(sizeof(Anomalies) == kCounts.size() * sizeof(std::uint32_t), "one of each");

TEST(Anomalies, EachKindIsCountedSaidAndTakenOff) {
    std::set<std::string> words;
    Anomalies all;
    for (std::size_t i = 0; i < kCounts.size(); ++i) {
        Anomalies one;
        one.*kCounts[i] = 1;
        EXPECT_EQ(one.total(), 1U);
        EXPECT_EQ(one.text().substr(0, 2), "1 ");
        EXPECT_EQ(one.since({}), one);
        EXPECT_NE(one, Anomalies{});
        words.insert(one.text());
        all.*kCounts[i] = static_cast<std::uint32_t>(i + 1);
    }
    EXPECT_EQ(words.size(), kCounts.size());
    EXPECT_EQ(all.total(), 13U * 14 / 2);
    Anomalies fewer = all;
    fewer.*kCounts[4] -= 2;
    EXPECT_EQ(all.since(fewer), (Anomalies{.badFrames = 2}));
}

}  // namespace
}  // namespace gonio::driver
