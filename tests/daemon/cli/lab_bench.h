#pragma once
// A laboratory's bench, by its command line: a daemon on the simulated rig, its store, and commands
// that must succeed.

#include "tests/daemon/cli/documents.h"
#include "tests/daemon/cli/running_daemon.h"

namespace gonio::test {

using Json = nlohmann::json;

/// A daemon's arguments for a simulated rig by the usual profile, but with these exposures,
/// microseconds. Two of the six, "[20, 320]", take half of the time.
inline std::vector<std::string> simExposing(const std::string& exposures, const Program& program) {
    std::string text = textOf(GONIO_SOURCE_DIR "/config/rigs/minidiff-usb2.toml");
    const std::string key = "exposures_us = ";
    const std::size_t at = text.find(key);
    EXPECT_NE(at, std::string::npos);
    text.replace(at, text.find('\n', at) - at, key + exposures);
    const std::string file = program / "rig.toml";
    writeText(file, text);
    return {"--rig", "sim", "--profile", file};
}

class Bench {
public:
    Bench() : daemon(program) {}
    explicit Bench(const std::string& exposures)
        : daemon(program, simExposing(exposures, program)) {}

    /// Runs a command that must succeed; its JSON.
    Json operator()(std::vector<std::string> arguments) const {
        return documentOf(program, std::move(arguments));
    }
    void calibrate(const std::string& systematic, int seed) const {
        place("mirror", systematic, seed);
        const Json mirror = (*this)({"calibrate", "mirror"});
        EXPECT_EQ(mirror["schema"], "gonio/calibrate-mirror/1");
        EXPECT_EQ(mirror["spots"], 33);
        EXPECT_LT(mirror["rms_px"], 0.1);
        place("black", systematic, seed);
        (*this)({"calibrate", "black"});
        place("white", systematic, seed);
        const Json white = (*this)({"calibrate", "white"});
        // 1 where noise alone differs between the exposures of a bracket: some 1e7 degrees of
        // freedom, so that the spread is far below what is allowed for the noise model.
        EXPECT_NEAR(white["chi_square_per_freedom"], 1, 0.01);
    }
    Program program;
    RunningDaemon daemon;

private:
    void place(const std::string& what, const std::string& systematic, int seed) const {
        (*this)({"sim",
                 "place",
                 what,
                 "--seed",
                 std::to_string(seed),
                 "--systematic",
                 systematic,
                 "--serial",
                 "SIM-" + std::to_string(1000 + seed)});
    }
};

/// The bounds on the error of one sample.
inline void expectAccurate(const Json& sample) {
    EXPECT_LE(sample["median_relative_error"], 0.015) << sample;
    EXPECT_LE(sample["p95_relative_error"], 0.06) << sample;
    EXPECT_GT(sample["cells"], 40'000) << sample;
}

}  // namespace gonio::test
