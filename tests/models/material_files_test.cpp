// Models whose numbers come from files: optical constants, published fits, tables of normals.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "proc/models/optical_constants.h"
#include "proc/models/published_fits.h"
#include "proc/models/spec.h"
#include "proc/models/tabulated.h"

namespace gonio::proc {
namespace {

namespace fs = std::filesystem;

class MaterialFiles : public ::testing::Test {
protected:
    void SetUp() override { fs::create_directories(folder_); }
    void TearDown() override { fs::remove_all(folder_); }

    [[nodiscard]] fs::path written(const std::string& text) const {
        const fs::path file = folder_ / "file";
        std::ofstream(file) << text;
        return file;
    }
    /// A file of the shared data; empty, with one line said, where it is absent.
    static fs::path data(const std::string& name) {
        const fs::path file = fs::path(GONIO_DATA_DIR) / name;
        if (fs::exists(file)) return file;
        std::cout << "skipped: no " << name << " in GONIO_DATA_DIR\n";
        return {};
    }

private:
    fs::path folder_ =
        fs::temp_directory_path() /
        ("gonio-" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
};

std::string errorOf(const std::string& spec) {
    const auto made = makeModel(spec);
    return made ? "" : made.error().message;
}

TEST_F(MaterialFiles, OpticalConstantsAreLinearBetweenRows) {
    const fs::path file = written(
        "REFERENCES: |\n    x\nDATA:\n  - type: tabulated nk\n    data: |\n"
        "        0.4 1.0 2.0\n        0.5 2.0 4.0\n        0.7 4.0 8.0\nCONDITIONS: none\n");
    const auto constants = readOpticalConstants(file);
    ASSERT_TRUE(constants) << constants.error().message;
    EXPECT_NEAR(constants->eta[Band::B], 1.65, 1e-12);  // 465 nm
    EXPECT_NEAR(constants->k[Band::G], 4.5, 1e-12);     // 525 nm
    EXPECT_NEAR(constants->eta[Band::R], 3.3, 1e-12);   // 630 nm
}

TEST_F(MaterialFiles, OpticalConstantsSayWhatIsWrong) {
    const std::string head = "DATA:\n  - type: tabulated nk\n    data: |\n";
    const auto complaint = [&](const std::string& text) {
        const auto read = readOpticalConstants(written(text));
        EXPECT_FALSE(read);
        if (read) return std::string();
        EXPECT_EQ(read.error().kind, ErrorKind::File);
        return read.error().message;
    };
    EXPECT_NE(complaint("DATA: none\n").find("no table"), std::string::npos);
    EXPECT_NE(complaint(head + "    0.4 1\n").find("no row"), std::string::npos);
    EXPECT_NE(complaint(head + "    0.4 1 banana\n").find("no row"), std::string::npos);
    EXPECT_NE(complaint(head + "    0.6 1 2\n    0.5 1 2\n").find("must rise"), std::string::npos);
    EXPECT_NE(complaint(head + "    0.4 1 2\n    0.5 1 2\n").find("630 nm"), std::string::npos);
    EXPECT_NE(complaint(head).find("no rows"), std::string::npos);
    EXPECT_NE(complaint(head + "    0.4 -1 2\n    0.7 -1 2\n").find("n = -1"), std::string::npos);
    EXPECT_NE(errorOf("ggx,alpha=0.1,nk=/nowhere.yml").find("/nowhere.yml"), std::string::npos);
}

TEST_F(MaterialFiles, OpticalConstantsOfMetalsGiveTheirF0) {
    // F0 at 465, 525, 630 nm as SOURCES.md of the folder has them, to four digits.
    const struct {
        std::string file;
        double b, g, r;
    } metals[] = {{"Au_Johnson.yml", 0.4035, 0.6665, 0.9420},
                  {"Cu_Johnson.yml", 0.5499, 0.5952, 0.9153},
                  {"Al_Rakic.yml", 0.9207, 0.9170, 0.9081}};
    for (const auto& metal : metals) {
        const fs::path file = data("optical_constants/" + metal.file);
        if (file.empty()) return;
        const auto model = makeModel("ggx,alpha=1,fresnel=exact,nk=" + file.string());
        ASSERT_TRUE(model) << model.error().message;
        // At alpha 1 and the normal D V = 1 / (4 pi).
        const LedBands f = (*model)->answer({Direction(), Direction()}).f * (4 * kPi);
        EXPECT_NEAR(f[Band::B], metal.b, 1e-4) << metal.file;
        EXPECT_NEAR(f[Band::G], metal.g, 1e-4) << metal.file;
        EXPECT_NEAR(f[Band::R], metal.r, 1e-4) << metal.file;
    }
}

TEST_F(MaterialFiles, PublishedFitsBecomeSpecsOfOurModels) {
    const fs::path file = written(
        "# comment\n"
        "a = Aggregate(Lambertian(albedo = [0.1, 0.2, 0.3]), NganWard(albedo = [1, 2, 3], "
        "roughness = 0.05))\n"
        "b = Aggregate(LowCookTorrance(albedo = [0.5, 0.5, 0.5], roughness = 0.2, eta = 1.5))\n");
    const auto fits = readPublishedFits(file);
    ASSERT_TRUE(fits) << fits.error().message;
    ASSERT_EQ(fits->size(), 2U);
    EXPECT_EQ(fits->at(0).spec, "lambert,albedo=0.1/0.2/0.3+ward,ks=1/2/3,alpha=0.05");
    EXPECT_EQ(fits->at(1).spec, "low,ks=0.5/0.5/0.5,roughness=0.2,eta=1.5");
    const auto model = makeModel("merl-fit,material=a,F=" + file.string());
    ASSERT_TRUE(model) << model.error().message;
    const double f = (*model)->answer({Direction(), Direction()}).f[Band::G];
    EXPECT_NEAR(f, 0.2 / kPi + 2 / (4 * kPi * 0.05 * 0.05), 1e-9);
    const fs::path odd = file.parent_path() / "a+b,c.fit";
    fs::copy_file(file, odd);
    EXPECT_EQ(errorOf("merl-fit,material=a,F=\"" + odd.string() + "\"+lambert,albedo=0.1"), "");
    EXPECT_NE(errorOf("merl-fit,material=a,F=\"" + odd.string()).find("not closed"),
              std::string::npos);
    EXPECT_NE(errorOf("merl-fit,material=c,F=" + file.string()).find("no material 'c'"),
              std::string::npos);
    EXPECT_NE(errorOf("merl-fit,material=c").find("'F' is missing"), std::string::npos);
    EXPECT_NE(errorOf("merl-fit,material=c,F=").find("'F' is empty"), std::string::npos);
    EXPECT_NE(errorOf("tabulated,F=").find("'F' is empty"), std::string::npos);
}

TEST_F(MaterialFiles, PublishedFitsSayWhatIsWrong) {
    for (const std::string text :
         {"nothing here\n",
          "a = Sum(Lambertian(albedo = [1, 1, 1]))\n",
          "a = Aggregate(Lambertian(albedo = [1, 1]))\n",
          "a = Aggregate(Lambertian(albedo = [1, 1, 1]), Unknown(x = 1))\n",
          "a = Aggregate(NganWard(albedo = [1, 1, 1]))\n",
          "a = Aggregate(NganWard(albedo = [1, 1, 1], roughness = x))\n",
          "a = Aggregate(Lambertian(albedo = [1, 1, 1)\n",
          ""}) {
        const auto fits = readPublishedFits(written(text));
        ASSERT_FALSE(fits) << text;
        EXPECT_EQ(fits.error().kind, ErrorKind::File);
    }
}

TEST_F(MaterialFiles, AllPublishedFitsOfMerlLoadAndAnswer) {
    std::size_t materials = 0;
    for (const std::string name :
         {"ngan_ward", "ngan_cooktorrance", "ngan_lafortune", "low_cooktorrance_E1"}) {
        const fs::path file = data("merl_model_fits/" + name + ".fit");
        if (file.empty()) return;
        const auto fits = readPublishedFits(file);
        ASSERT_TRUE(fits) << fits.error().message;
        for (const PublishedFit& fit : *fits) {
            const auto model = makeModel(fit.spec);
            ASSERT_TRUE(model) << fit.material << ": " << model.error().message;
            const Direction wi = Direction::fromSpherical(40_deg, 0_deg);
            for (const Direction& wo : {Direction(), mirrorOf(wi), wi}) {
                const LedBands f = (*model)->answer({wi, wo}).f;
                for (Band b : kBands) EXPECT_TRUE(std::isfinite(f[b]) && f[b] >= 0) << fit.material;
            }
            ++materials;
        }
    }
    EXPECT_EQ(materials, 358U);  // 86 of Ngan three times, 100 of Low
}

TEST_F(MaterialFiles, ATableOfGgxNormalsIsGgx) {
    // The distribution of GGX at alpha 0.3, every half degree and in a unit of its own; masking is
    // then Smith's separable, to the table's step.
    std::string text = "theta_h,d\n";
    for (int i = 0; i <= 180; ++i) {
        const double theta = i * kPi / 360;
        const double c2 = std::cos(theta) * std::cos(theta);
        const double s2 = std::sin(theta) * std::sin(theta);
        const double d = 0.09 / std::pow(s2 + 0.09 * c2, 2);
        text += std::to_string(i * 0.5) + "," + std::to_string(7 * d) + "\n";
    }
    const fs::path file = written(text);
    const auto table = makeModel("tabulated,f0=0.9,F=" + file.string());
    ASSERT_TRUE(table) << table.error().message;
    const auto ggx = makeModel("ggx,alpha=0.3,f0=0.9,masking=separable");
    for (double thetaIn : {0.0, 30.0, 60.0, 80.0}) {
        for (double thetaOut : {0.0, 20.0, 50.0, 80.0}) {
            for (double phi : {0.0, 90.0, 180.0}) {
                const LightView pair{Direction::fromSpherical(Radians::fromDegrees(thetaIn), 0_deg),
                                     Direction::fromSpherical(Radians::fromDegrees(thetaOut),
                                                              Radians::fromDegrees(phi))};
                const double wanted = (*ggx)->answer(pair).f[Band::G];
                EXPECT_NEAR((*table)->answer(pair).f[Band::G], wanted, 2e-3 * wanted)
                    << thetaIn << " " << thetaOut << " " << phi;
            }
        }
    }
}

TEST_F(MaterialFiles, ATableOfNormalsSaysWhatIsWrong) {
    for (const std::string text : {"theta,d\n0,1\n90,0\n",
                                   "theta_h,d\n0,1\n",
                                   "theta_h,d\n1,1\n90,0\n",
                                   "theta_h,d\n0,1\n95,0\n",
                                   "theta_h,d\n0,1\n50,0\n40,0\n",
                                   "theta_h,d\n0,-1\n90,0\n",
                                   "theta_h,d\n0,0\n90,0\n",
                                   "theta_h,d\n0,banana\n90,0\n"}) {
        const auto table = NormalTable::read(written(text));
        ASSERT_FALSE(table) << text;
        EXPECT_EQ(table.error().kind, ErrorKind::File);
    }
    const auto made = makeModel("tabulated,F=/nowhere.csv");
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().kind, ErrorKind::File);
}

}  // namespace
}  // namespace gonio::proc
