// gonio atlas: several samples as one picture for shaders.

#include <nlohmann/json.hpp>

#include "daemon/cli/commands.h"
#include "daemon/cli/output.h"
#include "daemon/cli/written_files.h"
#include "daemon/conversion_input.h"
#include "proc/export/atlas.h"

namespace gonio::daemon {

Result<void> atlas(const CommonOptions& common, const AtlasOptions& options) {
    proc::ConversionWish wish{.to = proc::Format::ExrAtlas, .half = options.half};
    if (!options.grid.empty()) {
        auto grid = proc::parseTargetGrid(options.grid);
        if (!grid) return grid.error().in("atlas");
        wish.grid = std::move(*grid);
    }
    std::vector<proc::ConversionSource> sources;
    for (const std::string& f : options.files) {
        auto opened = openConversion({.f = f, .estimator = options.estimator}, common.store);
        if (!opened) return opened.error().in("atlas");
        sources.push_back(std::move(opened->source));
    }
    if (!wish.grid.incidenceDeg && !sources.empty()) {
        wish.grid.incidenceDeg = sources.front().incidenceDeg;
    }
    Result<proc::Written> written = proc::atlasOf(sources, wish);
    if (!written) return written.error().in("atlas");
    nlohmann::ordered_json files = nlohmann::ordered_json::array();
    auto done = writeConverted(
        common, {{"", std::move(written->bytes), std::move(written->loss)}}, options.output, files);
    if (!done) return done;
    if (common.json) printJson({{"schema", "gonio/atlas/1"}, {"files", files}});
    return {};
}

}  // namespace gonio::daemon
