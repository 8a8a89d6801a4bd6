#include "daemon/engine/sim_port.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "daemon/profile.h"
#include "driver/rig.h"
#include "proc/formats/gonio_exr.h"
#include "tests/support/sample_sets.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

using namespace std::chrono_literals;

class SimPortInStore : public testing::Test {
protected:
    std::unique_ptr<SimPort> opened() {
        auto port = SimPort::open(folder.path());
        EXPECT_TRUE(port) << port.error().message;
        return port ? std::move(*port) : nullptr;
    }
    test::TempFolder folder;
};

ErrorKind refusal(const PlaceRequest& request) {
    const auto good = check(request);
    EXPECT_FALSE(good) << request.what;
    return good ? ErrorKind::Internal : good.error().kind;
}

TEST(PlaceRequest, NamesAReferenceAModelASampleOrAWholePath) {
    for (const char* what : {"nothing", "mirror", "white", "black", "model:x", "sample:x", "/a"}) {
        EXPECT_TRUE(check(PlaceRequest{.what = what})) << what;
    }
    for (const char* what : {"", "White", "a.bsdf", "../a", "models:x"}) {
        EXPECT_EQ(refusal({.what = what}), ErrorKind::Usage) << what;
    }
}

TEST(PlaceRequest, OnlyTheMirrorAndSamplesAreTiltedUpTo30Degrees) {
    EXPECT_TRUE(check(PlaceRequest{.what = "mirror", .tiltXDegrees = 30, .tiltYDegrees = -30}));
    EXPECT_TRUE(check(PlaceRequest{.what = "model:lambert", .tiltXDegrees = 1}));
    EXPECT_FALSE(check(PlaceRequest{.what = "white", .tiltXDegrees = 1}));
    EXPECT_TRUE(check(PlaceRequest{.what = "/a.bsdf", .tiltYDegrees = 1}));
    EXPECT_TRUE(check(PlaceRequest{.what = "white", .tiltXDegrees = -0.0}));
    for (const double tilt : {std::nextafter(30.0, 31.0),
                              std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_EQ(refusal({.what = "mirror", .tiltYDegrees = tilt}), ErrorKind::Usage) << tilt;
    }
}

TEST(PlaceRequest, WhatIsWrongWithASampleIsOfASampleAndWithinItsDomain) {
    EXPECT_TRUE(check(PlaceRequest{.what = "model:x",
                                   .wavinessDegrees = 10,
                                   .translucency = 1,
                                   .backing = "white",
                                   .softness = 1,
                                   .ambient = 1}));
    EXPECT_TRUE(check(
        PlaceRequest{.what = "/a", .wavinessDegrees = 1, .translucency = 0.1, .softness = 0.1}));
    EXPECT_TRUE(check(PlaceRequest{.what = "nothing", .ambient = 0.1}));
    for (const PlaceRequest& request : {PlaceRequest{.what = "white", .wavinessDegrees = 1},
                                        PlaceRequest{.what = "model:x", .wavinessDegrees = 11},
                                        PlaceRequest{.what = "white", .translucency = 0.1},
                                        PlaceRequest{.what = "mirror", .softness = 0.1},
                                        PlaceRequest{.what = "model:x", .translucency = -0.1},
                                        PlaceRequest{.what = "model:x", .backing = "grey"},
                                        PlaceRequest{.what = "model:x", .ambient = 2},
                                        PlaceRequest{.what = "model:x", .rigErrors = "blur"}}) {
        EXPECT_EQ(refusal(request), ErrorKind::Usage);
    }
}

TEST(PlaceRequest, SerialIs1To32PrintableCharacters) {
    const auto serial = [](const std::string& text) {
        return static_cast<bool>(check(PlaceRequest{.what = "white", .serial = text}));
    };
    EXPECT_TRUE(serial("S"));
    EXPECT_TRUE(serial(std::string(32, '~')));
    for (const std::string& bad : {std::string(),
                                   std::string(33, 'x'),
                                   std::string("a b"),
                                   std::string("a\n"),
                                   std::string("\x7F"),
                                   std::string("\xC3\xA9")}) {
        EXPECT_FALSE(serial(bad)) << bad;
    }
}

TEST_F(SimPortInStore, IsARigWithNothingUnderItAtFirst) {
    const auto port = opened();
    EXPECT_EQ(port->kind(), "sim");
    EXPECT_EQ(port->placed(), "nothing");
    EXPECT_EQ(port->simulated(), port.get());
    const auto rigs = port->list();
    ASSERT_EQ(rigs->size(), 1U);
    EXPECT_EQ(rigs->front().serial, "SIM-0001");
    EXPECT_EQ(rigs->front().kind, "sim");
    EXPECT_EQ(rigs->front().obstacle, "");
    const auto transport = port->open();
    ASSERT_TRUE(transport) << transport.error().message;
    EXPECT_EQ((*transport)->strings().serial, "SIM-0001");
}

TEST_F(SimPortInStore, WhatLiesUnderItIsStillThereAfterARestart) {
    {
        const auto port = opened();
        const auto another =
            port->place({.what = "mirror", .tiltXDegrees = 5, .seed = 7, .serial = "SIM-7"});
        ASSERT_TRUE(another) << another.error().message;
        EXPECT_TRUE(*another) << "another seed is another rig";
    }
    const auto port = opened();
    EXPECT_EQ(port->placed(), "mirror");
    EXPECT_EQ(port->list()->front().serial, "SIM-7");
    proc::SampleInfo info;
    port->describe(info);
    EXPECT_EQ(info.truthSpec, "mirror");
    EXPECT_EQ(info.extra.at("seed"), "7");
}

TEST_F(SimPortInStore, WhatIsWrongIsStillWrongAfterARestartAndAMeasurementSaysSo) {
    {
        const auto port = opened();
        const auto another = port->place({.what = "model:lambert,albedo=0.5",
                                          .tiltYDegrees = -2,
                                          .wavinessDegrees = 1.5,
                                          .translucency = 0.1,
                                          .backing = "white",
                                          .softness = 0.05,
                                          .ambient = 0.001,
                                          .rigErrors = "glare,crosstalk=0.02"});
        ASSERT_TRUE(another) << another.error().message;
        EXPECT_TRUE(*another) << "a rig with other errors is another rig";
    }
    proc::SampleInfo info;
    opened()->describe(info);
    EXPECT_EQ(info.extra.at("rig_errors"), "glare,crosstalk=0.02");
    EXPECT_EQ(info.extra.at("sample_errors"),
              "tilt_y_deg=-2,waviness_deg=1.5,translucency=0.1,backing=white,softness=0.05,"
              "ambient=0.001");
    // The next sample has nothing wrong; the rig's errors are kept.
    const auto port = opened();
    ASSERT_TRUE(port->place({.what = "model:lambert,albedo=0.5"}));
    proc::SampleInfo next;
    port->describe(next);
    EXPECT_FALSE(next.extra.contains("sample_errors"));
    EXPECT_EQ(next.extra.at("rig_errors"), "glare,crosstalk=0.02");
    ASSERT_TRUE(port->place({.what = "white", .rigErrors = "none"}));
    proc::SampleInfo none;
    port->describe(none);
    EXPECT_EQ(none.extra.size(), 2U) << "seed and rig, as ever";
}

TEST_F(SimPortInStore, AStateOfBeforeThereWereErrorsHasNone) {
    std::ofstream(folder / "sim.json")
        << R"({"schema":"gonio/sim/1","serial":"S","seed":3,"systematic":"none","placed":"white",)"
           R"("tilt_x_deg":0,"tilt_y_deg":0})";
    proc::SampleInfo info;
    opened()->describe(info);
    EXPECT_EQ(info.extra.size(), 2U);
    EXPECT_EQ(info.extra.at("seed"), "3");
}

TEST(SimTruth, IsTheMixtureThatCrosstalkMakesAndNothingElseChangesIt) {
    const LightView pair{Direction::fromSpherical(20_deg, 0_deg), Direction()};
    const auto truth = [&](SimState state) {
        state.placed = "model:lambert,albedo=0.9/0.3/0.1";
        proc::SampleInfo info;
        describe(state, info);
        const auto surface = truthOf(info, {});
        EXPECT_TRUE(surface) << surface.error().message;
        return (*surface)->answer(pair).f;
    };
    const LedBands pure = truth({});
    EXPECT_NEAR(pure[Band::R] * kPi, 0.9, 1e-12);
    EXPECT_EQ(truth({.wedge = {1_deg, 2_deg},
                     .rigErrors = "glare=0.01,inl,offset_us=14,source_deg",
                     .sampleErrors = {.waviness = 1_deg,
                                      .translucency = 0.2,
                                      .backing = sim::Backing::White,
                                      .softness = 0.1,
                                      .ambient = 0.1}}),
              pure);
    const LedBands mixed = truth({.rigErrors = "typical,crosstalk=0.1"});
    EXPECT_NEAR(mixed[Band::R] * kPi, 0.9 - 0.1 * 0.6, 1e-12);
    EXPECT_NEAR(mixed[Band::G] * kPi, 0.3 + 0.1 * (0.5 - 0.3), 1e-12);
    EXPECT_NEAR(mixed[Band::B] * kPi, 0.1 + 0.1 * 0.2, 1e-12);
}

TEST(SimTruth, OfAReferenceOrARealRigIsNotKnown) {
    for (const char* placed : {"", "white", "black", "mirror", "nothing"}) {
        const auto truth = truthOf({.truthSpec = placed}, {});
        ASSERT_FALSE(truth) << placed;
        EXPECT_EQ(truth.error().kind, ErrorKind::Usage);
    }
}

TEST_F(SimPortInStore, AnotherSurfaceIsNotAnotherRig) {
    const auto port = opened();
    ASSERT_TRUE(port->open());
    const auto another = port->place({.what = "model:lambert,albedo=0.5"});
    ASSERT_TRUE(another) << another.error().message;
    EXPECT_FALSE(*another);
    EXPECT_EQ(port->placed(), "model:lambert,albedo=0.5");
    EXPECT_EQ(port->list()->front().serial, "SIM-0001") << "empty members are kept as they are";
}

TEST_F(SimPortInStore, WhatIsWrongIsSaidAtOnceAndChangesNothing) {
    const auto port = opened();
    EXPECT_EQ(port->place({.what = "model:lambret"}).error().kind, ErrorKind::Usage);
    EXPECT_EQ(port->place({.what = "sample:none"}).error().kind, ErrorKind::File);
    EXPECT_EQ(port->place({.what = (folder / "none.bsdf").string()}).error().kind, ErrorKind::File);
    EXPECT_EQ(port->place({.what = "white", .systematic = "some"}).error().kind, ErrorKind::Usage);
    EXPECT_EQ(port->place({.what = "model:lambret", .serial = "SIM-9"}).error().kind,
              ErrorKind::Usage);
    EXPECT_EQ(port->placed(), "nothing");
    EXPECT_EQ(port->list()->front().serial, "SIM-0001");
    EXPECT_FALSE(std::filesystem::exists(folder / "sim.json"));
}

TEST_F(SimPortInStore, SampleOfTheStoreIsPlacedByWhatItHoldsNotByItsName) {
    auto store = Store::open(folder.path());
    ASSERT_TRUE(store) << store.error().message;
    const auto sample = test::sampleSet([](Radians, const Direction&) { return 0.2; });
    ASSERT_TRUE(store->addSample({.name = "tile", .rig = "R", .dateUtc = "t"},
                                 {.file = *proc::encodeGonio(sample), .raw = {}}));
    const auto port = opened();
    const auto placed = port->place({.what = "sample:tile"});
    ASSERT_TRUE(placed) << placed.error().message;
    EXPECT_EQ(port->placed(), std::filesystem::absolute(store->sample("tile")->file).string());
}

TEST_F(SimPortInStore, ATableIsTiltedWhereItAnswers) {
    const auto port = opened();
    ASSERT_NE(port, nullptr);
    const auto table = configDirectory() / "demo" / "AnoBlackEC1onAlum.bsdf";
    const auto placed = port->place({.what = table.string(), .tiltXDegrees = 2, .tiltYDegrees = 4});
    EXPECT_TRUE(placed) << placed.error().message;
    // 60 degrees and 12 more: the table ends at 70.
    const auto beyond = port->place({.what = table.string(), .tiltYDegrees = -12});
    ASSERT_FALSE(beyond);
    EXPECT_EQ(beyond.error().kind, ErrorKind::Usage);
    EXPECT_NE(beyond.error().message.find("LED 3 is 72.00 degrees"), std::string::npos)
        << beyond.error().message;
    // A model is lit from anywhere, or from below its horizon and not at all.
    for (const double tilt : {-30.0, -29.0, 30.0})
        EXPECT_TRUE(port->place({.what = "model:lambert,albedo=0.5", .tiltYDegrees = tilt}));
    // A measured sample answers between the incidences of its LEDs.
    const auto bytes =
        proc::encodeGonio(gonio::test::sampleSet([](Radians, const Direction&) { return 0.2; }));
    ASSERT_TRUE(bytes) << bytes.error().message;
    const auto file = folder / "flat.gonio";
    std::ofstream(file, std::ios::binary) << *bytes;
    EXPECT_TRUE(port->place({.what = file.string()}));
    EXPECT_TRUE(port->place({.what = file.string(), .tiltYDegrees = 3}));
    EXPECT_FALSE(port->place({.what = file.string(), .tiltYDegrees = -3}));
}

TEST_F(SimPortInStore, MirrorGoesUnderAnOpenRigOnly) {
    const auto port = opened();
    const auto refused = port->placeMirror(proc::mirrorWedges().front());
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::NoRig);
    ASSERT_TRUE(port->open());
    const auto placed = port->placeMirror(proc::mirrorWedges().front());
    ASSERT_TRUE(placed) << placed.error().message;
    EXPECT_TRUE(*placed) << "no person has to do it";
    port->close();
    EXPECT_FALSE(port->placeMirror(proc::mirrorWedges().front()));
}

