#include "proc/fit/prior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "proc/models/spec.h"
#include "tests/fit/simulated.h"
#include "tests/support/temp_folder.h"

namespace gonio::proc {
namespace {

/// Of the standard kind, smaller: made once.
const PriorBasis& basis() {
    static const PriorBasis made = *PriorBasis::over(PriorLibrary::standard(700), 120);
    return made;
}

std::unique_ptr<const AnalyticModel> model(const std::string& spec) {
    return std::move(*makeModel(spec));
}

struct Judged {
    PriorGate gate;
    PriorPosterior posterior;
};

Judged judge(const Scatterer& surface) {
    const BrdfData data = test::noisy(test::simulated(surface, 900, {0.01, 1e-5}), 5);
    const PriorEvidence evidence(basis(), data, basis().at(data), 0);
    return {priorGate(evidence, 4), evidence.posterior()};
}

LightView pairOf(double thetaI, double thetaO, double phiO) {
    return {
        .in = Direction::fromSpherical(Radians::fromDegrees(thetaI), 0_deg),
        .out = Direction::fromSpherical(Radians::fromDegrees(thetaO), Radians::fromDegrees(phiO))};
}

TEST(PriorLibrary, IsTheSameForASeedAndEverySpecIsAModel) {
    const PriorLibrary library = PriorLibrary::standard(200, 3);
    EXPECT_EQ(library.specs, PriorLibrary::standard(200, 3).specs);
    EXPECT_NE(library.specs, PriorLibrary::standard(200, 4).specs);
    for (const std::string& spec : library.specs) EXPECT_TRUE(makeModel(spec)) << spec;
}

TEST(PriorLibrary, ReadsBackWhatItWrites) {
    const test::TempFolder folder;
    const PriorLibrary library = PriorLibrary::standard(20);
    std::ofstream(folder / "library.txt") << library.text();
    const auto read = PriorLibrary::read(folder / "library.txt");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->specs, library.specs);
}

TEST(PriorLibrary, NamesTheLineThatIsNoModel) {
    const test::TempFolder folder;
    std::ofstream(folder / "library.txt") << "# a comment\nlambert,albedo=0.2\nbanana\n";
    const auto read = PriorLibrary::read(folder / "library.txt");
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message.find("line 3"), std::string::npos) << read.error().message;
    EXPECT_NE(read.error().message.find("banana"), std::string::npos);
    std::ofstream(folder / "empty.txt") << "# nothing\n";
    EXPECT_FALSE(PriorLibrary::read(folder / "empty.txt"));
    EXPECT_FALSE(PriorLibrary::read(folder / "missing.txt"));
}

TEST(PriorLibrary, RefusesFewerThanTenMaterialsThatDiffer) {
    const test::TempFolder folder;
    PriorLibrary library = PriorLibrary::standard(9);
    library.specs.insert(library.specs.end(), 5, library.specs.front());
    std::ofstream(folder / "few.txt") << library.text();
    const auto few = PriorLibrary::read(folder / "few.txt");
    ASSERT_FALSE(few);
    EXPECT_EQ(few.error().kind, ErrorKind::File);
    EXPECT_NE(few.error().message.find("9 materials that differ"), std::string::npos)
        << few.error().message;
    EXPECT_NE(few.error().message.find("prior build"), std::string::npos);
    library.specs.emplace_back("lambert,albedo=0.123");
    std::ofstream(folder / "enough.txt") << library.text();
    EXPECT_TRUE(PriorLibrary::read(folder / "enough.txt"));
}

