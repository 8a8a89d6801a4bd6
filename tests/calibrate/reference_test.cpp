#include "proc/calibrate/reference.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include "proc/calibrate/reference_io.h"
#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

Direction at(double theta, double phi) {
    return Direction::fromSpherical(Radians::fromDegrees(theta), Radians::fromDegrees(phi));
}

/// f = 1 + incidence / 10 + theta / 100 + phi / 1000 (degrees), which bilinear look-up keeps.
double linear(double incidence, double theta, double phi) {
    return 1 + incidence / 10 + theta / 100 + phi / 1000;
}

ReferenceTable linearTable() {
    std::vector<ReferencePlane> planes;
    for (const double incidence : {20.0, 0.0}) {  // in any order
        ReferencePlane plane{
            Radians::fromDegrees(incidence), {0_deg, 30_deg, 80_deg}, {0_deg, 90_deg, 180_deg}, {}};
        for (const Radians theta : plane.theta) {
            for (const Radians phi : plane.phi) {
                plane.f.push_back(LedBands::all(linear(incidence, theta.degrees(), phi.degrees())));
            }
        }
        planes.push_back(plane);
    }
    auto table = ReferenceTable::make({.name = "linear", .uCommon = 0.005, .uPerDirection = 0.003},
                                      std::move(planes));
    EXPECT_TRUE(table) << table.error().message;
    return std::move(*table);
}

TEST(ReferenceTable, IsBilinearBetweenItsNodesAndMirrorsTheOtherHalf) {
    const ReferenceTable table = linearTable();
    for (const double theta : {0.0, 10.0, 30.0, 71.0}) {
        for (const double phi : {0.0, 33.0, 90.0, 179.0, 200.0, 359.0}) {
            const double folded = theta == 0 ? 0 : std::min(phi, 360 - phi);
            const Answer answer = table.answer({at(20, 0), at(theta, phi)});
            EXPECT_NEAR(answer.f[Band::G], linear(20, theta, folded), 1e-12) << theta << " " << phi;
            EXPECT_EQ(answer.source, Source::Measured);
        }
    }
    // Constant beyond the last theta; the light's azimuth turns the table.
    EXPECT_NEAR(table.answer({at(20, 0), at(88, 90)}).f[Band::R], linear(20, 80, 90), 1e-12);
    EXPECT_NEAR(table.answer({at(20, 70), at(30, 160)}).f[Band::R], linear(20, 30, 90), 1e-12);
}

TEST(ReferenceTable, IncidenceIsExactNearALedAndLinearBetween) {
    const ReferenceTable table = linearTable();
    EXPECT_NEAR(table.answer({at(20.5, 0), at(30, 90)}).f[Band::B], linear(20, 30, 90), 1e-12);
    const Answer between = table.answer({at(5, 0), at(30, 90)});
    EXPECT_NEAR(between.f[Band::B], linear(5, 30, 90), 1e-12);
    EXPECT_EQ(between.source, Source::Interpolated);
    EXPECT_FALSE(table.answer({at(21, 0), at(30, 90)}).present());
    EXPECT_FALSE(table.answer({at(95, 0), at(30, 90)}).present());
    EXPECT_TRUE(table.answer({at(20, 0), at(91, 0)}).flags.has(Flag::BelowHorizon));
}

TEST(ReferenceTable, KnowsItsUncertainty) {
    const Answer answer = linearTable().answer({at(20, 0), at(30, 90)});
    EXPECT_NEAR((*answer.uRandom)[Band::G], 0.003 * answer.f[Band::G], 1e-15);
    EXPECT_NEAR((*answer.uSystematic)[Band::G], 0.005 * answer.f[Band::G], 1e-15);
}

TEST(ReferenceTable, LambertianIsTheStatedFallback) {
    const ReferenceTable black = ReferenceTable::lambertian("black", 0.001, 0.1);
    for (const double incidence : {0.0, 37.0, 60.0}) {
        EXPECT_DOUBLE_EQ(black.answer({at(incidence, 0), at(55, 123)}).f[Band::G], 0.001 / kPi);
    }
    EXPECT_NE(black.certificate().citation.find("0.001 / pi"), std::string::npos);
    EXPECT_EQ(black.certificate().uCommon, 0.1);
}

TEST(ReferenceTable, ALightTrapIsZeroToItsUncertainty) {
    const ReferenceTable zero = ReferenceTable::lightTrap("zero", 1e-5);
    for (const double incidence : {0.0, 37.0, 60.0}) {
        const Answer answer = zero.answer({at(incidence, 0), at(55, 123)});
        ASSERT_TRUE(answer.present());
        for (const Band b : kBands) {
            EXPECT_EQ(answer.f[b], 0);
            EXPECT_EQ((*answer.uSystematic)[b], 1e-5);
        }
    }
}

TEST(ReferenceTable, RefusesWhatIsNoTable) {
    EXPECT_FALSE(ReferenceTable::make({.name = "x"}, {}));
    const auto one = [](std::vector<Radians> theta, std::vector<LedBands> f) {
        return ReferenceTable::make({.name = "x"},
                                    {{0_deg, std::move(theta), {0_deg}, std::move(f)}});
    };
    EXPECT_TRUE(one({0_deg}, {LedBands::all(1)}));
    EXPECT_FALSE(one({0_deg, 10_deg}, {LedBands::all(1)}));
    EXPECT_FALSE(one({10_deg, 0_deg}, {LedBands::all(1), LedBands::all(1)}));
    EXPECT_FALSE(one({0_deg}, {LedBands::all(0)}));
    EXPECT_FALSE(one({0_deg}, {LedBands::all(std::nan(""))}));
}

constexpr const char* kHeader = "theta_i,theta_o,phi_o,f_r,f_g,f_b\n";

