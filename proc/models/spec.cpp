#include "proc/models/spec.h"

#include <algorithm>
#include <string>

#include "proc/models/catalogue.h"
#include "proc/models/sum.h"

namespace gonio::proc {
namespace {

/// Parts of a text at each place, outside of double quotes, of which `separates` is true.
template <class Separates>
std::vector<std::string_view> partsOf(std::string_view text, Separates&& separates) {
    std::vector<std::string_view> parts;
    std::size_t start = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '"') quoted = !quoted;
        if (quoted || !separates(i)) continue;
        parts.push_back(text.substr(start, i - start));
        start = i + 1;
    }
    parts.push_back(text.substr(start));
    return parts;
}

/// '+' joins lobes, except inside a number's exponent ("1e+3").
std::vector<std::string_view> splitLobes(std::string_view spec) {
    return partsOf(spec, [spec](std::size_t i) {
        const bool exponent = i >= 2 && (spec[i - 1] == 'e' || spec[i - 1] == 'E') &&
                              spec[i - 2] >= '0' && spec[i - 2] <= '9';
        return spec[i] == '+' && !exponent;
    });
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
    std::vector<std::string_view> items =
        partsOf(text, [text](std::size_t i) { return text[i] == ','; });
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
    if (std::count(spec.begin(), spec.end(), '"') % 2 != 0) {
        return Error{ErrorKind::Usage,
                     "model '" + std::string(spec) + "': a double quote is not closed"};
    }
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
