#include "daemon/material.h"

#include <algorithm>

#include "daemon/store.h"
#include "proc/formats/open.h"
#include "proc/models/spec.h"
#include "proc/table/sample_lookup.h"
#include "proc/table/specular_lookup.h"

namespace gonio::daemon {
namespace {

constexpr std::string_view kModel = "model:";
constexpr std::string_view kSample = "sample:";

}  // namespace

std::vector<Radians> Material::incidences() const {
    std::vector<Radians> all;
    if (sample != nullptr) {
        for (const proc::LedTable& led : sample->leds) {
            if (std::find(all.begin(), all.end(), led.incidence) == all.end())
                all.push_back(led.incidence);
        }
    } else if (table != nullptr) {
        for (double degrees : table->incidenceDeg) all.push_back(Radians::fromDegrees(degrees));
    } else {
        all = {0_deg, 20_deg, 40_deg, 60_deg};
    }
    return all;
}

bool isStored(const std::string& f) { return f.starts_with(kSample); }

Result<std::filesystem::path> fileOf(const std::string& f, const std::filesystem::path& store) {
    if (f.starts_with(kModel)) {
        return Error{ErrorKind::Usage, "'" + f + "' is a formula; wanted a file or sample:NAME"};
    }
    if (!isStored(f)) return std::filesystem::path(f);
    Result<Store> opened = Store::openToRead(store);
    if (!opened) return opened.error();
    auto record = opened->sample(f.substr(kSample.size()));
    if (!record) return record.error();
    return std::move(record->file);
}

Result<Material> openMaterial(const std::string& f,
                              const std::filesystem::path& store,
                              proc::EvalPath path) {
    if (f.starts_with(kModel)) {
        auto model = proc::makeModel(std::string_view(f).substr(kModel.size()), path);
        if (!model) return model.error();
        return Material{.kind = "model", .scatterer = std::move(*model)};
    }
    const Result<std::filesystem::path> file = fileOf(f, store);
    if (!file) return file.error();
    Result<std::unique_ptr<const Scatterer>> brdf = proc::openBrdf(*file);
    if (!brdf) return brdf.error();
    Material material{.kind = "file", .scatterer = std::move(*brdf)};
    if (const auto* sample = dynamic_cast<const proc::SampleLookup*>(material.scatterer.get())) {
        material.kind = "gonio";
        material.sample = &sample->set();
    }
    if (const auto* table = dynamic_cast<const proc::SpecularLookup*>(material.scatterer.get())) {
        material.kind = "zemax";
        material.table = &table->table();
    }
    return material;
}

}  // namespace gonio::daemon