std::string parseError(const std::string& text) {
    const auto table = parseReference(text);
    if (table) return "read";
    EXPECT_EQ(table.error().kind, ErrorKind::File);
    return table.error().message;
}

TEST(ReferenceFile, ReadsRowsInAnyOrder) {
    const auto table = parseReference(std::string("# name: tile\r\n# u_common: 0.01\r\n") +
                                      kHeader + "0,30,0,3,3,3\r\n0,0,0,1,2,4\r\n\r\n");
    ASSERT_TRUE(table) << table.error().message;
    EXPECT_EQ(table->certificate().name, "tile");
    EXPECT_EQ(table->certificate().uCommon, 0.01);
    EXPECT_EQ(table->answer({at(0, 0), at(0, 0)}).f[Band::B], 4);
    EXPECT_NEAR(table->answer({at(0, 0), at(15, 77)}).f[Band::R], 2, 1e-12);
}

TEST(ReferenceFile, NamesTheLineOfEachFault) {
    EXPECT_NE(parseError("").find("no values"), std::string::npos);
    EXPECT_NE(parseError("a,b\n").find("line 1: wanted theta_i"), std::string::npos);
    EXPECT_NE(parseError(kHeader + std::string("0,0,0,banana,1,1\n")).find("line 2: 'banana'"),
              std::string::npos);
    EXPECT_NE(parseError(kHeader + std::string("0,0,0,1,1\n")).find("line 2: 5 columns"),
              std::string::npos);
    EXPECT_NE(parseError(kHeader + std::string("0,0,0,1,1,1,1\n")).find("more than 6"),
              std::string::npos);
    EXPECT_NE(parseError(std::string("# u_common: 7\n") + kHeader).find("line 1: u_common"),
              std::string::npos);
    EXPECT_NE(
        parseError(kHeader + std::string("0,0,0,1,1,1\n0,10,5,1,1,1\n")).find("phi_o differs"),
        std::string::npos);
    const auto missing = readReference("/nowhere/white.csv");
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().message.find("/nowhere/white.csv"), std::string::npos);
}

ReferenceTable whitePtfe() {
    auto table = readReference(std::string(GONIO_SOURCE_DIR) + "/config/references/white-ptfe.csv");
    EXPECT_TRUE(table) << table.error().message;
    return std::move(*table);
}

TEST(WhitePtfe, IsARealWhiteTile) {
    const ReferenceTable white = whitePtfe();
    EXPECT_EQ(white.certificate().uCommon, 0.005);
    EXPECT_EQ(white.certificate().uPerDirection, 0.003);
    EXPECT_NE(white.certificate().citation.find("Germer"), std::string::npos);
    ASSERT_EQ(white.planes().size(), 4U);
    for (const double incidence : {0.0, 20.0, 40.0, 60.0}) {
        for (double theta = 0; theta <= 75; theta += 5) {
            for (double phi = 0; phi < 360; phi += 30) {
                const Answer answer = white.answer({at(incidence, 0), at(theta, phi)});
                ASSERT_TRUE(answer.present());
                for (const Band band : kBands) {
                    EXPECT_GT(kPi * answer.f[band], 0.84)
                        << incidence << " " << theta << " " << phi;
                    EXPECT_LT(kPi * answer.f[band], 1.35)
                        << incidence << " " << theta << " " << phi;
                }
            }
        }
    }
    // Forward scattering is stronger: the mirror side lies at phi = 180.
    EXPECT_GT(white.answer({at(60, 0), at(70, 180)}).f[Band::G],
              1.1 * white.answer({at(60, 0), at(70, 90)}).f[Band::G]);
}

/// f of the tile at 525 nm, 60 degrees incidence, by outgoing direction, straight from NIST's rows.
std::map<std::pair<double, double>, double> nistGreenAt60() {
    std::ifstream in(std::string(GONIO_DATA_DIR) + "/white_reference/PTFE.data.csv");
    std::map<std::pair<double, double>, std::array<double, 2>> byDirection;  // 351 and 532 nm
    std::string line;
    while (std::getline(in, line)) {
        std::istringstream cells(line);
        std::vector<double> v;
        for (std::string cell; v.size() < 6 && std::getline(cells, cell, ',');) {
            v.push_back(parseDouble(cell).value_or(-1));
        }
        if (v.size() < 6 || std::abs(v[1] + 60) > 0.01 || v[2] != 0) continue;
        if (v[0] == 0.351) byDirection[{v[3], v[4]}][0] = v[5];
        if (v[0] == 0.532) byDirection[{v[3], v[4]}][1] = v[5];
    }
    std::map<std::pair<double, double>, double> green;
    for (const auto& [direction, f] : byDirection) {
        if (f[0] <= 0 || f[1] <= 0) continue;
        green[direction] = f[0] + (f[1] - f[0]) * (525 - 351) / (532 - 351);
    }
    return green;
}

TEST(WhitePtfe, IsWhatNistMeasured) {
    const auto green = nistGreenAt60();
    if (green.empty()) {
        std::cout << "skipped: no white_reference/PTFE.data.csv in GONIO_DATA_DIR\n";
        GTEST_SKIP();
    }
    const ReferenceTable white = whitePtfe();
    double sum = 0;
    int count = 0;
    for (const auto& [direction, f] : green) {
        if (direction.first > 75) continue;
        // NIST's negative theta_i has the light at phi = 180; ours is at 0.
        const Answer answer =
            white.answer({at(60, 0), at(direction.first, direction.second + 180)});
        sum += std::pow(answer.f[Band::G] / f - 1, 2);
        ++count;
    }
    ASSERT_GT(count, 100);
    EXPECT_LT(std::sqrt(sum / count), 0.03);
}

}  // namespace
}  // namespace gonio::proc
