#include "proc/formats/entry_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace gonio::proc {
namespace {

struct Entries {
    std::vector<double> thetaIn, phiIn, thetaOut, phiOut;
    std::vector<std::uint32_t> channel;

    void add(double theta, std::uint32_t ofChannel) {
        thetaIn.push_back(30);
        phiIn.push_back(0);
        thetaOut.push_back(theta);
        phiOut.push_back(2 * theta);
        channel.push_back(ofChannel);
    }
    [[nodiscard]] EntryPairs pairs(std::size_t channels) const {
        return pairEntries({thetaIn, phiIn, thetaOut, phiOut, channel, channels});
    }
};

TEST(EntryPairs, KnowTheOrdersThatNeedNoSearch) {
    Entries fastest, slowest;
    for (std::uint32_t pair = 0; pair < 4; ++pair) {
        for (std::uint32_t c = 0; c < 3; ++c) fastest.add(pair, c);
    }
    for (std::uint32_t c = 0; c < 3; ++c) {
        for (std::uint32_t pair = 0; pair < 4; ++pair) slowest.add(pair, c);
    }
    EXPECT_EQ(fastest.pairs(3).pairOf,
              (std::vector<std::uint32_t>{0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3}));
    EXPECT_EQ(slowest.pairs(3).pairOf,
              (std::vector<std::uint32_t>{0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3}));
}

TEST(EntryPairs, BeginANewPairWhereAChannelComesAgain) {
    Entries entries;
    for (const double theta : {1.0, 2.0, 1.0}) entries.add(theta, 0);
    EXPECT_EQ(entries.pairs(1).pairOf, (std::vector<std::uint32_t>{0, 1, 2}));
    Entries two;
    two.add(1, 0);
    two.add(2, 1);
    two.add(1, 0);
    two.add(1, 1);
    two.add(-0.0, 0);
    two.add(0.0, 1);
    // The second of theta 1 is a repeat; channel 1 belongs to the latest. -0 and 0 are equal.
    EXPECT_EQ(two.pairs(2).pairOf, (std::vector<std::uint32_t>{0, 1, 2, 2, 3, 3}));
}

TEST(EntryPairs, MatchASlowSearchInAnyOrder) {
    std::mt19937_64 random(7);
    for (int round = 0; round < 50; ++round) {
        std::vector<std::pair<double, std::uint32_t>> all;
        for (int pair = 0; pair < 20; ++pair) {
            for (std::uint32_t c = 0; c < 3; ++c) {
                if (random() % 4 != 0) all.emplace_back(pair, c);
            }
        }
        std::shuffle(all.begin(), all.end(), random);
        Entries entries;
        for (const auto& [theta, channel] : all) entries.add(theta, channel);
        const EntryPairs pairs = entries.pairs(3);
        std::map<double, std::uint32_t> slow;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const auto [place, fresh] =
                slow.emplace(all[i].first, static_cast<std::uint32_t>(slow.size()));
            EXPECT_EQ(pairs.pairOf[i], place->second);
            if (fresh) {
                EXPECT_EQ(pairs.firstOf[place->second], i);
            }
        }
        EXPECT_EQ(pairs.firstOf.size(), slow.size());
    }
}

}  // namespace
}  // namespace gonio::proc
