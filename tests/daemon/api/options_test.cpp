#include "daemon/api/options.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/formats/refusal.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

using test::refuses;

class DaemonOptionsFile : public testing::Test {
protected:
    Result<DaemonOptions> read(const std::string& text) {
        std::ofstream(folder / "goniod.toml") << text;
        return readDaemonOptions(folder / "goniod.toml");
    }
    test::TempFolder folder;
};

const std::string kSchema = "schema = \"gonio/goniod/1\"\n";

TEST_F(DaemonOptionsFile, SaysWhereEverythingIs) {
    const auto options =
        read(kSchema +
             "rig = \"usb:MD-7\"\nstore = \"/s\"\nsocket = \"/s/x.sock\"\n"
             "profile = \"/p.toml\"\nrecord = \"/r\"\nfaults = \"/f\"\ncomeback_seconds = 90\n");
    ASSERT_TRUE(options) << options.error().message;
    EXPECT_EQ(options->rig, "usb:MD-7");
    EXPECT_EQ(options->store, "/s");
    EXPECT_EQ(options->socket, "/s/x.sock");
    EXPECT_EQ(options->profile, "/p.toml");
    EXPECT_EQ(options->comebackSeconds, 90);
    EXPECT_EQ(options->record, "/r");
    EXPECT_EQ(options->faults, "/f");
}

TEST_F(DaemonOptionsFile, EveryKeyMayBeAbsent) {
    const auto options = read(kSchema);
    ASSERT_TRUE(options) << options.error().message;
    EXPECT_EQ(options->rig, "");
    EXPECT_FALSE(options->comebackSeconds);
    EXPECT_TRUE(options->store.empty());
}

TEST_F(DaemonOptionsFile, IsRefusedWithItsNameAndTheKey) {
    EXPECT_TRUE(refuses(read(""), {"goniod.toml", "schema", "gonio/goniod/1"}));
    EXPECT_TRUE(refuses(read("schema = \"gonio/goniod/2\"\n"), {"schema", "gonio/goniod/1"}));
    EXPECT_TRUE(refuses(read(kSchema + "rigs = \"sim\"\n"), {"goniod.toml", "'rigs'"}));
    EXPECT_TRUE(refuses(read(kSchema + "rig = 7\n"), {"'rig'", "a text"}));
    EXPECT_TRUE(refuses(read(kSchema + "comeback_seconds = -1\n"), {"'comeback_seconds'", "0"}));
    EXPECT_TRUE(refuses(read(kSchema + "[rig]\nname = \"sim\"\n"), {"'rig'"}));
    EXPECT_TRUE(refuses(read(kSchema + "rig = \n"), {"goniod.toml"}));
    EXPECT_TRUE(refuses(read("\xFF\xFE"), {"goniod.toml"}));
}

TEST_F(DaemonOptionsFile, ThatIsNotThereIsNamed) {
    EXPECT_TRUE(refuses(readDaemonOptions(folder / "none.toml"), {"none.toml"}));
}

TEST(DaemonOptions, CommandLineCountsOverTheFile) {
    const DaemonOptions line{.rig = "sim", .store = {}, .socket = "/a", .profile = {}};
    const DaemonOptions file{.rig = "usb", .store = "/s", .socket = "/b", .profile = {}};
    const DaemonOptions both = overlaid(line, file);
    EXPECT_EQ(both.rig, "sim");
    EXPECT_EQ(both.store, "/s");
    EXPECT_EQ(both.socket, "/a");
    EXPECT_TRUE(both.profile.empty());
}

TEST(RigChoice, IsTheSimulatedOneAnyOnUsbOrOneOfThem) {
    EXPECT_TRUE(parseRigChoice("sim")->simulated);
    EXPECT_FALSE(parseRigChoice("usb")->simulated);
    EXPECT_EQ(parseRigChoice("usb")->serial, std::nullopt);
    EXPECT_EQ(parseRigChoice("usb:MD-7")->serial, "MD-7");
    EXPECT_EQ(parseRigChoice("usb:a:b")->serial, "a:b");
    EXPECT_EQ(parseRigChoice("replay:/a b")->replay, "/a b");
    EXPECT_TRUE(parseRigChoice("usb")->replay.empty());
}

TEST(RigChoice, RecordingThatIsPlayedIsNotRecordedInto) {
    const test::TempFolder folder;
    const auto played = folder / "played";
    std::ofstream(played.string()) << "r";
    std::filesystem::create_symlink(played, folder / "link");
    const RigChoice replay{.replay = played};
    for (const auto& same : {played, folder / "link", folder / "." / "played"}) {
        const auto refused = checkRecord(replay, same);
        ASSERT_FALSE(refused) << same;
        EXPECT_EQ(refused.error().kind, ErrorKind::Usage);
        EXPECT_NE(refused.error().message.find(same.string()), std::string::npos);
    }
    EXPECT_TRUE(checkRecord(replay, folder / "another"));
    EXPECT_TRUE(checkRecord(replay, {}));
    EXPECT_TRUE(checkRecord(RigChoice{}, played));
}

TEST(RigChoice, AnythingElseIsAUsageErrorThatSaysWhatIsWanted) {
    for (const char* rig : {"", "usb:", "usb3", "replay:", "SIM", "sim "}) {
        const auto choice = parseRigChoice(rig);
        ASSERT_FALSE(choice) << rig;
        EXPECT_EQ(choice.error().kind, ErrorKind::Usage);
        EXPECT_NE(choice.error().message.find("usb:SERIAL"), std::string::npos);
    }
}

}  // namespace
}  // namespace gonio::daemon
