// What our writers write, read by plain slow scripts in Python (tests/formats/independent), which
// know the formats' descriptions alone and share no code with us: f at random directions against
// what was asked to fill the file, and on which side of the plane of incidence a lobe lies.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>

#include "proc/core/number_text.h"
#include "proc/export/half_difference_fill.h"
#include "proc/export/tensor_fit.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/merl.h"
#include "proc/formats/rgl.h"
#include "proc/formats/zemax.h"
#include "proc/models/spec.h"
#include "proc/table/specular_fill.h"
#include "proc/table/tensor_bsdf.h"
#include "tests/support/temp_folder.h"

namespace gonio::proc {
namespace {

/// Directions as a file of pairs gives them.
struct PairDeg {
    double thetaI = 0, phiI = 0, thetaO = 0, phiO = 0;

    [[nodiscard]] LightView pair() const {
        const auto direction = [](double theta, double phi) {
            return Direction::fromSpherical(Radians::fromDegrees(theta), Radians::fromDegrees(phi));
        };
        return {.in = direction(thetaI, phiI), .out = direction(thetaO, phiO)};
    }
    /// The view on the other side of the plane of incidence.
    [[nodiscard]] PairDeg mirrored() const { return {thetaI, phiI, thetaO, 2 * phiI - phiO}; }
};

/// Isotropic, reciprocal and never below 0, but another on either side of the plane of incidence:
/// n . (wi x wo) changes its sign with the side and with the exchange of wi and wo, as wi.z - wo.z
/// does with the latter.
class OneSided : public Scatterer {
public:
    [[nodiscard]] Answer answer(const LightView& pair) const override {
        if (pair.in.z() <= 0 || pair.out.z() <= 0) {
            return Answer::none({Flag::BelowHorizon}, Source::Analytic);
        }
        const double side = pair.in.x() * pair.out.y() - pair.in.y() * pair.out.x();
        const double f = 0.3 + 0.5 * side * (pair.in.z() - pair.out.z());
        Answer answer;
        answer.f = LedBands{{f, 2 * f, 3 * f}};
        return answer;
    }
};

const OneSided kOneSided;

/// Another for each azimuth of the light in the sample's frame, and for each sense of its turn.
class Turned : public Scatterer {
public:
    [[nodiscard]] Answer answer(const LightView& pair) const override {
        if (pair.in.z() <= 0 || pair.out.z() <= 0) {
            return Answer::none({Flag::BelowHorizon}, Source::Analytic);
        }
        const double f = 1 + 0.4 * pair.in.y() + 0.2 * pair.out.x() + 0.1 * pair.out.y();
        Answer answer;
        answer.f = LedBands::all(f);
        return answer;
    }
};

std::unique_ptr<const AnalyticModel> model(std::string_view spec) {
    auto made = makeModel(spec);
    EXPECT_TRUE(made) << spec;
    return std::move(*made);
}

bool hasPython() {
    static const bool has = std::system("python3 -c '' >/dev/null 2>&1") == 0;
    return has;
}

/// One line of numbers for each pair; empty, with a failure, where the script fails.
std::vector<std::vector<double>> read(const std::string& script,
                                      const std::string& bytes,
                                      const std::vector<PairDeg>& pairs) {
    const test::TempFolder folder;
    EXPECT_TRUE(writeFile(folder / "file", bytes));
    std::string text;
    for (const PairDeg& p : pairs) {
        text += shortest(p.thetaI) + "," + shortest(p.phiI) + "," + shortest(p.thetaO) + "," +
                shortest(p.phiO) + "\n";
    }
    EXPECT_TRUE(writeFile(folder / "pairs", text));
    const std::string command = "cd '" + folder.path().string() + "' && python3 '" +
                                GONIO_SOURCE_DIR + "/tests/formats/independent/" + script +
                                "' file <pairs >out 2>error";
    EXPECT_EQ(std::system(command.c_str()), 0) << *readFile(folder / "error");
    std::vector<std::vector<double>> answers;
    std::istringstream lines(*readFile(folder / "out"));
    for (std::string line; std::getline(lines, line);) {
        std::vector<double>& numbers = answers.emplace_back();
        std::istringstream fields(line);
        for (std::string field; std::getline(fields, field, ',');) {
            numbers.push_back(parseDouble(field).value_or(std::nan("")));
        }
    }
    EXPECT_EQ(answers.size(), pairs.size());
    return answers;
}

/// Lights at the incidences of a table, views up to 80 degrees.
std::vector<PairDeg> pairsAt(const std::vector<double>& incidences) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> degrees(0, 1);
    std::vector<PairDeg> pairs;
    for (int i = 0; i < 300; ++i) {
        pairs.push_back({incidences[static_cast<std::size_t>(i) % incidences.size()],
                         360 * degrees(random),
                         80 * degrees(random),
                         360 * degrees(random)});
    }
    return pairs;
}

/// What the script says of each pair against `truth` in its bands, relative.
void expectTruth(const std::string& script,
                 const std::string& bytes,
                 const Scatterer& truth,
                 const std::vector<PairDeg>& pairs,
                 double relative,
                 std::vector<Band> bands) {
    const auto answers = read(script, bytes, pairs);
    ASSERT_EQ(answers.size(), pairs.size());
    double otherSide = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const PairDeg& p = pairs[i];
        ASSERT_EQ(answers[i].size(), bands.size());
        for (std::size_t k = 0; k < bands.size(); ++k) {
            const double f = truth.answer(p.pair()).f[bands[k]];
            EXPECT_NEAR(answers[i][k], f, relative * f)
                << p.thetaI << ' ' << p.phiI << ' ' << p.thetaO << ' ' << p.phiO;
            const double mirrored = truth.answer(p.mirrored().pair()).f[bands[k]];
            otherSide = std::max(otherSide, std::abs(mirrored / f - 1));
        }
        if (testing::Test::HasFailure()) return;
    }
    // The lobe of one side, looked for on the other, is far off: or this would prove nothing of it.
    if (&truth == &kOneSided) {
        EXPECT_GT(otherSide, 5 * relative);
    }
}

