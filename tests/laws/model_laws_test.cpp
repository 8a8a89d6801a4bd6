// Laws that every model obeys, or whose exception its header states: reciprocity, energy, no
// negative value, limits at which one model is another, and agreement between the paths of
// evaluation.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "proc/models/spec.h"
#include "proc/solve/quadrature.h"
#include "tests/support/model_specs.h"
#include "tests/support/random_directions.h"

namespace gonio::proc {
namespace {

std::unique_ptr<const AnalyticModel> model(const std::string& spec, EvalPath path = {}) {
    auto made = makeModel(spec, path);
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    return std::move(*made);
}

double largest(const LedBands& f) { return std::max({f.value[0], f.value[1], f.value[2]}); }

std::string nameOf(const std::string& spec) {
    std::string name;
    for (char c : spec) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    return name;
}

class ModelLaws : public ::testing::TestWithParam<test::ModelSpec> {};

TEST_P(ModelLaws, IsReciprocalOrSaysThatItIsNot) {
    std::mt19937_64 random(2);
    const auto m = model(GetParam().spec);
    double worst = 0;
    for (int i = 0; i < 5000; ++i) {
        const Direction a = test::randomDirection(random);
        const Direction b = test::randomDirection(random);
        const double ab = largest(m->answer({a, b}).f);
        const double ba = largest(m->answer({b, a}).f);
        if (ab + ba > 0) worst = std::max(worst, std::abs(ab - ba) / (ab + ba));
    }
    if (GetParam().reciprocal) {
        EXPECT_LT(worst, 1e-12);
    } else {
        EXPECT_GT(worst, 1e-4) << "the exception is no longer one";
    }
}

TEST_P(ModelLaws, IsNeverNegative) {
    std::mt19937_64 random(3);
    const auto m = model(GetParam().spec);
    for (int i = 0; i < 20000; ++i) {
        const LedBands f =
            m->answer({test::randomDirection(random), test::randomDirection(random)}).f;
        for (Band b : kBands) ASSERT_GE(f[b], 0);
    }
}

/// Directional albedo, by a Gauss rule in theta and phi.
double albedo(const AnalyticModel& m, Radians incidence) {
    static const auto nodes = gaussLegendre(128);
    const Direction wi = Direction::fromSpherical(incidence, Radians(0.3));
    double sum = 0;
    for (const QuadratureNode& ring : nodes) {
        const Radians theta(kPi / 2 * ring.x);
        for (const QuadratureNode& sector : nodes) {
            const Direction wo = Direction::fromSpherical(theta, Radians(2 * kPi * sector.x));
            sum += largest(m.answer({wi, wo}).f) * sin(theta) * cos(theta) * kPi * kPi *
                   ring.weight * sector.weight;
        }
    }
    return sum;
}

TEST_P(ModelLaws, ReflectsNoMoreThanItSays) {
    const auto m = model(GetParam().spec);
    for (double degrees : {0.0, 20.0, 40.0, 60.0, 75.0}) {
        // The rule is off by less than 1e-3 for the lobes of these specs.
        EXPECT_LE(albedo(*m, Radians::fromDegrees(degrees)), GetParam().albedo + 1e-3) << degrees;
    }
}

TEST_P(ModelLaws, PathsAgreeWithinTheirBounds) {
    // Draft's polynomials are right to 4e-6 of a lobe's peak, Walter's Lambda to 0.35 % of G1;
    // standard's to 2e-7; float carries a few ulp times the exponent's size.
    const std::string& spec = GetParam().spec;
    const double draft = spec.find("beckmann") != std::string::npos ? 1e-2 : 1e-5;
    const auto exact = model(spec);
    const auto standard = model(spec, {Effort::Standard, Precision::Double});
    const auto sketch = model(spec, {Effort::Draft, Precision::Double});
    const auto narrow = model(spec, {Effort::Reference, Precision::Float});
    std::mt19937_64 random(4);
    double peak = 0;
    for (int i = 0; i < 2000; ++i) {
        const Direction wi = test::randomDirection(random);
        peak = std::max(peak, largest(exact->answer({wi, mirrorOf(wi)}).f));
    }
    for (int i = 0; i < 5000; ++i) {
        const LightView pair{test::randomDirection(random), test::randomDirection(random)};
        const double f = largest(exact->answer(pair).f);
        const double scale = std::max(f, peak);
        EXPECT_NEAR(largest(standard->answer(pair).f), f, 1e-6 * scale);
        EXPECT_NEAR(largest(sketch->answer(pair).f), f, draft * scale);
        EXPECT_NEAR(largest(narrow->answer(pair).f), f, 3e-5 * scale);
    }
}

TEST_P(ModelLaws, AnArrayIsEvaluatedAsItsPairs) {
    constexpr std::size_t kCount = 103;  // no multiple of a vector's length
    std::array<std::vector<double>, 6> in;
    std::array<std::vector<double>, 3> out;
    for (auto& one : in) one.resize(kCount);
    for (auto& one : out) one.resize(kCount);
    std::mt19937_64 random(5);
    std::vector<LightView> pairs;
    for (std::size_t i = 0; i < kCount; ++i) {
        Direction wo = test::randomDirection(random);
        if (i == 50) wo = *Direction::fromVector({0.3, 0.1, -0.5});
        pairs.push_back({test::randomDirection(random), wo});
        for (Eigen::Index k = 0; k < 3; ++k) {
            in.at(static_cast<std::size_t>(k))[i] = pairs[i].in.vector()[k];
            in.at(static_cast<std::size_t>(k + 3))[i] = pairs[i].out.vector()[k];
        }
    }
    const auto m = model(GetParam().spec);
    m->evaluate(PairArrays<double>{in[0], in[1], in[2], in[3], in[4], in[5]},
                BandArrays<double>{out[0], out[1], out[2]});
    for (std::size_t i = 0; i < kCount; ++i) {
        const LedBands f = m->answer(pairs[i]).f;
        for (Band b : kBands) {
            const double seen = out.at(index(b))[i];
            if (i == 50) {
                EXPECT_TRUE(std::isnan(seen));
            } else {
                // Vector units round like scalar ones: only library functions may differ in an ulp.
                EXPECT_NEAR(seen, f[b], 1e-14 * f[b]);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All,
                         ModelLaws,
                         ::testing::ValuesIn(test::modelSpecs()),
                         [](const auto& one) { return nameOf(one.param.spec); });

TEST(ModelLaws, EveryModelHasALaw) {
    for (std::string_view name : modelNames()) {
        if (name == "tabulated" || name == "merl-fit") continue;  // material_files_test.cpp
        bool found = false;
        for (const test::ModelSpec& one : test::modelSpecs()) {
            found = found || one.spec.starts_with(std::string(name) + ",");
        }
        EXPECT_TRUE(found) << name;
    }
}

TEST(ModelLaws, ExcessesAreWhatTheHeadersSay) {
    // Disney's 1.558 and Call of Duty's 1.158 are suprema at grazing; 1.52 and 1.13 from mu = 0.02
    // on.
    const Radians grazing(std::acos(1e-3));
    EXPECT_NEAR(albedo(*model("disney-diffuse,albedo=1,roughness=1"), grazing), 1.558, 0.004);
    EXPECT_NEAR(albedo(*model("cod-wwii-diffuse,albedo=1,alpha=1"), grazing), 1.158, 0.004);
    EXPECT_NEAR(albedo(*model("frostbite-diffuse,albedo=1,roughness=1"), grazing), 1.032, 0.003);
    EXPECT_NEAR(albedo(*model("oren-nayar,albedo=1,sigma=0.2"), grazing), 1.015, 0.002);
}

struct Limit {
    std::string name;
    std::string spec;
    std::string becomes;
    double relative = 1e-12;
};

class ModelLimits : public ::testing::TestWithParam<Limit> {};

TEST_P(ModelLimits, AreReached) {
    const auto a = model(GetParam().spec);
    const auto b = model(GetParam().becomes);
    std::mt19937_64 random(6);
    for (int i = 0; i < 2000; ++i) {
        const LightView pair{test::randomDirection(random), test::randomDirection(random)};
        const double f = largest(b->answer(pair).f);
        EXPECT_NEAR(largest(a->answer(pair).f), f, GetParam().relative * f);
    }
}

INSTANTIATE_TEST_SUITE_P(
    All,
    ModelLimits,
    ::testing::Values(
        Limit{"OrenNayarOfSigma0IsLambert", "oren-nayar,albedo=0.7,sigma=0", "lambert,albedo=0.7"},
        Limit{"FujiiOfR0IsLambert", "fujii-oren-nayar,albedo=0.7,r=0", "lambert,albedo=0.7"},
        Limit{"GgxOfEqualAlphasIsIsotropic",
              "ggx,alpha_x=0.3,alpha_y=0.3,f0=0.5",
              "ggx,alpha=0.3,f0=0.5"},
        Limit{"BeckmannOfEqualAlphasIsIsotropic",
              "beckmann,alpha_x=0.3,alpha_y=0.3,f0=0.5",
              "beckmann,alpha=0.3,f0=0.5"},
        Limit{"WardOfEqualAlphasIsIsotropic",
              "ward,alpha_x=0.3,alpha_y=0.3,ks=0.5",
              "ward,alpha=0.3,ks=0.5"},
        Limit{"PhongWithoutALobeIsLambert", "phong,kd=0.5,ks=0,n=10", "lambert,albedo=0.5"},
        Limit{"LafortuneAlongTheMirrorIsLafortunePhong",
              "lafortune,cxy=-1,cz=1,n=25,ks=0.4",
              "lafortune-phong,kd=0,ks=0.4,n=25"},
        Limit{"LafortuneDoesNotDependOnItsScale",
              "lafortune,cxy=-2,cz=2,n=25,ks=0.4",
              "lafortune,cxy=-1,cz=1,n=25,ks=0.4"},
        Limit{"WalterIsGgxWithSeparableMaskingAndExactFresnel",
              "walter,alpha=0.3,eta=1.5",
              "ggx,alpha=0.3,eta=1.5,fresnel=exact,masking=separable"},
        Limit{"ConductorWithoutAbsorptionIsDielectric",
              "ggx,alpha=0.3,eta=1.5,k=0,fresnel=exact",
              "ggx,alpha=0.3,eta=1.5,fresnel=exact",
              1e-10},
        Limit{"ExactFresnelTakesItsIndexFromF0",
              "ggx,alpha=0.3,f0=0.04,fresnel=exact",
              "ggx,alpha=0.3,eta=1.5,fresnel=exact"},
        Limit{
            "DisneyWithoutExtrasIsItsDiffuseAndALobe",
            "disney,base=0.5,roughness=0.6",
            "disney-diffuse,albedo=0.5,roughness=0.6+ggx,roughness=0.6,f0=0.04,masking=separable"},
        Limit{"MetallicRoughnessOfAMetalIsGgx",
              "metallic-roughness,base=0.8,metallic=1,roughness=0.6",
              "ggx,roughness=0.6,f0=0.8,masking=separable"},
        Limit{"ByEffortReferencePowerIsPow",
              "blinn-phong,kd=0,ks=1,n=80",
              "blinn-phong,kd=0,ks=1,n=80,power=pow"}),
    [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace gonio::proc
