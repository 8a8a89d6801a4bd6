// The real campaign from its raw readings to the Zemax files that the laboratory published.

#include "proc/formats/rt300s_brdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "proc/core/median.h"
#include "proc/formats/brdf_file.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/zemax.h"
#include "proc/table/specular_fill.h"
#include "proc/table/specular_lookup.h"
#include "proc/table/spherical_lookup.h"
#include "tests/support/data_file.h"

namespace gonio::proc {
namespace {

constexpr const char* kBlank = "blank_v2o0_20250911.RT.csv";
constexpr const char* kEc1 = "ANOPLATE_AnoBlack_EC1_Alum6061_v1o0_20251115.RT.csv";
constexpr const char* kMagicBlack = "MagicBlack_v2o0_20250902.RT.csv";
const std::vector<std::string> kSteel{"NiTE_on_steel_v1o0A_20250915.RT.csv",
                                      "NiTE_on_steel_v1o0B_20250916.RT.csv",
                                      "NiTE_on_steel_v1o0C_20250916.RT.csv"};

std::optional<Rt300sScan> scanOf(const std::string& name) {
    const auto path = test::dataFile("gonio_rt300s/" + name);
    if (!path) return std::nullopt;
    auto read = parseRt300sCsv(*readFile(*path), name);
    EXPECT_TRUE(read) << read.error().message;
    return read->content;
}

std::optional<Rt300sBrdf> made(const std::vector<std::string>& names,
                               const Rt300sOptions& options = {}) {
    std::vector<Rt300sScan> scans;
    for (const std::string& name : names) {
        auto scan = scanOf(name);
        if (!scan) return std::nullopt;
        scans.push_back(std::move(*scan));
    }
    const auto blank = scanOf(kBlank);
    if (!blank) return std::nullopt;
    auto brdf = rt300sBrdf(scans, *blank, options);
    EXPECT_TRUE(brdf);
    return brdf ? std::optional(std::move(*brdf)) : std::nullopt;
}

std::optional<double> nodeAt(const SphericalBlock& block, double azimuth, double theta) {
    const auto a = std::find(block.azimuthDeg.begin(), block.azimuthDeg.end(), azimuth);
    const auto t = std::find(block.thetaDeg.begin(), block.thetaDeg.end(), theta);
    if (a == block.azimuthDeg.end() || t == block.thetaDeg.end()) return std::nullopt;
    const double f = block.f[block.index(static_cast<std::size_t>(a - block.azimuthDeg.begin()),
                                         static_cast<std::size_t>(t - block.thetaDeg.begin()))];
    return std::isnan(f) ? std::nullopt : std::optional(f);
}

/// At the laboratory's axes.
SpecularTable zemaxOf(const SphericalTable& table) {
    SpecularGrid grid{.symmetry = TableSymmetry::PlaneSymmetrical};
    grid.incidenceDeg = {10, 30, 50, 70};
    for (int azimuth = 0; azimuth <= 180; azimuth += 10) grid.azimuthDeg.push_back(azimuth);
    grid.radialDeg = {0, 5, 10, 15, 20, 30, 40, 50, 60, 70, 80, 90};
    const auto channels = bandChannels(table.channels);
    const auto lookup = SphericalLookup::over(table, *channels);
    EXPECT_TRUE(lookup);
    return fillTable(*lookup, grid, Band::R).table;
}

/// |ours / published - 1| at nodes of both, in the plane of incidence or out of it, of the
/// incidences up to the one given.
std::vector<double> differences(const SpecularTable& ours,
                                const SpecularTable& published,
                                bool inPlane,
                                double upTo = 90) {
    EXPECT_EQ(ours.azimuthDeg, published.azimuthDeg);
    EXPECT_EQ(ours.radialDeg, published.radialDeg);
    EXPECT_EQ(ours.incidenceDeg, published.incidenceDeg);
    std::vector<double> all;
    for (TableNode n; n.incidence < ours.incidenceDeg.size(); ++n.incidence) {
        if (ours.incidenceDeg[n.incidence] > upTo) continue;
        for (n.azimuth = 0; n.azimuth < ours.azimuthDeg.size(); ++n.azimuth) {
            const double azimuth = ours.azimuthDeg[n.azimuth];
            if ((azimuth == 0 || azimuth == 180) != inPlane) continue;
            for (n.radial = 0; n.radial < ours.radialDeg.size(); ++n.radial) {
                if (!ours.hasData(0, n) || !published.hasData(0, n)) continue;
                const std::size_t at = ours.index(n);
                all.push_back(std::abs(ours.planes[0].f[at] / published.planes[0].f[at] - 1));
            }
        }
    }
    return all;
}

std::optional<SpecularTable> published(const std::string& name) {
    const auto path = test::dataFile("gonio_rt300s/" + name);
    if (!path) return std::nullopt;
    auto table = readZemax(*path);
    EXPECT_TRUE(table);
    return *table;
}

TEST(Rt300sBrdf, SubtractsBlackAndDividesByTheCosine) {
    const Rt300sScan black{{{-90, 10, 30, 0.25}, {-90, 10, 0, 0.5}, {0, 10, 0, 0.5}}};
    const Rt300sScan sample{{{0, 10, 0, 1.5}, {-90, 10, 0, 2.5}, {-90, 10, 30, 1.25}}};
    const auto brdf = rt300sBrdf(std::span(&sample, 1), black);
    ASSERT_TRUE(brdf);
    ASSERT_EQ(brdf->table.blocks.size(), 1U);
    const SphericalBlock& block = brdf->table.blocks[0];
    EXPECT_EQ(block.incidenceDeg, 10);
    EXPECT_EQ(block.azimuthDeg, std::vector<double>{180});
    EXPECT_EQ(block.thetaDeg, (std::vector<double>{0, 30}));
    EXPECT_NEAR(block.f[0], 1.5 / kPi, 1e-15);  // the mean of both azimuths: both are the normal
    EXPECT_NEAR(block.f[1], 1 / (kPi * std::cos(kPi / 6)), 1e-15);
    const LightView pair = brdf->table.pairAt(block, 0, 1);
    EXPECT_NEAR(
        (pair.out.vector() - mirrorOf(Direction::fromSpherical(30_deg, 0_deg)).vector()).norm(),
        0,
        1e-15);
}

TEST(Rt300sBrdf, TakesJdvForATableAndReadingsForNone) {
    const auto path = test::dataFile("vendor_exports/test_jdv.jdv");
    if (!path) return;
    const auto table = parseRt300sTable(*readFile(*path), "test.jdv");
    ASSERT_TRUE(table);
    EXPECT_EQ(table->about.at(key::kSample), "Sample 0");
    EXPECT_EQ(table->content.channels, (std::vector<Channel>{{"run 1", {}}, {"run 2", {}}}));
    ASSERT_EQ(table->content.blocks.size(), 4U);
    // Second run at the normal: azimuth -90, polar 30 lies at phi 180.
    EXPECT_EQ(nodeAt(table->content.blocks[2], 180, 30), -48523.83);
    EXPECT_EQ(nodeAt(table->content.blocks[2], 0, 30), -26875.9);
    const auto raw =
        parseRt300sTable("azimuth_deg,incidence_deg,receive_deg,RT\n0,10,20,1\n", "in");
    ASSERT_FALSE(raw);
    EXPECT_EQ(raw.error().kind, ErrorKind::Usage);
    EXPECT_NE(raw.error().message.find("--black"), std::string::npos);
}

TEST(Rt300sBrdf, MatchesBlackByAngleNeverByRow) {
    const auto ec1 = made({kEc1});
    if (!ec1) return;
    auto scan = *scanOf(kEc1);
    auto blank = *scanOf(kBlank);
    std::reverse(blank.readings.begin(), blank.readings.end());
    blank.readings.erase(blank.readings.begin(), blank.readings.begin() + 100);
    const auto other = rt300sBrdf(std::span(&scan, 1), blank);
    ASSERT_TRUE(other);
    EXPECT_EQ(other->unmatched, 100U);
    std::size_t same = 0, differing = 0;
    for (std::size_t b = 0; b < other->table.blocks.size(); ++b) {
        const SphericalBlock& block = other->table.blocks[b];
        for (std::size_t a = 0; a < block.azimuthDeg.size(); ++a) {
            for (std::size_t t = 1; t < block.thetaDeg.size(); ++t) {
                const double f = block.f[block.index(a, t)];
                if (std::isnan(f)) continue;
                const auto whole =
                    nodeAt(ec1->table.blocks[b], block.azimuthDeg[a], block.thetaDeg[t]);
                ASSERT_TRUE(whole);
                (f == *whole ? same : differing) += 1;
            }
        }
    }
    EXPECT_GT(same, 2000U);
    // In the plane two readings are of one direction: without one of them the mean is another.
    EXPECT_LT(differing, 100U);
}

TEST(Rt300sBrdf, FindsWhatIsKnownOfEc1) {
    const auto ec1 = made({kEc1});
    if (!ec1) return;
    EXPECT_EQ(ec1->negative, 0U);
    EXPECT_EQ(ec1->unmatched, 0U);
    EXPECT_EQ(ec1->shadowed, 8U);  // of two azimuths at four incidences
    // The shadow is dark: less than half a standard deviation of the blank is left there.
    EXPECT_LT(std::abs(ec1->shadowNet), 0.5 * ec1->blackDeviation);
    const SphericalBlock& ten = ec1->table.blocks[0];
    EXPECT_EQ(ten.incidenceDeg, 10);
    EXPECT_EQ(ten.azimuthDeg.size(), 36U);
    EXPECT_EQ(ten.thetaDeg.size(), 17U);
    EXPECT_FALSE(nodeAt(ten, 0, 10));  // the arm
    EXPECT_TRUE(nodeAt(ten, 0, 5));
    // Each half by itself: 0.0359 at A = +90, 0.0337 at A = -90; the published file has 0.0348.
    EXPECT_NEAR(*nodeAt(ten, 180, 10), (0.0359 + 0.0337) / 2, 0.00005);
    Rt300sScan half = *scanOf(kEc1);
    std::erase_if(half.readings, [](const Rt300sReading& r) { return r.azimuthDeg < 0; });
    const auto positive = rt300sBrdf(std::span(&half, 1), *scanOf(kBlank));
    double peak = 0;
    for (const double f : positive->table.blocks[0].f)
        peak = std::isnan(f) ? peak : std::max(peak, f);
    EXPECT_NEAR(peak, 0.0359, 0.00005);
}

/// Rotations 0, 45 and 90 degrees of one sample: how well a measurement repeats.
TEST(Rt300sBrdf, FindsHowSteelRepeats) {
    std::vector<std::map<std::array<double, 3>, double>> net;
    const auto blank = scanOf(kBlank);
    if (!blank) return;
    std::map<std::array<double, 3>, double> dark;
    for (const Rt300sReading& r : blank->readings) {
        dark[{r.azimuthDeg, r.incidenceDeg, r.receiveDeg}] = r.value;
    }
    for (const std::string& name : kSteel) {
        net.emplace_back();
        const auto scan = scanOf(name);
        if (!scan) return;
        for (const Rt300sReading& r : scan->readings) {
            const std::array<double, 3> at{r.azimuthDeg, r.incidenceDeg, r.receiveDeg};
            net.back()[at] = (r.value - dark[at]) / std::cos(r.receiveDeg * kPi / 180);
        }
    }
    std::vector<std::pair<double, double>> byMean;  // mean, relative deviation
    for (const auto& [at, first] : net[0]) {
        const double second = net[1][at], third = net[2][at];
        const double mean = (first + second + third) / 3;
        const double variance =
            ((first - mean) * (first - mean) + (second - mean) * (second - mean) +
             (third - mean) * (third - mean)) /
            2;
        byMean.emplace_back(mean, std::sqrt(variance) / mean);
    }
    std::sort(byMean.rbegin(), byMean.rend());
    std::vector<double> relative;
    for (std::size_t i = 0; i < byMean.size() / 2; ++i) relative.push_back(byMean[i].second);
    std::sort(relative.begin(), relative.end());
    EXPECT_NEAR(relative[relative.size() / 2], 0.033, 0.0005);
    EXPECT_NEAR(relative[relative.size() * 9 / 10], 0.057, 0.001);
    // Averaged node by node they are one table.
    const auto steel = made(kSteel);
    EXPECT_EQ(steel->table.blocks.size(), 4U);
    EXPECT_EQ(steel->shadowed, 3U * 8U);
}

/// The published files within 5 % (median) in the plane of incidence. Measured: EC1 1.6 %, steel
/// 3.2 % of 73 nodes each; out of the plane, of 644 nodes and folded, 7.1 % and 11.5 %, where the
/// laboratory's script uses plane geometry.
TEST(Rt300sBrdf, ReproducesThePublishedFilesInThePlaneOfIncidence) {
    for (const bool folded : {false, true}) {
        const Rt300sOptions options{.planeSymmetrical = folded};
        const auto ec1 = made({kEc1}, options);
        const auto ec1Published = published("AnoBlackEC1onAlum.bsdf");
        const auto steel = made(kSteel, options);
        const auto steelPublished = published("AnoBlackNiTEonSteel.bsdf");
        if (!ec1 || !ec1Published || !steel || !steelPublished) return;
        const SpecularTable a = zemaxOf(ec1->table), b = zemaxOf(steel->table);
        const auto ec1In = differences(a, *ec1Published, true);
        EXPECT_EQ(ec1In.size(), 73U);
        EXPECT_LT(median(ec1In), 0.02);
        EXPECT_LT(median(differences(b, *steelPublished, true)), 0.035);
        // Folded as the laboratory folds: not so much closer that it would explain the rest.
        EXPECT_LT(median(differences(a, *ec1Published, false)), folded ? 0.08 : 0.13);
        EXPECT_LT(median(differences(b, *steelPublished, false)), 0.13);
    }
}

/// Its raw readings lie 0.0115 below the blank that its file names, in the arm's shadow as
/// elsewhere, and lack the azimuth of +90 that the published file averages. With what is left in
/// the shadow taken off the medians are 7 % at 10 degrees, where the readings are still as far
/// above the blank's own noise as anywhere, and 10 % over all.
TEST(Rt300sBrdf, SaysThatMagicBlackHasABlackOfAnotherState) {
    const auto raw = made({kMagicBlack});
    const auto table = published("ValidationTest_of_BRDF_via_MagicBlack.bsdf");
    if (!raw || !table) return;
    EXPECT_GT(raw->negative, 1000U);
    std::string said;
    for (const std::string& warning : warningsOf(*raw)) said += warning + "\n";
    EXPECT_NE(said.find("black is of another state"), std::string::npos) << said;
    EXPECT_NEAR(raw->shadowNet, -0.0115, 0.0001);
    const auto ec1 = made({kEc1});
    for (const std::string& warning : warningsOf(*ec1)) {
        EXPECT_EQ(warning.find("another state"), std::string::npos);
    }
    const auto zeroed = made({kMagicBlack}, {.zeroAtShadow = true});
    EXPECT_LT(zeroed->negative, 20U);
    const SpecularTable ours = zemaxOf(zeroed->table);
    EXPECT_LT(median(differences(ours, *table, true, 10)), 0.08);
    EXPECT_LT(median(differences(ours, *table, true)), 0.12);
}

/// The headers' TIS is not the physical one: EC1's is half the integral without the cosine, Magic
/// Black's all of it.
TEST(Rt300sBrdf, FindsThatThePublishedTisIsNotThePhysicalOne) {
    struct Case {
        const char* file;
        std::array<double, 4> header, physical;
    };
    for (const Case& one : {Case{"AnoBlackEC1onAlum.bsdf",
                                 {0.038655, 0.039136, 0.047596, 0.106539},
                                 {0.0507, 0.0494, 0.0499, 0.0818}},
                            Case{"ValidationTest_of_BRDF_via_MagicBlack.bsdf",
                                 {0.015959, 0.016583, 0.024839, 0.093223},
                                 {0.0092, 0.0094, 0.0119, 0.0338}}}) {
        const auto table = published(one.file);
        if (!table) return;
        const auto lookup = SpecularLookup::over(*table);
        ASSERT_TRUE(lookup);
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_EQ(table->planes[0].tis[i], one.header[i]);
            const Direction wi =
                Direction::fromSpherical(Radians::fromDegrees(table->incidenceDeg[i]), 0_deg);
            const double tis = totalScatter(*lookup, wi, Band::R);
            // The look-up answers nothing beyond the last nodes with data: up to a tenth less.
            EXPECT_LT(tis, one.physical[i]);
            EXPECT_GT(tis, 0.9 * one.physical[i]);
        }
    }
}

TEST(Rt300sBrdf, KeepsTheSampleAndTheDateOfAnExport) {
    const std::string jdv =
        "DataType:\tBRDF(RT-300S)\t\rSampleID:\tplate\t\rDate:\t7/12/2011\t\r"
        "Incidence:\t0\t\rPolar:\t0,30,30\t\rAzimuth:\t-90,-80,10\t\rRaw data\t\r"
        "\t0\t30\r-90\t1\t2\r-80\t1\t3\r";
    const auto file = decodeBrdf(Format::Rt300s, jdv, "in");
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->about.at(key::kSample), "plate");
    EXPECT_EQ(file->about.at(key::kDate), "7/12/2011");
    const auto readings =
        decodeBrdf(Format::Rt300s, "azimuth_deg,incidence_deg,receive_deg,RT\n0,10,20,1\n", "in");
    ASSERT_FALSE(readings);
    EXPECT_EQ(readings.error().kind, ErrorKind::Usage);
}

}  // namespace
}  // namespace gonio::proc
