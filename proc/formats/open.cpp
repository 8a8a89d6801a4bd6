#include "proc/formats/open.h"

#include "proc/formats/gonio_exr.h"
#include "proc/formats/sniff.h"
#include "proc/formats/zemax.h"
#include "proc/table/sample_lookup.h"
#include "proc/table/specular_lookup.h"

namespace gonio::proc {
namespace {

using Opened = std::unique_ptr<const Scatterer>;

Result<Opened> openZemax(const std::filesystem::path& path) {
    Result<SpecularTable> table = readZemax(path);
    if (!table) return table.error();
    Result<SpecularLookup> lookup = SpecularLookup::over(std::move(*table));
    if (!lookup) return lookup.error().in(path.string());
    return Opened(std::make_unique<SpecularLookup>(std::move(*lookup)));
}

Result<Opened> openSample(const std::filesystem::path& path) {
    Result<SampleSet> set = readGonio(path);
    if (!set) return set.error();
    return Opened(std::make_unique<SampleLookup>(std::move(*set)));
}

}  // namespace

Result<Opened> openBrdf(const std::filesystem::path& path) {
    const Result<FileKind> kind = sniffFile(path);
    if (!kind) return kind.error();
    if (*kind == FileKind::Zemax) return openZemax(path);
    if (*kind == FileKind::Gonio) return openSample(path);
    return Error{ErrorKind::File,
                 "read " + path.string() + ": " + std::string(name(*kind)) +
                     ": cannot be read as a BRDF; .gonio and Zemax .bsdf can"};
}

}  // namespace gonio::proc
