#include "daemon/store.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <optional>

#include "daemon/sim_bench.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

TEST(Store, IsMadeWhereItWasAskedFor) {
    const test::TempFolder folder;
    ASSERT_TRUE(Store::open(folder / "a/b"));
    EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b/objects"));
    EXPECT_TRUE(std::filesystem::is_regular_file(folder / "a/b/gonio.db"));
    EXPECT_TRUE(Store::open(folder / "a/b"));
}

TEST(Store, RefusesAPlaceThatIsAFile) {
    const test::TempFolder folder;
    std::ofstream(folder / "file") << "x";
    const auto store = Store::open(folder / "file");
    ASSERT_FALSE(store);
    EXPECT_EQ(store.error().kind, ErrorKind::Busy);
    EXPECT_NE(store.error().message.find("--store"), std::string::npos);
}

TEST(Store, RefusesADatabaseThatIsNone) {
    const test::TempFolder folder;
    std::ofstream(folder / "gonio.db") << std::string(5000, 'x');
    const auto store = Store::open(folder.path());
    ASSERT_FALSE(store);
    EXPECT_EQ(store.error().kind, ErrorKind::File);
    EXPECT_NE(store.error().message.find("gonio.db"), std::string::npos);
}

TEST(SampleName, IsPlain) {
    for (const std::string& good :
         {std::string("a"), std::string("Tile-7_b.2"), std::string("0"), std::string(64, 'x')}) {
        EXPECT_TRUE(checkSampleName(good)) << good;
    }
    for (const std::string& bad : {std::string(),
                                   std::string("."),
                                   std::string(".."),
                                   std::string(".hidden"),
                                   std::string("-x"),
                                   std::string("_x"),
                                   std::string("a/b"),
                                   std::string("a b"),
                                   std::string("\xC3\xA4"),
                                   std::string("a\n"),
                                   std::string(65, 'x')}) {
        const auto verdict = checkSampleName(bad);
        ASSERT_FALSE(verdict) << bad;
        EXPECT_EQ(verdict.error().kind, ErrorKind::Usage);
    }
}

class OpenStore : public testing::Test {
protected:
    void SetUp() override {
        auto opened = Store::open(folder.path());
        ASSERT_TRUE(opened) << opened.error().message;
        store.emplace(std::move(*opened));
    }
    Result<Store::Added> add(const std::string& name, const std::string& text) {
        return store->addSample({.name = name, .rig = "R1", .dateUtc = "2026-01-01T00:00:00Z"},
                                {.file = text, .raw = "raw of " + text});
    }
    static std::string read(const std::filesystem::path& file) {
        std::ifstream in(file);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    test::TempFolder folder;
    std::optional<Store> store;
};

TEST_F(OpenStore, KeepsSamplesByName) {
    ASSERT_TRUE(store->samples()->empty());
    ASSERT_TRUE(add("b", "B"));
    ASSERT_TRUE(add("a", "A"));
    const auto all = store->samples();
    ASSERT_TRUE(all);
    ASSERT_EQ(all->size(), 2U);
    EXPECT_EQ((*all)[0].name, "a");
    const auto b = store->sample("b");
    ASSERT_TRUE(b);
    EXPECT_EQ(b->rig, "R1");
    EXPECT_EQ(b->dateUtc, "2026-01-01T00:00:00Z");
    EXPECT_EQ(read(b->file), "B");
    EXPECT_EQ(read(b->raw), "raw of B");
    EXPECT_EQ(b->file.extension(), ".gonio");
    EXPECT_EQ(b->raw.extension(), ".graw");
}

TEST_F(OpenStore, SampleThatIsMeasuredAgainIsKept) {
    EXPECT_EQ(add("a", "first")->movedTo, "");
    EXPECT_EQ(add("a", "second")->movedTo, "a.1");
    EXPECT_EQ(add("a", "third")->movedTo, "a.2");
    EXPECT_EQ(read(store->sample("a")->file), "third");
    EXPECT_EQ(read(store->sample("a.1")->file), "first");
    EXPECT_EQ(read(store->sample("a.2")->file), "second");
}

TEST_F(OpenStore, NamesWhatIsNotThere) {
    const auto none = store->sample("none");
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().kind, ErrorKind::File);
    EXPECT_NE(none.error().message.find("sample:none"), std::string::npos);
    EXPECT_EQ(add("../x", "x").error().kind, ErrorKind::Usage);
}

TEST_F(OpenStore, NewestCalibrationOfARigAndKindCounts) {
    const auto keep =
        [&](const std::string& rig, const std::string& kind, const std::string& text) {
            const auto added = store->addCalibration({.rig = rig, .kind = kind, .dateUtc = text},
                                                     {.file = text, .raw = {}});
            ASSERT_TRUE(added) << added.error().message;
            EXPECT_TRUE(added->raw.empty());
        };
    EXPECT_FALSE(*store->newestCalibration("R1", "white"));
    keep("R1", "white", "old");
    keep("R1", "white", "new");
    keep("R1", "black", "black");
    keep("R2", "white", "other rig");
    const auto newest = store->newestCalibration("R1", "white");
    ASSERT_TRUE(newest && *newest);
    EXPECT_EQ((*newest)->dateUtc, "new");
    EXPECT_EQ(read((*newest)->file), "new");
    EXPECT_FALSE(*store->newestCalibration("R3", "white"));
}

