// How far a measurement of the simulated rig is from its truth.

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/cli/commands.h"
#include "daemon/cli/output.h"
#include "daemon/score.h"
#include "daemon/sim_bench.h"
#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/gonio_exr.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

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

/// A measured sample held against its truth.
struct Scored {
    fs::path file;
    proc::SampleInfo info;
    Score score;
};

Result<Scored> scoreFile(const fs::path& file, const fs::path& store) {
    const Result<proc::SampleSet> sample = proc::readGonio(file);
    if (!sample) return sample.error();
    const auto truth = truthOf(sample->info, store);
    if (!truth) return truth.error().in(file.string());
    return Scored{file, sample->info, score(*sample, **truth)};
}

/// The document of the quickstart.
Json summaryOf(const std::vector<Scored>& scored) {
    Json samples = Json::array();
    std::int64_t seed = 0;
    for (const auto& [file, info, score] : scored) {
        if (const auto kept = info.extra.find("seed"); kept != info.extra.end()) {
            seed = parseInteger(kept->second).value_or(0);
        }
        samples.push_back({{"name", info.name},
                           {"rig_seconds", info.rigSeconds},
                           {"compute_seconds", info.computeSeconds},
                           {"median_relative_error", score.medianRelativeError},
                           {"p95_relative_error", score.p95RelativeError},
                           {"within_2u", score.within2u},
                           {"cells", score.cells},
                           {"files", filesOf(file)}});
    }
    return {{"schema", "gonio/quickstart/1"}, {"seed", seed}, {"samples", samples}};
}

/// The same, and the share that noise alone explains.
Json scoresOf(const std::vector<Scored>& scored) {
    Json json = summaryOf(scored);
    json["schema"] = "gonio/sim-score/1";
    for (std::size_t i = 0; i < scored.size(); ++i) {
        json["samples"][i]["within_2u_random"] = scored[i].score.within2uRandom;
    }
    return json;
}

void printTable(const std::vector<Scored>& scored) {
    std::cout << padded("sample", 18) << padded("rig s", 8) << padded("compute s", 11)
              << padded("median error", 14) << padded("95 % error", 12) << padded("within 2u", 11)
              << "cells\n";
    for (const auto& [file, info, score] : scored) {
        std::cout << padded(info.name, 18) << padded(fixed(info.rigSeconds, 1), 8)
                  << padded(fixed(info.computeSeconds, 1), 11)
                  << padded(perCent(score.medianRelativeError), 14)
                  << padded(perCent(score.p95RelativeError), 12)
                  << padded(perCent(score.within2u), 11) << score.cells << "\n";
    }
}

}  // namespace

Result<void> simScore(const CommonOptions& common, const ScoreOptions& options) {
    std::vector<Scored> scored;
    for (const fs::path& file : options.files) {
        Result<Scored> one = scoreFile(file, common.store);
        if (!one) return one.error();
        scored.push_back(std::move(*one));
    }
    if (common.json) {
        printJson(scoresOf(scored));
    } else {
        printTable(scored);
    }
    if (options.output.empty()) return {};
    return proc::writeFile(
        options.output,
        summaryOf(scored).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace gonio::daemon