/// Until its cable is pulled.
void listenTo(driver::Transport& rig) {
    for (int reports = 0; reports < 1000; ++reports) {
        if (!rig.readInput(100ms)) return;
    }
    ADD_FAILURE() << "nobody has pulled its cable";
}

struct Look {
    std::uint32_t boot = 0;
    Image<std::uint16_t> picture;
};

/// At what lies under it, by the light of its first LED.
Look lookAt(driver::Transport& transport) {
    auto rig = driver::Rig::open(transport, 0x1122334455667788);
    EXPECT_TRUE(rig) << rig.error().message;
    if (!rig) return {};
    EXPECT_TRUE(rig->configure({.x = 0, .y = 0, .size = rig->identify().sensor}));
    auto taken = rig->capture({.planStep = 1,
                               .led = 0,
                               .levels = LedLevels::only(Band::G, 65535),
                               .exposure = Microseconds(1000)});
    EXPECT_TRUE(taken) << taken.error().message;
    if (!taken) return {};
    return {.boot = rig->bootId(), .picture = std::move(taken->frames.front().pixels)};
}

/// The next look for it that finds it is this one.
driver::Transport* foundAtLook(int wanted, SimPort& port) {
    port.close();
    for (int look = 1; look < wanted; ++look) {
        const auto missed = port.open();
        EXPECT_TRUE(!missed && missed.error().kind == ErrorKind::NoRig) << "look " << look;
    }
    const auto there = port.open();
    EXPECT_TRUE(there) << there.error().message;
    return there ? *there : nullptr;
}

