#pragma once
// The surfaces that estimators are held against: six of Lambert and GGX, which a fit can find
// exactly, and six that are something else. Their parameters are in the specs; two have no model of
// ours and are written here:
//   ABg [Pfisterer2011]: f = A / (B + |beta - beta_0|^g), beta the direction cosines of wo, beta_0
//     those of the mirror direction.
//   retro sheen: Lambert, a GGX coat, a cosine power of the angle between light and view, and
//     Burley's sheen of the difference angle. Reciprocal, both.

#include <memory>
#include <string>
#include <vector>

#include "proc/core/scatterer.h"

namespace gonio::proc {

struct StudyMaterial {
    std::string name;
    std::string spec;                        ///< a model's spec, or the formula's parameters
    bool inFamily;                           ///< of Lambert and GGX
    bool inLibrary;                          ///< of the families that the prior is drawn from
    std::shared_ptr<const Scatterer> truth;  ///< shared by the runs of a study
};

[[nodiscard]] std::vector<StudyMaterial> studyMaterials();

}  // namespace gonio::proc
