// A measured surface with cells of next to nothing: the black anodised aluminium of config/demo,
// whose file holds exact zeros in a tenth to a third of its nodes. What is dark must neither choose
// the method nor set the uncertainty of what is bright.

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "proc/estimate/albedo.h"
#include "proc/estimate/interpolation_study.h"
#include "proc/estimate/sample_estimator.h"
#include "proc/formats/zemax.h"
#include "proc/table/specular_lookup.h"

namespace gonio::proc {
namespace {

std::shared_ptr<const Scatterer> anodised() {
    auto table = readZemax(GONIO_SOURCE_DIR "/config/demo/AnoBlackEC1onAlum.bsdf");
    EXPECT_TRUE(table) << table.error().message;
    auto lookup = SpecularLookup::over(std::move(*table));
    EXPECT_TRUE(lookup) << lookup.error().message;
    return std::make_shared<const SpecularLookup>(std::move(*lookup));
}

constexpr AlbedoOptions kCoarse{.tolerance = 1e-3, .mostEvaluations = 20000};

TEST(DarkCells, RuleNeitherTheChoiceNorTheUncertainty) {
    const auto truth = anodised();
    const SampleSet set = syntheticSample(*truth, {.relativeNoise = 0.01});
    const auto made = SampleEstimator::over(set, {.prior = standardPrior});
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_NE((*made)->choice().between.method->name().find("ggx+ggx"), std::string::npos)
        << (*made)->choice().between.method->name();
    // Where the file interpolates between its own incidences; it has a kink at 30 and at 50
    // degrees.
    const RegionError errors =
        errorOf(**made, *truth, {.incidences = {25_deg, 30_deg, 45_deg}, .stride = 7});
    EXPECT_LT(errors.lobe, 0.15);
    EXPECT_GT(errors.within2u, 0.85);
    for (const Radians incidence : {0_deg, 30_deg, 50_deg}) {
        const Direction wi = Direction::fromSpherical(incidence, 0_deg);
        const BandAlbedo said = directionalAlbedo(**made, wi, kCoarse)[Band::R];
        const double true_ = directionalAlbedo(*truth, wi, kCoarse)[Band::R].value;
        EXPECT_NEAR(said.value, true_, 2 * *said.u()) << incidence.degrees();
        EXPECT_LT(*said.u(), 0.4 * true_) << incidence.degrees();
    }
}

}  // namespace
}  // namespace gonio::proc
