#include "daemon/problem.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/support/error_kinds.h"

namespace gonio::daemon {
namespace {

using test::kErrorKinds;

TEST(Problem, EveryKindComesBackFromItsName) {
    std::set<std::string> names;
    for (const ErrorKind kind : kErrorKinds) {
        const std::string name(problemName(kind));
        EXPECT_EQ(problemKind(name), kind) << name;
        EXPECT_EQ(exitCode(problemKind(name)), exitCode(kind)) << name;
        names.insert(name);
    }
    EXPECT_EQ(names.size(), std::size(kErrorKinds)) << "two kinds share a name";
}

TEST(Problem, NamesAreThoseOfTheApi) {
    // Clients and logbooks hold these words: they never change.
    EXPECT_EQ(problemName(ErrorKind::NoRig), "no-rig");
    EXPECT_EQ(problemName(ErrorKind::Usage), "usage");
    EXPECT_EQ(problemName(ErrorKind::Interrupted), "interrupted");
}

TEST(Problem, UnknownWordIsInternal) {
    for (const char* word : {"", "Usage", "usage ", "urn:gonio:problem:usage"}) {
        EXPECT_EQ(problemKind(word), ErrorKind::Internal) << word;
    }
}

}  // namespace
}  // namespace gonio::daemon