TEST(Store, OpenedToReadIsNotMade) {
    const test::TempFolder folder;
    const auto none = Store::openToRead(folder / "none");
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().kind, ErrorKind::File);
    EXPECT_NE(none.error().message.find("there is none"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder / "none"));
}

TEST_F(OpenStore, IsReadBesideItsWriter) {
    auto reader = Store::openToRead(folder.path());
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_FALSE(reader->find("late")->has_value());
    ASSERT_TRUE(add("late", "f"));
    EXPECT_TRUE(reader->find("late")->has_value());
}

TEST(Store, PlaceIsAbsoluteForThoseWhoWorkElsewhere) {
    const test::TempFolder folder;
    const auto store = Store::open(std::filesystem::relative(folder / "here"));
    ASSERT_TRUE(store) << store.error().message;
    EXPECT_EQ(store->root(), std::filesystem::weakly_canonical(folder / "here"));
}

TEST_F(OpenStore, IsSharedByTwoThatHaveItOpen) {
    auto other = Store::open(folder.path());
    ASSERT_TRUE(other);
    ASSERT_TRUE(add("a", "A"));
    EXPECT_EQ(read(other->sample("a")->file), "A");
}

TEST(SimState, SurvivesTheStore) {
    const test::TempFolder folder;
    const auto store = Store::open(folder.path());
    ASSERT_TRUE(store);
    ASSERT_EQ(readSimState(*store)->placed, "nothing");  // the defaults, before anything is kept
    const SimState state{.serial = "SIM-0042",
                         .seed = 0xFFFFFFFFFFFFFFFF,
                         .systematic = "stratum:3",
                         .placed = "model:lambert,albedo=0.5",
                         .wedge = {7_deg, -7_deg}};
    ASSERT_TRUE(writeSimState(*store, state));
    const auto read = readSimState(*store);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->serial, state.serial);
    EXPECT_EQ(read->seed, state.seed);
    EXPECT_EQ(read->systematic, state.systematic);
    EXPECT_EQ(read->placed, state.placed);
    EXPECT_DOUBLE_EQ(read->wedge.aboutX.value(), state.wedge.aboutX.value());
    EXPECT_DOUBLE_EQ(read->wedge.aboutY.value(), state.wedge.aboutY.value());
}

TEST(SimState, NamesItsBrokenFile) {
    const test::TempFolder folder;
    const auto store = Store::open(folder.path());
    ASSERT_TRUE(store);
    for (const std::string bad : {"", "{", "[]", "{\"schema\":\"gonio/sim/2\"}"}) {
        std::ofstream(store->simState()) << bad;
        const auto read = readSimState(*store);
        ASSERT_FALSE(read) << bad;
        EXPECT_EQ(read.error().kind, ErrorKind::File);
        EXPECT_NE(read.error().message.find("sim.json"), std::string::npos);
    }
}

TEST(SimBench, PlacesWhatTheStateNames) {
    const test::TempFolder folder;
    const auto store = Store::open(folder.path());
    ASSERT_TRUE(store);
    const auto role = [&](const std::string& placed) {
        SimState state;
        state.placed = placed;
        const auto placement = makePlacement(state, *store);
        EXPECT_TRUE(placement) << placement.error().message;
        EXPECT_EQ(placement->surface == nullptr,
                  placement->role == sim::Role::Nothing || placement->role == sim::Role::Mirror ||
                      placement->role == sim::Role::Zero);
        return placement->role;
    };
    EXPECT_EQ(role("nothing"), sim::Role::Nothing);
    EXPECT_EQ(role("mirror"), sim::Role::Mirror);
    EXPECT_EQ(role("white"), sim::Role::White);
    EXPECT_EQ(role("black"), sim::Role::Black);
    EXPECT_EQ(role("zero"), sim::Role::Zero);
    EXPECT_EQ(role("model:lambert,albedo=0.5"), sim::Role::Sample);
    SimState state;
    state.placed = "no-such-file.bsdf";
    EXPECT_EQ(makePlacement(state, *store).error().kind, ErrorKind::File);
}

TEST(SimBench, OpensTheRigThatTheStateDescribes) {
    const test::TempFolder folder;
    const auto store = Store::open(folder.path());
    ASSERT_TRUE(store);
    SimState state;
    state.serial = "SIM-0042";
    const auto door = openSim(state, *store);
    ASSERT_TRUE(door) << door.error().message;
    EXPECT_EQ((*door)->strings().serial, "SIM-0042");
    state.systematic = "whatever";
    EXPECT_EQ(openSim(state, *store).error().kind, ErrorKind::Usage);
}

}  // namespace
}  // namespace gonio::daemon
