// The simulated rig's own door: what lies under it, and how far a measurement is from its truth.

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/cli/commands.h"
#include "daemon/cli/score.h"
#include "daemon/material.h"
#include "daemon/sim_bench.h"
#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/gonio_exr.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

std::string percent(double fraction) { return fixed(100 * fraction, 2) + " %"; }

std::string padded(const std::string& text, std::size_t width) {
    return text.size() >= width ? text : text + std::string(width - text.size(), ' ');
}

/// Everything of the sample that lies beside its .gonio.
std::vector<std::string> filesOf(const fs::path& gonio) {
    std::vector<std::string> files;
    std::error_code ignored;
    const std::string stem = gonio.stem().string();
    const fs::path folder = gonio.has_parent_path() ? gonio.parent_path() : fs::path(".");
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        const std::string name = entry.path().filename().string();
        if (!entry.is_regular_file()) continue;
        if (name.starts_with(stem + ".") || name.starts_with(stem + "_")) {
            files.push_back((gonio.parent_path() / name).string());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace

Result<void> simPlace(const CommonOptions& common, const PlaceOptions& options) {
    const Result<Store> store = Store::open(common.store);
    if (!store) return store.error();
    Result<SimState> state = readSimState(*store);
    if (!state) return state.error();
    if (options.seed) state->seed = *options.seed;
    if (options.serial) state->serial = *options.serial;
    if (options.systematic) state->systematic = *options.systematic;
    state->placed = options.what;
    const bool file = options.what.find(':') == std::string::npos && options.what != "nothing" &&
                      options.what != "mirror" && options.what != "white" &&
                      options.what != "black";
    if (file) state->placed = fs::absolute(options.what).string();  // found from any folder later
    state->wedge = {.aboutX = Radians::fromDegrees(options.tiltXDegrees),
                    .aboutY = Radians::fromDegrees(options.tiltYDegrees)};
    // Opening it now tells at once what is wrong with it.
    const auto rig = openSim(*state, *store);
    if (!rig) return rig.error();
    if (Result<void> kept = writeSimState(*store, *state); !kept) return kept;
    if (common.json) {
        std::cout << Json{{"schema", "gonio/sim-place/1"},
                          {"serial", state->serial},
                          {"placed", options.what},
                          {"tilt_x_deg", options.tiltXDegrees},
                          {"tilt_y_deg", options.tiltYDegrees}}
                         .dump(2)
                  << "\n";
    } else if (!common.quiet) {
        std::cout << "under the simulated rig " << state->serial << ": " << options.what << "\n";
    }
    return {};
}

Result<void> simScore(const CommonOptions& common, const ScoreOptions& options) {
    Json samples = Json::array();
    std::uint64_t seed = 0;
    if (!common.json) {
        std::cout << padded("sample", 18) << padded("rig s", 8) << padded("compute s", 11)
                  << padded("median error", 14) << padded("95 % error", 12)
                  << padded("within 2u", 11) << "cells\n";
    }
    for (const fs::path& file : options.files) {
        const Result<proc::SampleSet> sample = proc::readGonio(file);
        if (!sample) return sample.error();
        const proc::SampleInfo& info = sample->info;
        if (info.truthSpec.empty()) {
            return Error{ErrorKind::Usage,
                         file.string() + ": its truth is not known: it is not of a simulated rig"};
        }
        const Result<Material> truth = openMaterial(info.truthSpec, common.store);
        if (!truth) return truth.error();
        const Score result = score(*sample, *truth->scatterer);
        if (info.extra.contains("seed")) {
            seed = static_cast<std::uint64_t>(parseInteger(info.extra.at("seed")).value_or(0));
        }
        samples.push_back({{"name", info.name},
                           {"rig_seconds", info.rigSeconds},
                           {"compute_seconds", info.computeSeconds},
                           {"median_relative_error", result.medianRelativeError},
                           {"p95_relative_error", result.p95RelativeError},
                           {"within_2u", result.within2u},
                           {"within_2u_random", result.within2uRandom},
                           {"cells", result.cells},
                           {"files", filesOf(file)}});
        if (!common.json) {
            std::cout << padded(info.name, 18) << padded(fixed(info.rigSeconds, 1), 8)
                      << padded(fixed(info.computeSeconds, 1), 11)
                      << padded(percent(result.medianRelativeError), 14)
                      << padded(percent(result.p95RelativeError), 12)
                      << padded(percent(result.within2u), 11) << result.cells << "\n";
        }
    }
    const Json summary = {{"schema", "gonio/quickstart/1"}, {"seed", seed}, {"samples", samples}};
    if (common.json) std::cout << summary.dump(2) << "\n";
    if (options.output.empty()) return {};
    return proc::writeFile(options.output, summary.dump(2) + "\n");
}

}  // namespace gonio::daemon
