// The small words of proc/core: units, bands, quantities, flags, measured values, efforts, results,
// images, answers, stopwatches, parallel loops.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include "proc/core/bands.h"
#include "proc/core/effort.h"
#include "proc/core/flags.h"
#include "proc/core/frame.h"
#include "proc/core/image.h"
#include "proc/core/log.h"
#include "proc/core/measured.h"
#include "proc/core/parallel.h"
#include "proc/core/quantities.h"
#include "proc/core/result.h"
#include "proc/core/scatterer.h"
#include "proc/core/stopwatch.h"
#include "proc/core/units.h"

namespace gonio {
namespace {

TEST(Radians, ConvertsDegreesAtTheEdges) {
    EXPECT_DOUBLE_EQ((180_deg).value(), kPi);
    EXPECT_DOUBLE_EQ(Radians(kPi / 6).degrees(), 30);
    EXPECT_LT(20_deg, 20.5_deg);
    EXPECT_DOUBLE_EQ((-(20_deg + 10_deg - 5_deg) * 2 / 5).degrees(), -10);
}

TEST(Exposure, CountsTheGrantedTime) {
    const Exposure exposure{.requested = Microseconds(1000), .granted = Nanoseconds(1004260)};
    EXPECT_DOUBLE_EQ(exposure.seconds(), 1.00426e-3);
}

TEST(LedBands, AreRedGreenBlueInThisOrder) {
    EXPECT_EQ(nanometres(Band::R), 630);
    EXPECT_EQ(nanometres(Band::G), 525);
    EXPECT_EQ(nanometres(Band::B), 465);
    EXPECT_EQ(letter(Band::G), "g");
    LedBands bands{{1, 2, 3}};
    EXPECT_EQ(bands[Band::B], 3);
    EXPECT_EQ((bands + LedBands::all(1)) * 2, (LedBands{{4, 6, 8}}));
    EXPECT_EQ(bands * bands, (LedBands{{1, 4, 9}}));
}

TEST(LedLevels, DarkMeansAllZero) {
    EXPECT_TRUE(LedLevels{}.dark());
    const LedLevels green = LedLevels::only(Band::G, 9);
    EXPECT_FALSE(green.dark());
    EXPECT_EQ(green[Band::G], 9);
    EXPECT_EQ(green[Band::R], 0);
}

TEST(Window, BinningDividesWhatIsSent) {
    EXPECT_EQ((Window{.x = 0, .y = 0, .size = {1024, 512}, .binning = 2}.sent()), (Size{512, 256}));
}

TEST(Ars, IsBrdfTimesCosine) {
    EXPECT_DOUBLE_EQ(toArs(Brdf(0.3), 0.5).value(), 0.15);
    EXPECT_DOUBLE_EQ(toBrdf(toArs(Brdf(0.3), 0.5), 0.5).value(), 0.3);
}

TEST(Ars, HoldsNoBrdfAtTheHorizon) {
    EXPECT_FALSE(std::isnan(toBrdf(Ars(1e-5), kMinCosForBrdf).value()));
    EXPECT_TRUE(std::isnan(toBrdf(Ars(1e-5), kMinCosForBrdf / 2).value()));
    EXPECT_TRUE(std::isnan(toBrdf(Ars(0), 0).value()));
    EXPECT_TRUE(std::isnan(toBrdf(Ars(0), -1).value()));
}

TEST(Flags, BitNumbersAreTheContract) {
    EXPECT_EQ(Flags{Flag::Measured}.mask(), 1U);
    EXPECT_EQ(Flags{Flag::BelowHorizon}.mask(), 16U);
    EXPECT_EQ(Flags{Flag::NotPlanned}.mask(), 8192U);
    EXPECT_EQ(describe(Flags::fromMask(0b110001)), "measured,below_horizon,reciprocity");
    EXPECT_EQ(describe({}), "");
}

TEST(Flags, SetAndClearOneBitEach) {
    Flags flags;
    EXPECT_TRUE(flags.set(Flag::Saturated).has(Flag::Saturated));
    EXPECT_FALSE(flags.has(Flag::Measured));
    EXPECT_EQ(flags.clear(Flag::Saturated), Flags{});
    EXPECT_TRUE((Flags{Flag::Model} | Flags{Flag::Prior}).has(Flag::Prior));
}

TEST(Source, HasTheNamesOfTheContract) {
    EXPECT_EQ(name(Source::Reciprocity), "reciprocity");
    EXPECT_EQ(name(Source::Analytic), "analytic");
}

TEST(Measured, CombinesBothParts) {
    const Measured<double> m{.value = 1, .uRandom = 3, .uSystematic = 4, .flags = {Flag::Measured}};
    EXPECT_DOUBLE_EQ(m.u(), 5);
}

TEST(Measured, MissingIsNeverZero) {
    const auto gone = Measured<double>::missing({Flag::Blocked, Flag::Measured});
    EXPECT_TRUE(std::isnan(gone.value));
    EXPECT_TRUE(std::isnan(gone.u()));
    EXPECT_FALSE(gone.present());
    EXPECT_TRUE(gone.flags.has(Flag::Blocked));
}

TEST(Effort, ReadsItsOwnNames) {
    for (Effort effort : {Effort::Draft, Effort::Standard, Effort::Reference}) {
        const auto back = parseEffort(name(effort));
        ASSERT_TRUE(back);
        EXPECT_EQ(*back, effort);
    }
    const auto bad = parseEffort("fast");
    ASSERT_FALSE(bad);
    EXPECT_EQ(bad.error().kind, ErrorKind::Usage);
}

TEST(Result, HoldsAValueOrAnError) {
    const Result<int> good = 7;
    const Result<int> bad = Error{ErrorKind::File, "x: missing"};
    EXPECT_TRUE(good);
    EXPECT_EQ(*good, 7);
    EXPECT_FALSE(bad);
    EXPECT_EQ(bad.error().in("open").message, "open: x: missing");
    EXPECT_TRUE(Result<void>{});
    EXPECT_FALSE(Result<void>(Error{}));
}

TEST(Error, KindsAreTheExitCodes) {
    EXPECT_EQ(exitCode(ErrorKind::Internal), 1);
    EXPECT_EQ(exitCode(ErrorKind::Usage), 2);
    EXPECT_EQ(exitCode(ErrorKind::NoRig), 3);
    EXPECT_EQ(exitCode(ErrorKind::Busy), 4);
    EXPECT_EQ(exitCode(ErrorKind::Device), 5);
    EXPECT_EQ(exitCode(ErrorKind::File), 6);
    EXPECT_EQ(exitCode(ErrorKind::Quality), 7);
    EXPECT_EQ(exitCode(ErrorKind::Interrupted), 8);
}

TEST(Image, IsRowMajorFromTheTop) {
    Image<int> image({3, 2});
    image.at(2, 1) = 5;
    EXPECT_EQ(image.pixels()[5], 5);
    EXPECT_EQ(image.row(1)[2], 5);
    EXPECT_TRUE(Image<int>().empty());
}

TEST(Answer, NoneIsNotANumberInAnyBand) {
    const Answer none = Answer::none({Flag::BelowHorizon}, Source::Analytic);
    EXPECT_FALSE(none.present());
    EXPECT_TRUE(none.flags.has(Flag::BelowHorizon));
    EXPECT_TRUE(Answer{}.present());
}

class FakeClock : public Clock {
public:
    [[nodiscard]] Nanoseconds now() const override { return now_; }
    Nanoseconds now_{1000};
};

TEST(Stopwatch, CountsFromWhenItWasMade) {
    FakeClock clock;
    const Stopwatch watch(clock);
    clock.now_ += Nanoseconds(2'500'000'000);
    EXPECT_DOUBLE_EQ(watch.elapsed().count(), 2.5);
}

TEST(ParallelFor, CoversEachIndexOnce) {
    for (std::size_t count : {0UL, 1UL, 2UL, 3UL, 1000UL}) {
        std::vector<std::atomic<int>> seen(count);
        parallelFor(count, [&](IndexRange range) {
            for (std::size_t i = range.begin; i < range.end; ++i) ++seen[i];
        });
        for (const auto& n : seen) EXPECT_EQ(n, 1);
    }
}

TEST(Log, DropsWhatIsBelowItsLevel) {
    testing::internal::CaptureStderr();
    log::setLevel(log::Level::Warning);
    log::info("not this");
    log::warning("but this");
    const std::string text = testing::internal::GetCapturedStderr();
    EXPECT_EQ(text.find("not this"), std::string::npos);
    EXPECT_NE(text.find("but this"), std::string::npos);
}

}  // namespace
}  // namespace gonio
