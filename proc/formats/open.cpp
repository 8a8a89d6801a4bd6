#include "proc/formats/open.h"

#include "proc/table/band_channels.h"
#include "proc/table/half_difference_lookup.h"
#include "proc/table/sample_lookup.h"
#include "proc/table/specular_lookup.h"
#include "proc/table/spherical_lookup.h"
#include "proc/table/tensor_bsdf.h"

namespace gonio::proc {
namespace {

using Opened = std::unique_ptr<const Scatterer>;

Result<Opened> over(SampleSet set) {
    return Opened(std::make_unique<SampleLookup>(std::move(set)));
}

Result<Opened> over(SpecularTable table) {
    Result<SpecularLookup> lookup = SpecularLookup::over(std::move(table));
    if (!lookup) return lookup.error();
    return Opened(std::make_unique<SpecularLookup>(std::move(*lookup)));
}

Result<Opened> over(SphericalTable table) {
    const auto bands = bandChannels(table.channels);
    if (!bands) return bands.error();
    Result<SphericalLookup> lookup = SphericalLookup::over(std::move(table), *bands);
    if (!lookup) return lookup.error();
    return Opened(std::make_unique<SphericalLookup>(std::move(*lookup)));
}

Result<Opened> over(HalfDifferenceTable table) {
    Result<HalfDifferenceLookup> lookup = HalfDifferenceLookup::over(std::move(table));
    if (!lookup) return lookup.error();
    return Opened(std::make_unique<HalfDifferenceLookup>(std::move(*lookup)));
}

Result<Opened> over(TensorTable table) {
    Result<TensorBsdf> tensor = TensorBsdf::over(std::move(table));
    if (!tensor) return tensor.error();
    return Opened(std::make_unique<TensorBsdf>(std::move(*tensor)));
}

Result<Opened> over(const BrdfRows& /*rows*/) {
    return Error{ErrorKind::Usage, "scattered values: between them answers --estimator auto"};
}

}  // namespace

Result<Opened> lookupOver(BrdfFile file) {
    return std::visit([](auto& content) { return over(std::move(content)); }, file.content);
}

Result<Opened> openBrdf(const std::filesystem::path& path) {
    Result<BrdfFile> file = readBrdf(path);
    if (!file) return file.error();
    Result<Opened> lookup = lookupOver(std::move(*file));
    if (!lookup) return lookup.error().in(path.string());
    return lookup;
}

}  // namespace gonio::proc
