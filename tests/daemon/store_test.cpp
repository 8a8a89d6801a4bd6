#include "daemon/store.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "daemon/sim_bench.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

TEST(Store, IsMadeWhereItWasAskedFor) {
    const test::TempFolder folder;
    const auto store = Store::open(folder / "a/b");
    ASSERT_TRUE(store) << store.error().message;
    EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b/samples"));
    EXPECT_EQ(store->rig("SIM-0001"), folder / "a/b/rigs/SIM-0001");
}

TEST(Store, RefusesAPlaceThatIsAFile) {
    const test::TempFolder folder;
    std::ofstream(folder / "file") << "x";
    const auto store = Store::open(folder / "file");
    ASSERT_FALSE(store);
    EXPECT_EQ(store.error().kind, ErrorKind::Busy);
    EXPECT_NE(store.error().message.find("--store"), std::string::npos);
}

TEST(Store, SampleNamesStayInsideTheStore) {
    const test::TempFolder folder;
    const auto store = Store::open(folder.path());
    ASSERT_TRUE(store);
    for (const std::string& good :
         {std::string("a"), std::string("Tile-7_b.2"), std::string("0"), std::string(64, 'x')}) {
        const auto path = store->sample(good, ".gonio");
        ASSERT_TRUE(path) << good;
        EXPECT_EQ(*path, folder / "samples" / (good + ".gonio"));
    }
    for (const std::string bad :
         {"", ".", "..", ".hidden", "-x", "_x", "a/b", "../x", "a b", "\xC3\xA4", "a\n"}) {
        const auto path = store->sample(bad, ".gonio");
        ASSERT_FALSE(path) << bad;
        EXPECT_EQ(path.error().kind, ErrorKind::Usage);
    }
    EXPECT_FALSE(store->sample(std::string(65, 'x'), ".gonio"));
}

TEST(Store, ListsSamplesByName) {
    const test::TempFolder folder;
    const auto store = Store::open(folder.path());
    ASSERT_TRUE(store);
    EXPECT_TRUE(store->sampleNames().empty());
    for (const std::string name : {"b.gonio", "a.gonio", "a.graw", "c.gonio.part"}) {
        std::ofstream(folder / "samples" / name) << "x";
    }
    EXPECT_EQ(store->sampleNames(), (std::vector<std::string>{"a", "b"}));
}

TEST(Store, SampleThatIsMeasuredAgainIsKept) {
    const test::TempFolder folder;
    const auto store = Store::open(folder.path());
    ASSERT_TRUE(store);
    const auto write = [&](const std::string& file, const std::string& text) {
        std::ofstream(folder / "samples" / file) << text;
    };
    const auto read = [&](const std::string& file) {
        std::ifstream in(folder / "samples" / file);
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    EXPECT_EQ(*store->setAside("a"), "");
    for (const std::string run : {"1", "2", "3"}) {
        write("a.gonio", "sample " + run);
        write("a.graw", "raw " + run);
        EXPECT_EQ(*store->setAside("a"), "a." + run);
        EXPECT_FALSE(std::filesystem::exists(folder / "samples/a.gonio"));
        EXPECT_FALSE(std::filesystem::exists(folder / "samples/a.graw"));
    }
    for (const std::string run : {"1", "2", "3"}) {
        EXPECT_EQ(read("a." + run + ".gonio"), "sample " + run);
        EXPECT_EQ(read("a." + run + ".graw"), "raw " + run);
    }
    write("a.graw", "raw alone");  // a run that died between its two files
    EXPECT_EQ(*store->setAside("a"), "a.4");
    EXPECT_EQ(read("a.4.graw"), "raw alone");
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
                         .wedge = {7_deg, -7_deg},
                         .nextPlanStep = 1ULL << 40};
    ASSERT_TRUE(writeSimState(*store, state));
    const auto read = readSimState(*store);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->serial, state.serial);
    EXPECT_EQ(read->seed, state.seed);
    EXPECT_EQ(read->systematic, state.systematic);
    EXPECT_EQ(read->placed, state.placed);
    EXPECT_DOUBLE_EQ(read->wedge.aboutX.value(), state.wedge.aboutX.value());
    EXPECT_DOUBLE_EQ(read->wedge.aboutY.value(), state.wedge.aboutY.value());
    EXPECT_EQ(read->nextPlanStep, state.nextPlanStep);
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
                  placement->role == sim::Role::Nothing || placement->role == sim::Role::Mirror);
        return placement->role;
    };
    EXPECT_EQ(role("nothing"), sim::Role::Nothing);
    EXPECT_EQ(role("mirror"), sim::Role::Mirror);
    EXPECT_EQ(role("white"), sim::Role::White);
    EXPECT_EQ(role("black"), sim::Role::Black);
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
