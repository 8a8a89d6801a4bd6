#include "sim/vhci_cable.h"

#include <gtest/gtest.h>

namespace gonio::sim {
namespace {

constexpr const char* kStatus =
    "hub port sta spd dev      sockfd local_busid\n"
    "hs  0000 006 003 00010002 000003 1-1\n"
    "hs  0001 004 000 00000000 000000 0-0\n"
    "ss  0008 004 000 00000000 000000 0-0\n";

TEST(VhciCable, FindsAFreePortOfTheSpeed) {
    EXPECT_EQ(freeVhciPort(kStatus, "hs"), 1U);
    EXPECT_EQ(freeVhciPort(kStatus, "ss"), 8U);
    EXPECT_FALSE(freeVhciPort("", "hs"));
    EXPECT_FALSE(freeVhciPort("hs  0000 006 003 00010002 000003 1-1\n", "hs"));
    EXPECT_FALSE(freeVhciPort("hs  banana 004\nss\n\n", "hs"));
}

TEST(VhciCable, WithoutTheModuleItSaysHowToLoadIt) {
    if (std::filesystem::exists(vhciFolder())) GTEST_SKIP() << "the module is loaded";
    LiveRig rig({.errors = {}});
    const auto cable = VhciCable::attach(rig);
    ASSERT_FALSE(cable);
    EXPECT_EQ(cable.error().kind, ErrorKind::NoRig);
    EXPECT_NE(cable.error().message.find("modprobe vhci-hcd"), std::string::npos);
}

}  // namespace
}  // namespace gonio::sim