constexpr const char* kSmooth = "lambert,albedo=0.3/0.2/0.1+ggx,f0=0.2,alpha=0.3";

TEST(IndependentReaders, ReadTheZemaxFilesThatWeWrite) {
    if (!hasPython()) GTEST_SKIP() << "no python3 here";
    const std::vector<double> incidences{0, 20, 40, 60};
    // Linear in cells of h = 1 degree: h^2 / 8 of the second derivatives, which for this lobe are
    // at most 40 f / rad^2 along each axis: 3e-3. Of the one-sided one they are below 10 f.
    for (const auto symmetry : {TableSymmetry::Asymmetrical, TableSymmetry::PlaneSymmetrical}) {
        const auto truth = model(kSmooth);
        const auto grid = SpecularGrid::oneDegree(incidences, symmetry);
        const std::string bytes = writeZemax(fillTable(*truth, grid, Band::G).table).bytes;
        expectTruth("zemax.py", bytes, *truth, pairsAt(incidences), 3e-3, {Band::G});
    }
    const auto grid = SpecularGrid::oneDegree(incidences, TableSymmetry::Asymmetrical);
    const std::string bytes = writeZemax(fillTable(kOneSided, grid, Band::G).table).bytes;
    expectTruth("zemax.py", bytes, kOneSided, pairsAt(incidences), 1e-3, {Band::G});
}

TEST(IndependentReaders, ReadTheRotationsOfAZemaxFile) {
    if (!hasPython()) GTEST_SKIP() << "no python3 here";
    const std::vector<double> incidences{0, 20, 40, 60};
    auto grid = SpecularGrid::oneDegree(incidences, TableSymmetry::Asymmetrical4D);
    grid.rotationDeg = {0, 30, 100};
    const Turned truth;
    const std::string bytes = writeZemax(fillTable(truth, grid, Band::G).table).bytes;
    std::vector<PairDeg> pairs = pairsAt(incidences);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        // A sample that is turned by r sees a fixed light at -r.
        pairs[i].phiI = -grid.rotationDeg[i / incidences.size() % 3];
    }
    expectTruth("zemax.py", bytes, truth, pairs, 1e-4, {Band::G});
    const PairDeg turned{40, -30, 10, 0};
    const PairDeg otherWay{40, 30, 10, 0};
    EXPECT_GT(
        std::abs(truth.answer(turned.pair()).f[Band::G] - truth.answer(otherWay.pair()).f[Band::G]),
        0.1);
}

TEST(IndependentReaders, ReadTheMerlFilesThatWeWrite) {
    if (!hasPython()) GTEST_SKIP() << "no python3 here";
    // Linear between nodes at most 2 degrees of theta_half, 1 of theta_diff and phi_diff apart.
    const auto truth = model(kSmooth);
    const std::vector<double> incidences{5, 20, 40, 60, 75};
    expectTruth("merl.py",
                writeMerl(fillHalfDifference(*truth).table).bytes,
                *truth,
                pairsAt(incidences),
                6e-3,
                {Band::R, Band::G, Band::B});
    expectTruth("merl.py",
                writeMerl(fillHalfDifference(kOneSided).table).bytes,
                kOneSided,
                pairsAt(incidences),
                3e-3,
                {Band::R, Band::G, Band::B});
}

TEST(IndependentReaders, ReadTheRglFilesThatWeWrite) {
    if (!hasPython()) GTEST_SKIP() << "no python3 here";
    // Lights at the table's own. The square has 64 nodes a side, linear between them: with half
    // vectors near the normal, where all its azimuths meet, that is up to 4 % of a lobe that
    // differs between them, else 1.1 %. What our own look-up answers, from the table in memory, is
    // the same to what single precision leaves.
    const std::vector<double> incidences{0, 20, 40, 60};
    const std::vector<Band> bands{Band::R, Band::G, Band::B};
    const auto truth = model(kSmooth);
    for (const Scatterer* each :
         {static_cast<const Scatterer*>(truth.get()), static_cast<const Scatterer*>(&kOneSided)}) {
        const TensorTable table = fitTensor(*each).table;
        const auto written = writeRgl(table);
        ASSERT_TRUE(written) << written.error().message;
        const auto own = TensorBsdf::over(table);
        ASSERT_TRUE(own) << own.error().message;
        const auto pairs = pairsAt(incidences);
        expectTruth("rgl.py", written->bytes, *each, pairs, 5e-2, bands);
        expectTruth("rgl.py", written->bytes, *own, pairs, 1e-5, bands);
    }
}

}  // namespace
}  // namespace gonio::proc
