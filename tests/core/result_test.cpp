#include "proc/core/result.h"

#include <gtest/gtest.h>

#include <memory>

namespace gonio {
namespace {

TEST(Result, GivesAwayAValueThatOnlyMoves) {
    Result<std::unique_ptr<int>> made = std::make_unique<int>(7);
    ASSERT_TRUE(made.has_value());
    EXPECT_EQ(**made, 7);
    const std::unique_ptr<int> taken = *std::move(made);
    EXPECT_EQ(*taken, 7);
}

TEST(Result, ReachesIntoItsValue) {
    Result<std::string> text = std::string("abc");
    EXPECT_EQ(text->size(), 3U);
    text.value() += "d";
    const Result<std::string>& constant = text;
    EXPECT_EQ(constant.value(), "abcd");
    EXPECT_EQ(constant->size(), 4U);
}

TEST(Result, AnErrorTypeOfItsOwnIsNoValue) {
    const Result<std::string> bad = Error{ErrorKind::Busy, "rig: held"};
    EXPECT_FALSE(bad.has_value());
    EXPECT_EQ(bad.error().kind, ErrorKind::Busy);
}

TEST(Error, KeepsKindAndStatusInItsContext) {
    const Error error{ErrorKind::Device, "BAD_ARG", 101};
    const Error outer = error.in("SET_LED").in("capture");
    EXPECT_EQ(outer.message, "capture: SET_LED: BAD_ARG");
    EXPECT_EQ(outer.kind, ErrorKind::Device);
    EXPECT_EQ(outer.deviceStatus, 101);
    const Result<void> failed = outer;
    ASSERT_FALSE(failed.has_value());
    EXPECT_EQ(failed.error().deviceStatus, 101);
}

}  // namespace
}  // namespace gonio
