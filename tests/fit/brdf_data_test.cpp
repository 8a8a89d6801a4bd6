#include "proc/fit/brdf_data.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "proc/fit/family.h"
#include "proc/fit/model_fit.h"
#include "proc/fit/thinned_rows.h"
#include "proc/formats/scattered_csv.h"
#include "proc/models/spec.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

Result<BrdfData> fromCsv(const std::string& text, const DataOptions& options = {}) {
    const auto points = parseScatteredCsv(text, "test");
    if (!points) return points.error();
    return fitDataOf(points->content, options);
}

TEST(BrdfData, ASampleGivesItsPresentCells) {
    SampleSet set = test::sampleSet([](Radians, const Direction&) { return 0.2; });
    set.leds[1].bands[0].flags[10] = Flags{Flag::Measured, Flag::Saturated};
    set.leds[1].bands[1].flags[11] = Flags{};
    const BrdfData data = fitDataOf(set);
    EXPECT_EQ(data.incidences.size(), 4U);
    EXPECT_TRUE(data.uKnown);
    std::size_t below75 = 0;
    for (std::size_t i = 0; i < CellGrid::count(); ++i) below75 += CellGrid::place(i).row < 75;
    EXPECT_EQ(data.rows.size(), 4 * below75);
    EXPECT_EQ(data.valueCount(), 4 * 3 * below75 - 2);
    for (const FitRow& row : data.rows) {
        double weight = 0;
        for (std::size_t n = 0; n < row.nodeCount; ++n)
            weight += data.nodes[row.firstNode + n].weight;
        EXPECT_NEAR(weight, 1, 1e-12);
    }
}

/// f as the mean of 12 x 12 places in each cell, by which a lobe of alpha 0.02 is known to 1e-5.
TEST(BrdfData, CellMeansOfANarrowLobeGiveItsWidthBack) {
    const auto surface = makeModel("lambert,albedo=0.2+ggx,alpha=0.02,f0=0.04");
    ASSERT_TRUE(surface);
    SampleSet set;
    for (const Radians incidence : {0_deg, 20_deg, 40_deg, 60_deg}) {
        const Direction wi = Direction::fromSpherical(incidence, Radians(0));
        LedTable led;
        led.incidence = incidence;
        CellSamples cells = CellSamples::missing(CellGrid::count());
        for (std::size_t cell = 0; cell < cells.size(); ++cell) {
            if (CellGrid::place(cell).row >= 75) continue;
            const CellBounds bounds = CellGrid::bounds(cell);
            double sum = 0;
            double weights = 0;
            const bool near =
                angleBetween({.in = mirrorOf(wi), .out = CellGrid::centre(cell)}) < 20_deg;
            const int side = near ? 12 : 1;
            for (int i = 0; i < side * side; ++i) {
                const double x = (i % side + 0.5) / side;
                const double y = (i / side + 0.5) / side;
                const double theta =
                    bounds.thetaLow.value() + x * (bounds.thetaHigh - bounds.thetaLow).value();
                const double phi =
                    bounds.phiLow.value() + y * (bounds.phiHigh - bounds.phiLow).value();
                const Direction wo = Direction::fromSpherical(Radians(theta), Radians(phi));
                sum += std::sin(theta) * (*surface)->answer({wi, wo}).f[Band::G];
                weights += std::sin(theta);
            }
            cells.f[cell] = sum / weights;
            cells.uRandom[cell] = 0.01 * cells.f[cell];
            cells.uSystematic[cell] = 0.01 * cells.f[cell];
            cells.flags[cell] = Flags{Flag::Measured};
        }
        led.bands = {cells, cells, cells};
        set.leds.push_back(std::move(led));
    }
    const ModelFit fit = fitModel(**familyNamed("lambert+ggx"), fitDataOf(set));
    ASSERT_TRUE(fit.usable()) << fit.message;
    EXPECT_NEAR(fit.parameters[0].value, 0.02, 1e-3 * 0.02);
    EXPECT_LT(fit.chiSquarePerDof(), 1e-3);
    // All values of a band 1 % higher: so are its albedo and f0, and alpha stays, but for the part
    // of Schlick's term that f0 does not scale.
    EXPECT_NEAR(fit.parameters[1].uSystematic, 0.01 * fit.parameters[1].value, 1e-4 * 0.2);
    EXPECT_LT(fit.parameters[0].uSystematic, 2e-3 * 0.02);
}

