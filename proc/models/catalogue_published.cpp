#include <algorithm>

#include "proc/models/catalogue.h"
#include "proc/models/published_fits.h"
#include "proc/models/spec.h"

namespace gonio::proc {
namespace {

/// One material of a file of published fits: a sum of our own models.
Lobe makeMerlFit(SpecParameters& p, EvalPath path) {
    const std::string file = p.text("F");
    const std::string material = p.text("material");
    const Result<std::vector<PublishedFit>> fits = readPublishedFits(file);
    if (!fits) {
        p.refuse(fits.error());
        return nullptr;
    }
    const auto found = std::find_if(fits->begin(), fits->end(), [&](const PublishedFit& fit) {
        return fit.material == material;
    });
    if (found == fits->end()) {
        p.complain("'" + file + "' has no material '" + material + "' among its " +
                   std::to_string(fits->size()) + ", such as '" + fits->front().material + "'");
        return nullptr;
    }
    Result<Lobe> lobe = makeModel(found->spec, path);
    if (lobe) return std::move(*lobe);
    p.refuse({ErrorKind::File, "'" + file + "': " + material + ": " + lobe.error().message});
    return nullptr;
}

constexpr std::array kModels{CatalogueEntry{"merl-fit", makeMerlFit}};

}  // namespace

std::span<const CatalogueEntry> publishedModels() { return kModels; }

}  // namespace gonio::proc
