#include "daemon/estimators.h"

#include <algorithm>
#include <functional>

#include "proc/estimate/grid_data.h"
#include "proc/estimate/method_choice.h"
#include "proc/estimate/rotations_estimator.h"
#include "proc/estimate/scattered_estimator.h"
#include "proc/estimate/seed004.h"
#include "proc/formats/sniff.h"
#include "proc/table/merged_info.h"
#include "proc/table/rotations.h"

namespace gonio::daemon {
namespace {

using Opened = std::shared_ptr<const Scatterer>;

/// A table says nothing of its noise.
constexpr proc::DataOptions kTable{.assumedRelative = 0.01};

using Prior = std::function<std::shared_ptr<const proc::PriorBasis>()>;

/// The standard one is made when it is asked for; a library of one's own is read now.
Result<Prior> priorOf(const EstimatorChoice& choice) {
    if (choice.prior.empty()) return Prior(proc::standardPrior);
    const auto library = proc::PriorLibrary::read(choice.prior);
    if (!library) return library.error();
    auto basis = proc::PriorBasis::over(*library);
    if (!basis) return basis.error();
    return Prior([made = std::make_shared<const proc::PriorBasis>(std::move(*basis))] {
        return made;  // of one run
    });
}

/// Whether there is anything between its incidences to be estimated: it holds a few of them.
bool isSparse(const Material& material) {
    if (material.sample != nullptr || material.table != nullptr) return true;
    constexpr std::size_t kFew = 12;
    const auto* table = material.file ? material.file->as<proc::SphericalTable>() : nullptr;
    return table != nullptr && table->isotropic() &&
           proc::incidencesOf(*material.file).size() <= kFew;
}

/// Of a sample or a table.
std::vector<Radians> rotationsOf(const Material& material) {
    if (material.sample != nullptr) return proc::rotationsOf(*material.sample);
    if (material.table == nullptr) return {Radians()};
    std::vector<Radians> rotations;
    rotations.reserve(material.table->rotationDeg.size());
    for (const double deg : material.table->rotationDeg) {
        rotations.push_back(proc::rotationOf(deg));
    }
    return rotations;
}

/// Over one estimator per rotation.
Result<Estimated> ofRotations(Material material,
                              const std::vector<Radians>& rotations,
                              const proc::SampleEstimatorOptions& options) {
    auto made = material.sample != nullptr
                    ? proc::RotationsEstimator::over(*material.sample, options)
                    : proc::RotationsEstimator::over(
                          material.scatterer, rotations, material.incidences(), kTable, options);
    if (!made) return made.error();
    return Estimated{Opened(std::move(*made)), std::move(material)};
}

Result<Estimated> ofMaterial(Material material, const EstimatorChoice& choice) {
    if (choice.name == "none") {
        Opened lookup = material.scatterer;
        return Estimated{std::move(lookup), std::move(material)};
    }
    const std::vector<Radians> rotations = rotationsOf(material);
    if (const auto seed = proc::seed004Named(choice.name)) {
        if (rotations.size() > 1) {
            return Error{ErrorKind::Usage,
                         "a sample of several rotations, and --estimator " + choice.name +
                             " takes one as isotropic; use auto, or first: gonio merge "
                             "--isotropic"};
        }
        if (material.sample == nullptr && material.table == nullptr) {
            return Error{ErrorKind::Usage,
                         "--estimator " + choice.name + " is for .gonio and Zemax files; use auto"};
        }
        auto made = material.sample != nullptr ? proc::makeSeed004(*material.sample, *seed)
                                               : proc::makeSeed004(*material.table, *seed);
        if (!made) return made.error();
        return Estimated{Opened(std::move(*made)), std::move(material)};
    }
    proc::SampleEstimatorOptions options{.method = choice.name, .effort = choice.effort};
    auto prior = priorOf(choice);
    if (!prior) return prior.error();
    options.prior = std::move(*prior);
    if (rotations.size() > 1) return ofRotations(std::move(material), rotations, options);
    proc::BrdfData data =
        material.sample != nullptr
            ? proc::fitDataOf(proc::unturned(*material.sample))
            : proc::gridDataOf(*material.scatterer, material.incidences(), kTable);
    auto made = proc::SampleEstimator::over(material.scatterer, std::move(data), options);
    if (!made) return made.error();
    const proc::SampleEstimator* chosen = made->get();
    return Estimated{Opened(std::move(*made)), std::move(material), chosen};
}

Result<Estimated> ofScattered(const proc::BrdfRows& rows, const EstimatorChoice& choice) {
    if (choice.name != "auto") {
        return Error{ErrorKind::Usage,
                     "scattered values: --estimator auto is for them, not '" + choice.name + "'"};
    }
    const auto data = proc::fitDataOf(rows);
    if (!data) return data.error();
    auto made = proc::ScatteredEstimator::over(*data);
    if (!made) return made.error();
    return Estimated{Opened(std::move(*made)), Material{}, nullptr, data->incidences};
}

/// What is finer than any estimator answers as itself.
Result<Estimated> asItself(Material material, const EstimatorChoice& choice) {
    if (choice.name != "auto" && choice.name != "none") {
        const bool formula = material.file == nullptr;
        return Error{ErrorKind::Usage,
                     std::string(formula ? "a formula" : "it holds all directions") +
                         ": it needs no --estimator"};
    }
    Opened scatterer = material.scatterer;
    return Estimated{std::move(scatterer), std::move(material)};
}

Result<void> checkName(const std::string& name) {
    std::vector<std::string> known{"auto", "none"};
    for (const std::string& method : proc::methodNames()) known.push_back(method);
    const bool one = std::find(known.begin(), known.end(), name) != known.end();
    if (one || proc::seed004Named(name)) return {};
    std::string list;
    for (const std::string& method : known) list += (list.empty() ? "" : ", ") + method;
    return Error{ErrorKind::Usage,
                 "--estimator '" + name + "' is not known; known: " + list + "; and " +
                     proc::seed004Names()};
}

}  // namespace

std::vector<Radians> Estimated::rotations() const {
    const bool knows = material.sample != nullptr || material.table != nullptr;
    const std::vector<Radians> known = knows ? rotationsOf(material) : std::vector<Radians>{};
    return known.empty() ? std::vector<Radians>{Radians()} : known;
}

bool holdsScattered(const std::string& f) {
    if (f.starts_with("model:") || isStored(f)) return false;
    const auto format = proc::sniffFile(f);
    return format && proc::listsDirections(*format);
}

Result<Estimated> estimated(Material material, const EstimatorChoice& choice) {
    if (auto known = checkName(choice.name); !known) return known.error();
    if (!isSparse(material)) return asItself(std::move(material), choice);
    return ofMaterial(std::move(material), choice);
}

Result<Estimated> estimated(proc::BrdfFile file, const EstimatorChoice& choice) {
    if (auto known = checkName(choice.name); !known) return known.error();
    if (const auto* rows = file.as<proc::BrdfRows>()) return ofScattered(*rows, choice);
    Result<Material> material = materialOf(std::move(file));
    if (!material) return material.error();
    return estimated(std::move(*material), choice);
}

Result<Estimated> openEstimated(const std::string& f,
                                const std::filesystem::path& store,
                                const EstimatorChoice& choice,
                                proc::EvalPath path) {
    if (auto known = checkName(choice.name); !known) return known.error();
    if (f.starts_with("model:")) {
        Result<Material> model = openMaterial(f, store, path);
        if (!model) return model.error();
        auto made = asItself(std::move(*model), choice);
        if (!made) return made.error().in("'" + f + "'");
        return made;
    }
    const Result<std::filesystem::path> place = fileOf(f, store);
    if (!place) return place.error();
    Result<proc::BrdfFile> file = proc::readBrdf(*place);
    if (!file) return file.error();
    auto made = estimated(std::move(*file), choice);
    if (!made) return made.error().in("'" + f + "'");
    return made;
}

}  // namespace gonio::daemon