TEST(PriorLibrary, AddsThePublishedFitsThatAGridOfOneDegreeResolves) {
    const test::TempFolder folder;
    const auto ward = [](const std::string& name, const std::string& roughness) {
        return name +
               " = Aggregate(Lambertian(albedo = [0.1, 0.2, 0.3]), NganWard(albedo = "
               "[1, 2, 3], roughness = " +
               roughness + "))\n";
    };
    std::ofstream(folder / "some.fit") << ward("wide", "0.05") << ward("narrow", "0.03");
    PriorLibrary library = PriorLibrary::standard(12);
    const auto added = library.addPublishedFits(folder / "some.fit");
    ASSERT_TRUE(added) << added.error().message;
    EXPECT_EQ(*added, 1U);
    ASSERT_EQ(library.specs.size(), 13U);
    const auto last = makeModel(library.specs.back());
    ASSERT_TRUE(last) << library.specs.back();
    // Both terms at the normal, in the first band.
    EXPECT_NEAR((*last)->answer({Direction(), Direction()}).f[Band::R],
                0.1 / kPi + 1 / (4 * kPi * 0.05 * 0.05),
                1e-9);
}

TEST(PriorBasis, RefusesALibraryWithoutModels) {
    EXPECT_FALSE(PriorBasis::over(PriorLibrary{{"lambert,albedo=2"}}));
}

TEST(PriorBasis, HasNoMoreFunctionsThanMaterialsThatDiffer) {
    const PriorLibrary library{
        {"lambert,albedo=0.2", "lambert,albedo=0.2", "ggx,alpha=0.2,f0=0.5"}};
    EXPECT_EQ(PriorBasis::over(library)->size(), 2U);
}

TEST(Prior, FindsAMaterialOfItsKindBetweenAndBeyondTheAngles) {
    const auto truth = model("lambert,albedo=0.25+ggx,alpha=0.21,f0=0.045");
    const Judged judged = judge(*truth);
    EXPECT_TRUE(judged.gate.passes()) << judged.gate.chiSquare;
    for (const LightView& pair :
         {pairOf(30, 30, 180), pairOf(10, 50, 60), pairOf(50, 20, 120), pairOf(70, 60, 170)}) {
        const double cosines = pair.in.z() * pair.out.z();
        const auto value =
            judged.posterior.at(basis().at(pair), basis().restVariance(proc::pairOf<double>(pair)));
        const double y = std::log(truth->answer(pair).f[Band::R] * cosines + kPriorFloor);
        EXPECT_NEAR(value.y, y, 0.03);
        EXPECT_LT(std::abs(value.y - y), 4 * value.deviation);
    }
}

TEST(Prior, IsSurerWhereItWasMeasured) {
    const Judged judged = judge(*model("lambert,albedo=0.2+ggx,alpha=0.3,f0=0.04"));
    const auto deviation = [&](const LightView& pair) {
        return judged.posterior
            .at(basis().at(pair), basis().restVariance(proc::pairOf<double>(pair)))
            .deviation;
    };
    EXPECT_LT(deviation(pairOf(20, 30, 90)), deviation(pairOf(80, 84, 180)) / 3);
}

TEST(Prior, RefusesWhatIsNotOfItsKind) {
    // A lobe back towards the light is in no material of the library.
    const auto retro = model("lambert,albedo=0.2+lafortune,cxy=1,cz=1,n=30,ks=0.1");
    EXPECT_FALSE(judge(*retro).gate.passes());
}

TEST(PriorEvidence, OfNoValueIsThePriorItself) {
    BrdfData data = test::simulated(*model("lambert,albedo=0.2"), 50);
    for (FitRow& row : data.rows) row.f = {std::nan(""), 1, 1};
    const PriorEvidence evidence(basis(), data, basis().at(data), 0);
    EXPECT_TRUE(evidence.empty());
    EXPECT_LT((evidence.posterior().mean() - basis().mean()).norm(), 1e-3 * basis().mean().norm());
}

TEST(PriorEvidence, LeavesOutValuesThatAreMostlyNoise) {
    BrdfData data = test::simulated(*model("lambert,albedo=0.2"), 50);
    for (FitRow& row : data.rows) {
        row.f = {-1e-5, 1e-5, 0};
        row.uRandom = {1e-3, 1e-3, 1e-3};
    }
    for (std::size_t band = 0; band < 3; ++band) {
        EXPECT_TRUE(PriorEvidence(basis(), data, basis().at(data), band).empty());
    }
}

}  // namespace
}  // namespace gonio::proc
