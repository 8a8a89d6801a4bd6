#include "daemon/conversion_input.h"

#include "daemon/estimators.h"
#include "daemon/material.h"
#include "proc/export/cosine.h"
#include "proc/export/source_of.h"

namespace gonio::daemon {
namespace {

constexpr std::string_view kModel = "model:";

Result<OpenedConversion> ofFormula(const ConversionInput& input) {
    const bool asked = input.from || input.cosine || !input.bands.bands.empty() ||
                       input.bands.srgb || input.estimator != "none";
    if (asked) {
        return Error{ErrorKind::Usage,
                     "'" + input.f +
                         "' is a formula: it needs no --from, --bands, --cosine or "
                         "--estimator"};
    }
    Result<Material> model = openMaterial(input.f, {});
    if (!model) return model.error();
    const std::string spec = input.f.substr(kModel.size());
    proc::Metadata about;
    about.set("model", spec);
    return OpenedConversion{proc::sourceOf(model->scatterer, std::move(about)), spec, {}};
}

}  // namespace

Result<OpenedConversion> openConversion(const ConversionInput& input,
                                        const std::filesystem::path& store) {
    if (input.f.starts_with(kModel)) return ofFormula(input);
    const Result<std::filesystem::path> path = fileOf(input.f, store);
    if (!path) return path.error();
    Result<proc::BrdfFile> file = proc::readBrdf(*path, input.from);
    if (!file) return file.error();
    const std::string named = "'" + input.f + "'";
    if (input.cosine) {
        file = proc::withCosineTold(std::move(*file), *input.cosine);
        if (!file) return file.error().in(named);
    }
    OpenedConversion opened{.source = {}, .title = path->stem().string(), .warnings = {}};
    opened.warnings = file->warnings;
    if (const std::string_view name = file->about.at(proc::key::kSample); !name.empty()) {
        opened.title = name;
    }
    Result<proc::ConversionSource> source = proc::sourceOf(std::move(*file), input.bands);
    if (!source) return source.error().in(named);
    opened.source = std::move(*source);
    if (input.estimator == "none") return opened;
    Result<Estimated> estimator = estimated(*opened.source.file, {.name = input.estimator});
    if (!estimator) return estimator.error().in(named);
    opened.source.scatterer = std::move(estimator->scatterer);
    opened.source.estimated = true;
    return opened;
}

}  // namespace gonio::daemon
