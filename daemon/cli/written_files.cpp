#include "daemon/cli/written_files.h"

#include <iostream>
#include <nlohmann/json.hpp>

#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

Json lossJson(const proc::LossReport::Item& item) {
    Json json = {{"kind", name(item.kind)}, {"what", item.what}, {"count", item.count}};
    if (item.largestError) json["largest_error"] = *item.largestError;
    if (item.weightedError) json["weighted_error"] = *item.weightedError;
    return json;
}

}  // namespace

std::string lossText(const proc::LossReport::Item& item) {
    std::string text =
        std::string(name(item.kind)) + ": " + std::to_string(item.count) + " " + item.what;
    if (item.largestError) text += ", largest error " + perCent(*item.largestError);
    if (item.weightedError) text += ", weighted " + perCent(*item.weightedError);
    return text;
}

Result<void> writeConverted(const CommonOptions& common,
                            const std::vector<proc::ConvertedFile>& converted,
                            const fs::path& output,
                            Json& files) {
    for (const proc::ConvertedFile& one : converted) {
        fs::path file = output;
        file.replace_filename(output.stem().string() + one.suffix + output.extension().string());
        if (Result<void> done = proc::writeFile(file, one.bytes); !done) return done;
        Json lost = Json::array();
        for (const auto& item : one.loss.items) {
            lost.push_back(lossJson(item));
            if (!common.quiet) std::cerr << file.string() << ": " << lossText(item) << "\n";
        }
        if (one.loss.items.empty() && !common.quiet) {
            std::cerr << file.string() << ": nothing lost\n";
        }
        files.push_back({{"file", file.string()}, {"lost", lost}});
    }
    return {};
}

}  // namespace gonio::daemon
