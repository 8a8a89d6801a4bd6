// Published fits of MERL's materials there and back: each as a surface, its values at four
// incidences, and the family of its model fitted to them.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>

#include "proc/fit/model_fit.h"
#include "proc/models/published_fits.h"
#include "proc/models/spec.h"
#include "tests/fit/simulated.h"
#include "tests/support/data_file.h"

namespace gonio::proc {
namespace {

struct Kind {
    std::string file, family;
    std::string width;  ///< the lobe's key in the spec
    double narrowest = 0, widest = 0;
};
const std::vector<Kind> kKinds{
    {"ngan_ward.fit", "lambert+ward", ",alpha=", 5e-3, 1},
    {"ngan_cooktorrance.fit", "lambert+cook-torrance-scaled", ",m=", 5e-3, 1},
    {"ngan_lafortune.fit", "lambert+lafortune", ",n=", 1, 8e4},
    {"low_cooktorrance_E1.fit", "lambert+low", ",roughness=", 5e-3, 3}};

void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.file; }

double numberAfter(const std::string& spec, const std::string& key) {
    const std::size_t at = spec.find(key);
    EXPECT_NE(at, std::string::npos) << spec;
    return at == std::string::npos ? 0 : std::strtod(spec.c_str() + at + key.size(), nullptr);
}

class PublishedFits : public ::testing::TestWithParam<Kind> {};

TEST_P(PublishedFits, AreFoundAgainFromTheirOwnValues) {
    const Kind& kind = GetParam();
    const auto file = test::dataFile("merl_model_fits/" + kind.file);
    if (!file) GTEST_SKIP();
    const auto fits = readPublishedFits(*file);
    ASSERT_TRUE(fits) << fits.error().message;
    const std::size_t step = std::getenv("GONIO_NIGHTLY") != nullptr ? 1 : 9;
    ModelFitOptions options;
    options.heldOutRows = 0;
    int narrow = 0;
    int wide = 0;
    int all = 0;
    double worst = 0;
    for (std::size_t i = 0; i < fits->size(); i += step) {
        const PublishedFit& published = (*fits)[i];
        const double width = numberAfter(published.spec, kind.width);
        narrow += width < kind.narrowest ? 1 : 0;
        wide += width > kind.widest ? 1 : 0;
        if (width < kind.narrowest || width > kind.widest) continue;
        const auto surface = makeModel(published.spec);
        ASSERT_TRUE(surface) << published.material;
        const BrdfData data = test::simulated(**surface, 800);
        const ModelFit fit = fitModel(**familyNamed(kind.family), data, options);
        ++all;
        ASSERT_TRUE(fit.usable()) << published.material << ": " << fit.message;
        // 1 % and 2e-4 / sr is what a value is uncertain by: a hundredth of that.
        const double rest = std::sqrt(fit.chiSquare / static_cast<double>(fit.values));
        worst = std::max(worst, rest);
        EXPECT_LT(rest, 0.01) << published.material << ": " << published.spec << "\n" << fit.spec;
        EXPECT_NEAR(numberAfter(fit.spec, kind.width), width, 1e-3 * width)
            << published.material << ": " << published.spec << "\n"
            << fit.spec;
    }
    std::cout << kind.file << ": " << all << " found again, worst misfit " << worst
              << " u; left out: " << narrow << " narrower and " << wide
              << " wider than the family's bounds\n";
    EXPECT_GT(all, 0);
}

INSTANTIATE_TEST_SUITE_P(Papers, PublishedFits, ::testing::ValuesIn(kKinds), [](const auto& kind) {
    return kind.param.file.substr(0, kind.param.file.find('.'));
});

}  // namespace
}  // namespace gonio::proc
