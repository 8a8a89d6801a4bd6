#pragma once
// The trade of look-ups: what a baked table errs, takes and weighs, over resolutions, storage and
// with or without a carrier, and beside it the MERL layout of the same material in the same run.
// Errors are relative, of the worst band, over seeded pairs (lookup_pairs.h) against the material
// itself. Times are nanoseconds an evaluation of R, G and B at those cosine-distributed pairs, in
// random order as they are, one thread, the least of all repeats.

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "proc/core/stopwatch.h"
#include "proc/estimate/baked_table.h"
#include "proc/models/power_errors.h"

namespace gonio::proc {

/// Specs of proc/models; the truth is outside of the carrier's family.
struct LookupMaterial {
    std::string name, truth, carrier;
};

struct LookupSweep {
    std::vector<LookupMaterial> materials;
    std::vector<BoxResolution> resolutions;
    std::size_t pairs = 20000;
    int repeats = 9;
    bool merl = true;

    /// Two lobes of GGX at alpha 0.16 and 0.02, and GGX with Beckmann; 16x8x4 to 128x48x24 nodes.
    [[nodiscard]] static LookupSweep full();
    /// Two materials, three resolutions, 4000 pairs.
    [[nodiscard]] static LookupSweep quick();
};

struct LookupErrors {
    double worst = 0, p99 = 0;
    double mean = 0;  ///< sum of |difference| over sum of f: what the error weighs in light
};

struct LookupRow {
    std::string material;
    std::string method;      ///< "baked", "baked, no carrier", "MERL nearest", "MERL trilinear"
    std::string resolution;  ///< "64x32x16"
    std::string storage;     ///< "float", "half", "double"
    std::size_t bytes = 0;
    LookupErrors cosine, lobe;  ///< over cosinePairs, lobePairs
    double scalarNs = 0;        ///< one at a time
    double batchNs = 0;         ///< in arrays; NaN where there is no such call
    double drawNs = 0;          ///< a direction drawn and its density; NaN likewise
    double draws = 0;           ///< relative variance of f cos / pdf at 45 degrees; NaN likewise
    double drawsByCosine = 0;   ///< the same by cosine sampling
    bool onFront = false, knee = false;

    [[nodiscard]] double worst() const { return std::max(cosine.worst, lobe.worst); }
};

/// Usage errors are those of makeModel and bakeTable. A step for each row.
[[nodiscard]] Result<std::vector<LookupRow>> lookupStudy(const LookupSweep& sweep,
                                                         const Stopwatch& watch,
                                                         const StudyProgress& progress = {});

/// Marks, for each material, the rows that no other beats: less or equal in worst error and bytes,
/// and no more than a tenth slower one at a time; and on that front the knee, where the sum of the
/// logarithms of worst error and bytes, each scaled to the front's range, is least.
void markFront(std::span<LookupRow> rows);

/// A table in Markdown, a row each.
[[nodiscard]] std::string markdown(std::span<const LookupRow> rows);

}  // namespace gonio::proc
