#pragma once
// What a fit is made to: measured f per band with its standard uncertainties, at pairs of
// directions, in groups of one incidence. From a measured sample, a table, or scattered values.
//
// A cell of a measured sample holds the mean over its solid angle: within 15 degrees of the mirror
// direction, where a lobe may bend within a cell, it is given as nodes of a Gauss rule (2 x 2, up
// to 4 x 4 within 3 degrees) whose weights sum to 1, elsewhere by its centre. All else is one node.
//
// A measured sample's budget says which part of its systematic uncertainty is shared by one LED and
// band alone, or by a patch of directions under it (budget_shares.h); the rest is common. Without a
// budget all of it is.
//
// Left out: what is missing, saturated, blocked, at or below the horizon, and what has no positive
// uncertainty in a file that gives uncertainties. A file that gives none gets an assumed one,
// relative to f with a floor of 1 % of the incidence's median: then `uKnown` is false and
// chi-square says how the misfit compares with what was assumed.

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "proc/core/result.h"
#include "proc/core/scatterer.h"
#include "proc/models/kernel.h"
#include "proc/table/brdf_rows.h"
#include "proc/table/budget_shares.h"
#include "proc/table/sample_set.h"
#include "proc/table/specular_table.h"

namespace gonio::proc {

struct WeightedNode {
    Pair<double> pair;
    double weight;
};

/// One pair of directions or one cell. A band that is not there has f = u = NaN.
struct FitRow {
    std::uint32_t firstNode = 0;
    std::uint16_t nodeCount = 1;
    std::uint16_t group = 0;  ///< index into BrdfData::incidences
    std::uint32_t patch = 0;  ///< of directions: below kPatches
    std::int32_t cell = -1;   ///< of CellGrid; -1 where it is none
    double solidAngle = 1;    ///< relative to the other rows
    double cosThetaO = 1;
    std::array<double, 3> f{};
    std::array<double, 3> uRandom{};      ///< independent of all other rows
    std::array<double, 3> uSystematic{};  ///< shared by all rows of a band
};

struct BrdfData {
    std::vector<WeightedNode> nodes;
    std::vector<FitRow> rows;
    std::vector<Radians> incidences;  ///< of the groups, ascending (of one rotation)
    BudgetShares shared;              ///< by group: errors shared by its values; empty: none
    BandCount bands = BandCount::Three;
    /// What was measured of a pair holds with light and view exchanged: not of one rotation of an
    /// anisotropic sample, whose exchanged pairs belong to other azimuths of the light.
    bool exchanges = true;
    bool uKnown = true;
    double assumedRelative = 0;  ///< what was assumed where u is not known
    std::size_t leftOut = 0;     ///< pairs or cells

    [[nodiscard]] std::size_t bandsUsed() const { return bands == BandCount::One ? 1 : 3; }
    [[nodiscard]] std::span<const WeightedNode> nodesOf(const FitRow& row) const {
        return {nodes.data() + row.firstNode, row.nodeCount};
    }
    /// Number of values of f.
    [[nodiscard]] std::size_t valueCount() const;
    /// Whether any values share an error that is not common to all.
    [[nodiscard]] bool sharesErrors() const;
    /// What the values of the row's group, and of its patch, share.
    [[nodiscard]] BudgetShare shareOf(const FitRow& row, std::size_t band) const {
        return shared.empty() ? BudgetShare{} : shared[row.group][band];
    }
    /// Standard uncertainty of a value but for what is common to all: of its own and shared.
    [[nodiscard]] double uOf(const FitRow& row, std::size_t band) const {
        const BudgetShare share = shareOf(row, band);
        return std::hypot(row.uRandom[band], row.f[band] * std::hypot(share.patch, share.state));
    }
};

struct DataOptions {
    double assumedRelative = 0.05;  ///< standard uncertainty where a file gives none
    double relativeFloor = 0;       ///< of u_random, added in quadrature, relative to f
};

/// Pairs in the sample's own frame; a group for each LED, of each rotation.
[[nodiscard]] BrdfData fitDataOf(const SampleSet& set, const DataOptions& options = {});
/// The first plane of the first rotation; a Usage error for a table in XYZ or of transmission.
[[nodiscard]] Result<BrdfData> fitDataOf(const SpecularTable& table,
                                         const DataOptions& options = {});
/// The bands of its channels (band_channels.h); a Usage error where it has none.
[[nodiscard]] Result<BrdfData> fitDataOf(const BrdfRows& rows, const DataOptions& options = {});

}  // namespace gonio::proc
