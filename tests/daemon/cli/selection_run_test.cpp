// The choice of a model for whole captures: in several laboratories, each with references wrong by
// its own draw, samples of known families are measured and fitted with all families. A long study:
// it runs with GONIO_NIGHTLY only, and writes its table to $GONIO_SELECTION_TABLE when that is set.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/daemon/cli/lab_bench.h"

namespace gonio {
namespace {

using Json = nlohmann::json;
using test::Bench;

struct Known {
    std::string family, spec;
    std::map<std::string, double> parameters;  ///< with _r, _g, _b where they differ by band
};
const std::vector<Known> kKnown{
    {"lambert",
     "lambert,albedo=0.3/0.2/0.1",
     {{"albedo_r", 0.3}, {"albedo_g", 0.2}, {"albedo_b", 0.1}}},
    {"oren-nayar", "oren-nayar,albedo=0.6/0.5/0.4,sigma=0.5", {{"sigma", 0.5}, {"albedo_r", 0.6}}},
    {"lambert+ggx",
     "lambert,albedo=0.3/0.1/0.05+ggx,alpha=0.2,f0=0.04",
     {{"ggx.alpha", 0.2}, {"lambert.albedo_r", 0.3}, {"ggx.f0_r", 0.04}}},
    {"lambert+beckmann",
     "lambert,albedo=0.1/0.2/0.3+beckmann,alpha=0.25,f0=0.05",
     {{"beckmann.alpha", 0.25}, {"lambert.albedo_r", 0.1}, {"beckmann.f0_r", 0.05}}},
    {"ggx", "ggx,alpha=0.15,f0=0.9/0.7/0.4", {{"alpha", 0.15}, {"f0_r", 0.9}, {"f0_b", 0.4}}},
    {"lambert+ggx+ggx",
     "lambert,albedo=0.2+ggx,alpha=0.1,f0=0.02+ggx,alpha=0.4,f0=0.06",
     {{"ggx1.alpha", 0.1}, {"ggx2.alpha", 0.4}, {"lambert.albedo_r", 0.2}}},
    {"disney-diffuse+ggx",
     "disney-diffuse,albedo=0.4/0.3/0.2,roughness=0.8+ggx,alpha=0.3,f0=0.04",
     {{"ggx.alpha", 0.3}, {"disney-diffuse.roughness", 0.8}, {"disney-diffuse.albedo_r", 0.4}}},
    {"phong", "phong,kd=0.3/0.2/0.1,ks=0.2,n=40", {{"n", 40}, {"kd_r", 0.3}, {"ks_r", 0.2}}},
    {"cod-wwii-diffuse",
     "cod-wwii-diffuse,albedo=0.5/0.4/0.3,alpha=0.4",
     {{"alpha", 0.4}, {"albedo_r", 0.5}}},
};

const Json& modelNamed(const Json& fits, const std::string& name) {
    for (const Json& model : fits["models"])
        if (model["model"] == name) return model;
    static const Json kNone;
    return kNone;
}

struct Parameters {
    int all = 0, within2u = 0;
    double worst = 0;  ///< in u
};
Parameters heldBy(const Json& model, const Known& known) {
    Parameters held;
    for (const Json& p : model["parameters"]) {
        const std::string band = p["band"].is_null() ? "" : "_" + p["band"].get<std::string>();
        const auto truth = known.parameters.find(p["name"].get<std::string>() + band);
        if (truth == known.parameters.end() || !p["u_random"].is_number()) continue;
        const double u = std::hypot(p["u_random"].get<double>(), p["u_systematic"].get<double>());
        const double off = std::abs(p["value"].get<double>() - truth->second) / u;
        std::cout << "    " << p["name"].get<std::string>() << band << " " << p["value"] << " of "
                  << truth->second << ", u " << p["u_random"] << " and " << p["u_systematic"]
                  << "\n";
        ++held.all;
        held.within2u += off <= 2 ? 1 : 0;
        held.worst = std::max(held.worst, off);
    }
    return held;
}

TEST(SelectionRun, NamesTheFamilyOfCapturesInSeveralLaboratories) {
    if (std::getenv("GONIO_NIGHTLY") == nullptr) GTEST_SKIP() << "a nightly study";
    constexpr int kLabs = 3;
    std::string table;
    int named = 0, samples = 0;
    Parameters all;
    for (int lab = 0; lab < kLabs; ++lab) {
        const Bench gonio;
        gonio.calibrate("random", 300 + lab);
        for (const Known& known : kKnown) {
            gonio({"sim", "place", "model:" + known.spec});
            gonio({"measure", "sample"});
            const Json fits = gonio({"fit", "sample:sample", "--models", "all"});
            const Json& truth = modelNamed(fits, known.family);
            const std::string chosen =
                fits["chosen"].is_null() ? "none" : fits["chosen"].get<std::string>();
            const Parameters held = heldBy(truth, known);
            ++samples;
            named += chosen == known.family ? 1 : 0;
            all.all += held.all;
            all.within2u += held.within2u;
            std::ostringstream row;
            row << "| " << lab << " | " << known.family << " | " << chosen << " | "
                << truth["chi_square_per_dof"] << " | " << held.within2u << " of " << held.all
                << " | " << held.worst << " |\n";
            std::cout << row.str() << "  " << fits["verdict"] << "\n" << std::flush;
            table += row.str();
        }
    }
    if (const char* file = std::getenv("GONIO_SELECTION_TABLE")) test::writeText(file, table);
    std::cout << named << " of " << samples << " named, " << all.within2u << " of " << all.all
              << " parameters within 2 u\n";
    EXPECT_GE(named, 0.9 * samples);
    EXPECT_GE(all.all, 2 * samples);
    EXPECT_GE(all.within2u, 0.9 * all.all);
}

}  // namespace
}  // namespace gonio
