#include "proc/models/spec.h"

#include <algorithm>
#include <string>

#include "proc/models/catalogue.h"
#include "proc/models/sum.h"

namespace gonio::proc {
namespace {

/// '+' joins lobes, except inside a number's exponent ("1e+3").
std::vector<std::string_view> splitLobes(std::string_view spec) {
    std::vector<std::string_view> lobes;
    std::size_t start = 0;
    for (std::size_t i = 0; i < spec.size(); ++i) {
        if (spec[i] != '+') continue;
        const bool exponent = i >= 2 && (spec[i - 1] == 'e' || spec[i - 1] == 'E') &&
                              spec[i - 2] >= '0' && spec[i - 2] <= '9';
        if (exponent) continue;
        lobes.push_back(spec.substr(start, i - start));
        start = i + 1;
    }
    lobes.push_back(spec.substr(start));
    return lobes;
}

std::vector<CatalogueEntry> allModels() {
    std::vector<CatalogueEntry> all;
    for (const auto family : {diffuseModels(),
                              cosineModels(),
                              blinnPhongModels(),
                              slopeModels(),
                              microfacetModels(),
                              materialModels(),
                              publishedModels()}) {
        all.insert(all.end(), family.begin(), family.end());
    }
    return all;
}

Result<Lobe> makeLobe(std::string_view text, EvalPath path) {
    std::vector<std::string_view> items = split(text, ',');
    const std::string name(items.front());
    items.erase(items.begin());
    const std::vector<CatalogueEntry> models = allModels();
    const auto found = std::find_if(models.begin(), models.end(), [&](const CatalogueEntry& entry) {
        return entry.name == name;
    });
    if (found == models.end()) {
        std::string list;
        for (const CatalogueEntry& entry : models) {
            list += (list.empty() ? "" : ", ") + std::string(entry.name);
        }
        return Error{ErrorKind::Usage, "unknown model '" + name + "'; known are " + list};
    }
    SpecParameters parameters(name, items);
    Lobe lobe = found->make(parameters, path);
    if (auto error = parameters.verdict()) return *error;
    if (lobe == nullptr) return Error{ErrorKind::Internal, "model " + name + ": was not made"};
    return lobe;
}

}  // namespace

Result<std::unique_ptr<const AnalyticModel>> makeModel(std::string_view spec, EvalPath path) {
    std::vector<Lobe> lobes;
    for (std::string_view text : splitLobes(spec)) {
        Result<Lobe> lobe = makeLobe(text, path);
        if (!lobe) return lobe.error();
        lobes.push_back(std::move(*lobe));
    }
    if (lobes.size() == 1) return std::move(lobes.front());
    return Lobe(std::make_unique<Sum>(std::move(lobes)));
}

std::vector<std::string_view> modelNames() {
    std::vector<std::string_view> names;
    for (const CatalogueEntry& entry : allModels()) names.push_back(entry.name);
    return names;
}

}  // namespace gonio::proc