void play(SimPort& port, const std::string& text) {
    auto script = sim::FaultScript::parse(text);
    ASSERT_TRUE(script) << script.error().message;
    port.play(std::move(*script));
}

TEST_F(SimPortInStore, RigThatIsPluggedInAgainIsTheSameWithWhatLiesUnderIt) {
    const auto port = opened();
    ASSERT_TRUE(port->place({.what = "mirror", .systematic = "none"}));
    play(*port, "at 5s unplug for 1200ms\nat 20s lose power for 700ms");
    const auto transport = port->open();
    ASSERT_TRUE(transport) << transport.error().message;
    ASSERT_TRUE(port->placeMirror(proc::mirrorWedges().back()));
    const Look first = lookAt(**transport);
    const auto pixels = first.picture.pixels();
    ASSERT_GT(*std::max_element(pixels.begin(), pixels.end()), 1000) << "else nothing is seen";
    listenTo(**transport);
    driver::Transport* there = foundAtLook(3, *port);  // 500 ms each
    ASSERT_NE(there, nullptr);
    const Look unplugged = lookAt(*there);
    EXPECT_EQ(unplugged.boot, first.boot);
    EXPECT_EQ(unplugged.picture, first.picture);
    listenTo(*there);
    there = foundAtLook(2, *port);
    ASSERT_NE(there, nullptr);
    const Look powerless = lookAt(*there);
    EXPECT_NE(powerless.boot, first.boot);
    EXPECT_EQ(powerless.picture, first.picture);
}