TEST(BrdfData, ScatteredValuesComeWithTheirUncertaintiesOrAnAssumedOne) {
    const auto known = fromCsv(
        "theta_i,phi_i,theta_o,phi_o,f,u,flags\n"
        "10,0,20,0,0.5,0.01,1\n"
        "10.2,0,30,0,0.4,0.02,1\n"
        "40,0,20,0,0.3,0.01,3\n"  // saturated
        "40,0,95,0,0.3,0.01,1\n"  // below the horizon
        "40,0,25,0,,0.01,1\n"     // missing
        "40,0,26,0,0.2,0,1\n"     // no uncertainty
        "40,0,27,0,0.2,0.01,1\n");
    ASSERT_TRUE(known) << known.error().message;
    EXPECT_TRUE(known->uKnown);
    EXPECT_EQ(known->bands, BandCount::One);
    EXPECT_EQ(known->valueCount(), 3U);
    EXPECT_EQ(known->leftOut, 4U);
    EXPECT_EQ(known->incidences.size(), 2U);
    EXPECT_DOUBLE_EQ(known->rows[1].uRandom[0], 0.02);

    const auto assumed = fromCsv("theta_i,phi_i,theta_o,phi_o,f_r,f_g,f_b\n10,0,20,0,0.5,0.4,0.3\n",
                                 {.assumedRelative = 0.1});
    ASSERT_TRUE(assumed) << assumed.error().message;
    EXPECT_FALSE(assumed->uKnown);
    EXPECT_EQ(assumed->valueCount(), 3U);
    EXPECT_NEAR(assumed->rows[0].uRandom[0], 0.05, 0.001);
}

TEST(BrdfData, BadFilesAreRefused) {
    const std::string head = "theta_i,phi_i,theta_o,phi_o";
    for (const std::string& text : {head + "\n1,2,3,4\n",
                                    head + ",f\n1,2,3,4,banana\n",
                                    head + ",f,u\n1,2,3,4,0.5,x\n",
                                    head + ",f,flags\n1,2,3,4,0.5,?\n"}) {
        const auto data = fromCsv(text);
        ASSERT_FALSE(data) << text;
        EXPECT_EQ(data.error().kind, ErrorKind::File);
    }
    // A file that is sound, of which no band's values are known.
    const auto two = fromCsv(head + ",f_r,f_g\n1,2,3,4,0.5,0.5\n");
    ASSERT_FALSE(two);
    EXPECT_EQ(two.error().kind, ErrorKind::Usage);
}

TEST(BrdfData, AZemaxTableGivesEachDirectionOnce) {
    SpecularTable table;
    table.incidenceDeg = {0, 30};
    table.azimuthDeg = {0, 90, 180};
    table.radialDeg = {0, 10, 20};
    table.planes.resize(1);
    table.planes[0].f.assign(table.nodeCount(), 0.3);
    const auto data = fitDataOf(table);
    ASSERT_TRUE(data) << data.error().message;
    EXPECT_EQ(data->rows.size(), 2U * (1 + 3 * 2));
    EXPECT_EQ(data->bands, BandCount::One);
    EXPECT_FALSE(data->uKnown);
    // Square degrees about the mirror direction: a cap to 5 degrees, a ring to 15, one to 20 of
    // which the last node has the inner half; the plane of symmetry cuts the outer azimuths' cells.
    const double cap = (1 - std::cos(Radians(5_deg).value())) * 180 / kPi * 180;
    const double ring = std::sin(Radians(10_deg).value()) * 10;
    EXPECT_NEAR(data->rows[0].solidAngle, cap, 1e-12 * cap);
    EXPECT_NEAR(data->rows[1].solidAngle, ring * 45, 1e-12 * ring * 45);
    double sum = 0;
    for (const FitRow& row : data->rows) sum += row.group == 0 ? row.solidAngle : 0;
    const double whole = (1 - std::cos(Radians(20_deg).value())) * 180 / kPi * 180;
    EXPECT_NEAR(sum, whole, 0.08 * whole);  // of steps as coarse as these
    table.colour = TableColour::Xyz;
    EXPECT_FALSE(fitDataOf(table));
}

TEST(BrdfData, ABudgetSplitsTheSystematicUncertainty) {
    SampleSet set = test::sampleSet([](Radians, const Direction&) { return 0.2; });
    set.info.budgetJson =
        R"([{"led":1,"band":"r","components":[)"
        R"({"name":"a","type":"A","correlation":"per cell","median_relative":0.5},)"
        R"({"name":"b","type":"B","correlation":"per cell","median_relative":0.003},)"
        R"({"name":"c","type":"B","correlation":"per state","median_relative":0.004},)"
        R"({"name":"d","type":"B","correlation":"common","median_relative":0.019}]}])";
    const BrdfData data = fitDataOf(set);
    for (const FitRow& row : data.rows) {
        const bool listed = row.group == 1;
        const BudgetShare share = data.shareOf(row, 0);
        const double half = std::sqrt(0.5) * 0.003;
        EXPECT_NEAR(row.uRandom[0], 0.2 * (listed ? std::hypot(0.01, half) : 0.01), 1e-12);
        EXPECT_NEAR(share.state, listed ? 0.004 : 0, 1e-12);
        EXPECT_NEAR(share.patch, listed ? half : 0, 1e-12);
        const double u = data.uOf(row, 0);
        EXPECT_NEAR(std::hypot(row.uSystematic[0], u), 0.2 * std::hypot(0.01, 0.02), 1e-12);
        EXPECT_EQ(data.shareOf(row, 1).state, 0);
    }
    for (const char* bad : {"banana", "{}", "[1,2]", R"([{"led":99,"band":"r"}])"}) {
        set.info.budgetJson = bad;
        EXPECT_FALSE(fitDataOf(set).sharesErrors());
    }
}

