#pragma once
// Captures in a chain, each armed while the one before it is sent, and what they cost meanwhile.

#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "driver/rig.h"
#include "tests/driver/allocation_watch.h"

namespace gonio::driver::test {

struct ChainTaken {
    Spent spent;
    int frames = 0;
    std::vector<bool> ahead;  ///< of each capture: it was armed before its turn
};

/// The frames are looked at and left. Nothing here allocates amid the chain.
inline ChainTaken takeChain(Rig& rig,
                            const ArmWatch& watch,
                            std::span<const CaptureRequest> chain) {
    struct Place {
        ChainTaken all;
        int left = 0;
        bool sound = true;
    } now;
    now.all.ahead.assign(chain.size(), false);
    const FrameSink look = [&now](const Frame&) -> Result<void> {
        ++now.all.frames;
        if (--now.left == 0) captureTaken();
        return {};
    };
    const int before = watch.arms();
    (void)takeSpent();
    for (std::size_t i = 0; i < chain.size(); ++i) {
        ArmAhead ahead;
        if (i + 1 < chain.size()) ahead.next = chain[i + 1];
        now.left = chain[i].frames;
        now.all.ahead[i] = watch.arms() - before > static_cast<int>(i);
        const auto capture = rig.capture(chain[i], ahead, look);
        now.sound = now.sound && capture && capture->recaptures == 0;
    }
    now.all.spent = takeSpent();
    EXPECT_TRUE(now.sound);
    EXPECT_EQ(watch.arms() - before, static_cast<int>(chain.size())) << "nothing was armed twice";
    return std::move(now.all);
}

/// `first` again and again, with so many frames each and plan steps that go on.
inline std::vector<CaptureRequest> chainOf(CaptureRequest first,
                                           std::initializer_list<int> frames) {
    std::vector<CaptureRequest> chain;
    for (const int count : frames) {
        first.frames = count;
        chain.push_back(first);
        ++first.planStep;
    }
    return chain;
}

}  // namespace gonio::driver::test
