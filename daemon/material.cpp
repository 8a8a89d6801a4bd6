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
    std::vector<Radians> known;
    if (file) known = proc::incidencesOf(*file);
    if (known.empty() || known.size() > proc::kMostFileIncidences)
        return {0_deg, 20_deg, 40_deg, 60_deg};
    return known;
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

Result<Material> materialOf(proc::BrdfFile file) {
    Material material{.kind = std::string(proc::name(file.format))};
    material.file = std::make_shared<const proc::BrdfFile>(std::move(file));
    Result<std::unique_ptr<const Scatterer>> lookup = proc::lookupOver(*material.file);
    if (!lookup) return lookup.error();
    material.scatterer = std::move(*lookup);
    if (const auto* sample = dynamic_cast<const proc::SampleLookup*>(material.scatterer.get())) {
        material.sample = &sample->set();
    }
    if (const auto* table = dynamic_cast<const proc::SpecularLookup*>(material.scatterer.get())) {
        material.table = &table->table();
    }
    return material;
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
    Result<proc::BrdfFile> brdf = proc::readBrdf(*file);
    if (!brdf) return brdf.error();
    Result<Material> material = materialOf(std::move(*brdf));
    if (!material) return material.error().in(file->string());
    return material;
}

}  // namespace gonio::daemon
