// A measured sample from a .gonio file through each format that lists directions, and back.

#include <gtest/gtest.h>

#include <cmath>

#include "proc/formats/alta.h"
#include "proc/formats/astm.h"
#include "proc/formats/bird.h"
#include "proc/formats/gonio_exr.h"
#include "proc/formats/scattered_csv.h"
#include "proc/table/rotations.h"
#include "proc/table/rows_of.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

/// Of two rotations, as a .gonio file holds it: numbers of 32 bits, and some cells blocked.
SampleSet measured() {
    SampleSet set;
    set.info.name = "tile";
    for (const double rotation : {0.0, 60.0}) {
        for (const Radians incidence : {20_deg, 45_deg}) {
            set.leds.push_back(test::ledTable(incidence, [&](Radians theta, const Direction& wo) {
                return 1 + theta.value() + 0.3 * wo.x() + 0.2 * wo.y() + 0.01 * rotation;
            }));
            set.leds.back().rotation = rotationOf(rotation);
        }
    }
    return *decodeGonio(*encodeGonio(set), "in");
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// Cells whose value, uncertainties or flags differ. Flags of missing cells: as `flags` says.
std::size_t differing(const SampleSet& a, const SampleSet& b, bool uncertainties, bool flags) {
    EXPECT_EQ(a.leds.size(), b.leds.size());
    std::size_t count = 0;
    for (std::size_t led = 0; led < std::min(a.leds.size(), b.leds.size()); ++led) {
        EXPECT_EQ(a.leds[led].incidence, b.leds[led].incidence);
        EXPECT_EQ(a.leds[led].rotation, b.leds[led].rotation);
        for (const Band band : kBands) {
            const CellSamples &x = a.leds[led].bands[index(band)],
                              &y = b.leds[led].bands[index(band)];
            EXPECT_EQ(x.size(), y.size());
            for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
                bool equal = same(x.f[i], y.f[i]);
                if (uncertainties) {
                    equal = equal && same(x.uRandom[i], y.uRandom[i]) &&
                            same(x.uSystematic[i], y.uSystematic[i]);
                }
                if (flags || !std::isnan(x.f[i])) equal = equal && x.flags[i] == y.flags[i];
                count += equal ? 0U : 1U;
            }
        }
    }
    return count;
}

template <class Parse>
SampleSet backThrough(const std::string& bytes, const Parse& parse) {
    const auto read = parse(bytes, "in");
    EXPECT_TRUE(read) << read.error().message;
    if (!read) return {};
    const auto set = sampleOf(read->content, read->about);
    EXPECT_TRUE(set);
    return set ? set->set : SampleSet{};
}

TEST(RowRoundTrip, GivesASampleBackToTheBit) {
    const SampleSet set = measured();
    const Metadata about = metadataOf(set.info);
    const BrdfRows rows = rowsOf(set);
    const auto direct = sampleOf(rows, about);
    ASSERT_TRUE(direct);
    EXPECT_EQ(differing(set, direct->set, true, true), 0U);
    EXPECT_EQ(direct->set.info, set.info);

    const SampleSet csv = backThrough(writeScatteredCsv(rows, about).bytes, parseScatteredCsv);
    EXPECT_EQ(differing(set, csv, true, true), 0U);
    EXPECT_EQ(csv.info, set.info);
    // BiRD has no missing values, and so no flags of them.
    const SampleSet bird = backThrough(writeBird(rows, about)->bytes, parseBird);
    EXPECT_EQ(differing(set, bird, true, false), 0U);
    EXPECT_EQ(bird.info, set.info);
    // These have neither uncertainties nor flags.
    const SampleSet astm = backThrough(writeAstm(rows, about)->bytes, parseAstm);
    EXPECT_EQ(differing(set, astm, false, false), 0U);
    EXPECT_EQ(astm.info, set.info);
    const SampleSet alta = backThrough(writeAlta(rows, about)->bytes, parseAlta);
    EXPECT_EQ(differing(set, alta, false, false), 0U);
    EXPECT_EQ(alta.info, set.info);
}

}  // namespace
}  // namespace gonio::proc