TEST(BrdfData, FlagsOfABandLeaveThatBandOut) {
    const std::string head =
        "theta_i,phi_i,theta_o,phi_o,f_r,f_g,f_b,u_r,u_g,u_b,flags_r,flags_g,flags_b\n";
    const auto saturated = std::to_string(Flags{Flag::Measured, Flag::Saturated}.mask());
    const auto data = fromCsv(head + "0,0,10,0,1,2,3,1,1,1,1," + saturated + ",1\n");
    ASSERT_TRUE(data) << data.error().message;
    EXPECT_EQ(data->valueCount(), 2U);
    EXPECT_TRUE(std::isnan(data->rows[0].f[1]));
    // A band without flags of its own has the common ones, or was measured where it has a value.
    const std::string columns = "theta_i,phi_i,theta_o,phi_o,f_r,f_g,f_b,";
    const auto red = fromCsv(columns + "flags_r\n0,0,10,0,1,2,3," + saturated + "\n");
    ASSERT_TRUE(red) << red.error().message;
    EXPECT_TRUE(std::isnan(red->rows[0].f[0]));
    EXPECT_EQ(red->valueCount(), 2U);
    const auto common = fromCsv(columns + "flags,flags_r\n0,0,10,0,1,2,3," + saturated + ",1\n");
    ASSERT_TRUE(common) << common.error().message;
    EXPECT_EQ(common->rows[0].f[0], 1);
    EXPECT_EQ(common->valueCount(), 1U);
    for (const char* mask : {"-1", "2.5", "1e9", "nan"}) {
        const auto bad = fromCsv(head + "0,0,10,0,1,2,3,1,1,1,1," + mask + ",1\n");
        ASSERT_FALSE(bad) << mask;
        EXPECT_NE(bad.error().message.find("flags_g"), std::string::npos) << bad.error().message;
    }
}

TEST(BrdfData, ManyIncidencesAreJoinedAndNeverCut) {
    std::string csv = "theta_i,phi_i,theta_o,phi_o,f,u\n";
    for (int i = 0; i < 18; ++i) {
        for (int o = 0; o < 7; ++o) {
            csv += std::to_string(5 * i) + ",0," + std::to_string(10 * o) + ",0,0.1,0.01\n";
        }
    }
    const auto data = fromCsv(csv);
    ASSERT_TRUE(data) << data.error().message;
    EXPECT_GE(data->incidences.size(), 9U);
    EXPECT_LE(data->incidences.size(), 12U);
    std::map<int, std::set<std::uint16_t>> groups;
    for (const FitRow& row : data->rows) {
        const Vec<double>& in = data->nodesOf(row).front().pair.in;
        const double degrees = Radians(std::atan2(std::hypot(in.x, in.y), in.z)).degrees();
        groups[static_cast<int>(std::lround(degrees))].insert(row.group);
    }
    EXPECT_EQ(groups.size(), 18U);
    for (const auto& [degrees, all] : groups) EXPECT_EQ(all.size(), 1U) << degrees;
}

TEST(BrdfData, AnIncidenceWithoutValuesIsNoGroup) {
    const auto data = fromCsv(
        "theta_i,phi_i,theta_o,phi_o,f,u\n0,0,10,0,0.1,0\n20,0,10,0,0.1,0.01\n"
        "40,0,10,0,0.1,0.01\n");
    ASSERT_TRUE(data) << data.error().message;
    ASSERT_EQ(data->incidences.size(), 2U);
    EXPECT_NEAR(data->incidences[0].degrees(), 20, 1e-9);
    EXPECT_EQ(data->leftOut, 1U);
}

TEST(BrdfData, ThinningKeepsTheNearestToTheMirrorDirectionAndIsEvenElsewhere) {
    BrdfData data = fitDataOf(test::sampleSet([](Radians, const Direction&) { return 0.2; }));
    const auto rows = thinnedRows(data, {true, true, false, true}, 600);
    EXPECT_LE(rows.size(), 606U);
    EXPECT_GE(rows.size(), 590U);
    std::size_t near = 0;
    for (const std::uint32_t i : rows) {
        const Pair<double>& pair = data.nodesOf(data.rows[i]).front().pair;
        near += pair.out.z * pair.in.z - pair.out.x * pair.in.x > std::cos(0.1) ? 1 : 0;
    }
    EXPECT_GE(near, 150U);
    // Whatever the values are.
    data.rows[1234].f[1] = 50;
    EXPECT_EQ(std::find(rows.begin(), rows.end(), 1234U), rows.end());
    EXPECT_EQ(thinnedRows(data, {true, true, false, true}, 600), rows);
    for (const std::uint32_t i : rows) EXPECT_NE(data.rows[i].group, 2);
    EXPECT_EQ(thinnedRows(data, {true, true, true, true}, 1'000'000).size(), data.rows.size());
}

}  // namespace
}  // namespace gonio::proc
