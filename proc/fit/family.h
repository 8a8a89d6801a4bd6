#pragma once
// The families of models that a fit can choose from, by name. A family has parameters of two kinds:
// shared ones, which shape the lobes (alpha, sigma, n), and one per band, in which f is affine
// (albedo, f0, kd, ks: f = a + b p with a, b free of the per-band parameters). A band's f depends
// on its own per-band parameters alone, so that a dual number of (shared + per-band) derivatives
// serves all three bands at once.
//
// Evaluation goes through the kernels of proc/models, at Effort::Reference, in double. Widths start
// at alpha = 5e-3 (n = 8e4): a lobe narrower than that lies within one cell of a degree.

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proc/core/bands.h"
#include "proc/core/result.h"
#include "proc/fit/brdf_data.h"

namespace gonio::proc {

enum class ParameterScale {
    Linear,
    Log  ///< fitted as its logarithm
};

struct FamilyParameter {
    std::string_view name;  ///< as a spec names it
    std::size_t lobe = 0;   ///< of the family's spec
    std::string_view unit;  ///< "1", "1/sr", "rad"
    double lower = 0;
    double upper = 1;
    ParameterScale scale = ParameterScale::Linear;
    bool perBand = false;
    bool likeTheOneBefore = false;  ///< exchanging the two changes nothing: the narrower is first
    std::vector<double> starts{};   ///< of a shared one; of a per-band one the first is taken
};

/// A lobe as a spec writes it: NAME[,EXTRA],parameters.
struct FamilyLobe {
    std::string_view name;
    std::string_view extra{};
};

inline constexpr std::size_t kMostLocal = 8;  ///< shared and per-band parameters of a family

/// f of a band and its derivatives by the shared parameters, then by the band's own.
struct BandSlopes {
    double value = 0;
    std::array<double, kMostLocal> slope{};
};

/// The values of a family's parameters; per-band ones of a monochrome fit are equal.
struct FamilyPoint {
    std::vector<double> shared;
    std::vector<LedBands> perBand;
};

class Family {
public:
    virtual ~Family() = default;

    [[nodiscard]] const std::string& name() const { return name_; }
    /// Shared ones first.
    [[nodiscard]] const std::vector<FamilyParameter>& parameters() const { return parameters_; }
    [[nodiscard]] std::size_t sharedCount() const { return sharedCount_; }
    [[nodiscard]] std::size_t perBandCount() const { return parameters_.size() - sharedCount_; }
    /// Of a fit to `bands` bands.
    [[nodiscard]] std::size_t parameterCount(std::size_t bands) const {
        return sharedCount_ + bands * perBandCount();
    }

    /// "lambert" or "lambert.albedo": with its lobe where the family has several.
    [[nodiscard]] std::string fullName(const FamilyParameter& parameter) const;
    /// What makeModel() takes.
    [[nodiscard]] std::string spec(const FamilyPoint& point, BandCount bands) const;

    /// Means over the nodes, by their weights.
    [[nodiscard]] virtual LedBands f(const FamilyPoint& point,
                                     std::span<const WeightedNode> nodes) const = 0;
    [[nodiscard]] virtual std::array<BandSlopes, 3> slopes(
        const FamilyPoint& point, std::span<const WeightedNode> nodes) const = 0;

protected:
    Family(std::string name,
           std::vector<FamilyLobe> lobes,
           std::vector<FamilyParameter> parameters);

private:
    std::string name_;
    std::vector<FamilyLobe> lobes_;
    std::vector<FamilyParameter> parameters_;
    std::size_t sharedCount_ = 0;
};

/// All of them, the simpler before the richer.
[[nodiscard]] const std::vector<std::unique_ptr<const Family>>& families();
/// A Usage error that lists the names.
[[nodiscard]] Result<const Family*> familyNamed(std::string_view name);
/// "all", or names with commas.
[[nodiscard]] Result<std::vector<const Family*>> familiesNamed(std::string_view list);

}  // namespace gonio::proc