TEST_F(SimPortInStore, AnotherRigAtItsCableIsRefusedAndBothAreNamed) {
    const auto port = opened();
    play(*port, "at 1s plug as OTHER-1 for 700ms");
    const auto transport = port->open();
    ASSERT_TRUE(transport) << transport.error().message;
    listenTo(**transport);
    port->close();
    const auto refused = port->open();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::NoRig);
    for (const char* serial : {"SIM-0001", "OTHER-1"})
        EXPECT_NE(refused.error().message.find(serial), std::string::npos)
            << refused.error().message;
    const auto there = port->open();
    ASSERT_TRUE(there) << there.error().message;
    EXPECT_EQ((*there)->strings().serial, "SIM-0001");
}

TEST_F(SimPortInStore, AnotherRigThatIsAskedForIsThereThoughTheFirstWasUnplugged) {
    const auto port = opened();
    play(*port, "at 1s unplug");
    const auto transport = port->open();
    ASSERT_TRUE(transport) << transport.error().message;
    listenTo(**transport);
    port->close();
    EXPECT_FALSE(port->open());
    const auto placed = port->place({.what = "white"});
    ASSERT_TRUE(placed) << placed.error().message;
    EXPECT_FALSE(*placed);
    EXPECT_FALSE(port->open()) << "another surface is not another rig";
    ASSERT_TRUE(port->place({.what = "white", .serial = "SIM-2"}));
    const auto there = port->open();
    ASSERT_TRUE(there) << there.error().message;
    EXPECT_EQ((*there)->strings().serial, "SIM-2");
}

TEST_F(SimPortInStore, BrokenStateIsRefusedAndNamed) {
    {
        const auto port = opened();
        ASSERT_TRUE(port->place({.what = "white"}));
    }
    const std::string kept = R"({"schema":"gonio/sim/1","serial":"S","seed":3,"placed":"white",)"
                             R"("systematic":"none","tilt_x_deg":0,"tilt_y_deg":0,)";
    for (const std::string& text : {std::string(),
                                    std::string("[]"),
                                    std::string("{\"schema\":\"gonio/sim/2\"}"),
                                    std::string("\xFF"),
                                    kept + R"("softness":2})",
                                    kept + R"("rig_errors":7})"}) {
        std::ofstream(folder / "sim.json") << text;
        const auto port = SimPort::open(folder.path());
        ASSERT_FALSE(port) << text;
        EXPECT_EQ(port.error().kind, ErrorKind::File);
        EXPECT_NE(port.error().message.find("sim.json"), std::string::npos);
    }
}

}  // namespace
}  // namespace gonio::daemon
