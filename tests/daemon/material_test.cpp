#include "daemon/material.h"

#include <gtest/gtest.h>

#include "daemon/store.h"
#include "proc/formats/gonio_exr.h"
#include "tests/support/sample_sets.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

double degreesOf(const std::vector<Radians>& angles, std::size_t i) {
    return std::round(angles.at(i).degrees() * 1e9) / 1e9;
}

TEST(Material, ModelAnswersAtTheLedsIncidences) {
    const auto material = openMaterial("model:lambert,albedo=0.5", "");
    ASSERT_TRUE(material) << material.error().message;
    EXPECT_EQ(material->kind, "model");
    EXPECT_EQ(material->incidences().size(), 4U);
    EXPECT_EQ(material->sample, nullptr);
    EXPECT_EQ(material->table, nullptr);
    EXPECT_NEAR(material->scatterer->answer({}).f[Band::R], 0.5 / kPi, 1e-15);
}

TEST(Material, ZemaxFileKeepsItsOwnIncidences) {
    const auto material = openMaterial(GONIO_SOURCE_DIR "/config/demo/AnoBlackEC1onAlum.bsdf", "");
    ASSERT_TRUE(material) << material.error().message;
    EXPECT_EQ(material->kind, "zemax");
    ASSERT_NE(material->table, nullptr);
    const auto incidences = material->incidences();
    ASSERT_EQ(incidences.size(), material->table->incidenceDeg.size());
    for (std::size_t i = 0; i < incidences.size(); ++i) {
        EXPECT_EQ(degreesOf(incidences, i), material->table->incidenceDeg[i]);
    }
}

TEST(Material, SampleOfTheStoreIsFoundByName) {
    const test::TempFolder folder;
    auto store = Store::open(folder.path());
    ASSERT_TRUE(store);
    const auto set = test::sampleSet([](Radians, const Direction&) { return 0.1; });
    const auto bytes = proc::encodeGonio(set);
    ASSERT_TRUE(bytes);
    ASSERT_TRUE(store->addSample({.name = "tile", .rig = "R1", .dateUtc = "today"},
                                 {.file = *bytes, .raw = {}}));
    const auto material = openMaterial("sample:tile", folder.path());
    ASSERT_TRUE(material) << material.error().message;
    EXPECT_EQ(material->kind, "gonio");
    ASSERT_NE(material->sample, nullptr);
    EXPECT_EQ(material->sample->info.name, "test tile");
    EXPECT_EQ(degreesOf(material->incidences(), 3), 60);
}

TEST(Material, NamesWhatItCannotOpen) {
    const test::TempFolder folder;
    EXPECT_EQ(openMaterial("model:nonsense", "").error().kind, ErrorKind::Usage);
    EXPECT_EQ(openMaterial("sample:none", folder.path()).error().kind, ErrorKind::File);
    const auto missing = openMaterial("none.bsdf", folder.path());
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().message.find("none.bsdf"), std::string::npos);
}

}  // namespace
}  // namespace gonio::daemon
