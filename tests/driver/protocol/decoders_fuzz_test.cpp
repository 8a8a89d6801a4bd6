// Random and mutated bytes through every decoder: no crash, no read past the end (sanitizers
// watch).

#include <gtest/gtest.h>

#include <random>

#include "driver/protocol/chunk.h"
#include "driver/protocol/reports.h"

namespace gonio::driver {
namespace {

int cases() { return std::getenv("GONIO_NIGHTLY") != nullptr ? 5'000'000 : 200'000; }

TEST(DecodersFuzz, SurviveRandomReports) {
    std::mt19937_64 random(11);
    int accepted = 0;
    for (int i = 0; i < cases(); ++i) {
        Report report;
        for (auto& byte : report) byte = static_cast<std::uint8_t>(random());
        accepted += decodeIdent(report) ? 1 : 0;
        accepted += decodeSessionSet(report) ? 1 : 0;
        accepted += decodeEventsPage(report) ? 1 : 0;
        accepted += decodeStatus(report) ? 1 : 0;
        accepted += decodeAck(report) ? 1 : 0;
        accepted += decodeCommand(report) ? 1 : 0;
    }
    EXPECT_LE(accepted, 10 + cases() / 1000000);  // a 16-bit CRC and an id let through 6 in 2^24
}

TEST(DecodersFuzz, SurviveMutatedChunks) {
    std::mt19937_64 random(12);
    const std::vector<std::uint8_t> payload(300, 7);
    for (int i = 0; i < cases(); ++i) {
        auto bytes = encodeChunk({.type = static_cast<ChunkType>(random() % 6)}, payload);
        bytes.resize(random() % (bytes.size() + 1));
        for (int k = 0; k < 3 && !bytes.empty(); ++k) {
            bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
        }
        const auto chunk = decodeChunk(bytes);
        if (chunk) {
            EXPECT_EQ(chunk->payload.size(), chunk->header.length);
        }
        (void)decodeLeader(bytes);
        (void)decodeTrailer(bytes);
        (void)decodeAborted(bytes);
    }
}

}  // namespace
}  // namespace gonio::driver
