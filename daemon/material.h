#pragma once
// F on the command line: a path, `sample:NAME` of the store, or `model:SPEC`.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proc/core/result.h"
#include "proc/core/scatterer.h"
#include "proc/formats/brdf_file.h"
#include "proc/models/analytic.h"
#include "proc/table/sample_set.h"
#include "proc/table/specular_table.h"

namespace gonio::daemon {

struct Material {
    std::string kind{};                            ///< "model", or a format's name
    std::shared_ptr<const Scatterer> scatterer{};  ///< shared with the simulated rig's stage
    std::shared_ptr<const proc::BrdfFile> file{};  ///< null of a model
    const proc::SampleSet* sample = nullptr;       ///< of the scatterer, when it is a .gonio
    const proc::SpecularTable* table = nullptr;    ///< of the scatterer, when it is such a table

    /// The incidences that the material knows, each once: the LEDs' where it is a formula, or holds
    /// all of them.
    [[nodiscard]] std::vector<Radians> incidences() const;
};

/// sample:NAME, of the store.
[[nodiscard]] bool isStored(const std::string& f);
/// The file behind F, which may not be there; File error for a sample that the store does not have,
/// Usage error for a model.
[[nodiscard]] Result<std::filesystem::path> fileOf(const std::string& f,
                                                   const std::filesystem::path& store);

/// A file that was read, ready to answer; errors as lookupOver().
[[nodiscard]] Result<Material> materialOf(proc::BrdfFile file);

/// Usage error for a bad model and for scattered values, File error for a bad file; `store` is
/// needed for sample:NAME only, `path` is how a model is evaluated.
[[nodiscard]] Result<Material> openMaterial(const std::string& f,
                                            const std::filesystem::path& store,
                                            proc::EvalPath path = {});

}  // namespace gonio::daemon
