#pragma once
// The commands of the `gonio` program, one function each. Data go to stdout, or where an option
// says; progress and logs go to stderr. An Error's kind becomes the exit code.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "proc/core/effort.h"
#include "proc/core/result.h"

namespace gonio::daemon {

struct CommonOptions {
    bool json = false;
    bool quiet = false;
    std::filesystem::path store;  ///< empty: the default place
};

struct PlaceOptions {
    std::string what;         ///< black, white, mirror, nothing, or F
    double tiltXDegrees = 0;  ///< turns the surface about x
    double tiltYDegrees = 0;
    std::optional<std::uint64_t> seed;
    std::optional<std::string> serial;
    std::optional<std::string> systematic;  ///< none, random, or stratum:K
};
Result<void> simPlace(const CommonOptions& common, const PlaceOptions& options);

struct ScoreOptions {
    std::vector<std::filesystem::path> files;
    std::filesystem::path output;  ///< summary.json; empty: none
};
/// Holds measured samples of the simulated rig against its truth.
Result<void> simScore(const CommonOptions& common, const ScoreOptions& options);

enum class Reference {
    Mirror,
    Black,
    White
};
struct CalibrateOptions {
    Reference reference = Reference::Mirror;
    std::filesystem::path profile;  ///< empty: config/rigs/minidiff-usb2.toml
};
Result<void> calibrate(const CommonOptions& common, const CalibrateOptions& options);

struct MeasureOptions {
    std::string name;
    Effort effort = Effort::Standard;
    std::string notes;
    std::filesystem::path output;  ///< a copy of the .gonio; empty: the store only
    std::filesystem::path profile;
};
Result<void> measure(const CommonOptions& common, const MeasureOptions& options);

Result<void> info(const CommonOptions& common, const std::string& file);

struct EvalOptions {
    std::string file;
    std::filesystem::path points;
    std::filesystem::path output;  ///< empty: stdout
};
Result<void> eval(const CommonOptions& common, const EvalOptions& options);

struct ConvertOptions {
    std::string input;
    std::filesystem::path output;
    std::string to;  ///< zemax, csv, gonio; empty: by the output's extension
};
Result<void> convert(const CommonOptions& common, const ConvertOptions& options);

struct PlotOptions {
    std::string file;
    std::filesystem::path output;  ///< a folder; empty: the working folder
};
Result<void> plot(const CommonOptions& common, const PlotOptions& options);

}  // namespace gonio::daemon
