#pragma once
// Answers of a sample that was measured at several rotations on the stage: rotation r put the light
// at azimuth -r in the sample's frame. Each rotation has an estimator of its own, over what was
// measured at it alone and without exchanging light and view, whose azimuths belong to different
// rotations. Between two neighbouring rotations an answer is linear in the light's azimuth, at
// equal angles between light and view.
//
// Its error by that is taken as half the difference of the two where they weigh alike, and
// 2 t (1 - t) times the difference elsewhere: it is in u_systematic. Where no two neighbours
// (axis.h, placeOnCircle) enclose the azimuth, the answer is flagged extrapolated and holds half of
// what all rotations differ by instead. At the normal the light has no azimuth, and the rotation
// nearest to azimuth 0 answers.

#include <memory>
#include <vector>

#include "proc/estimate/sample_estimator.h"

namespace gonio::proc {

class RotationsEstimator final : public Scatterer {
public:
    struct Turn {
        Radians rotation;  ///< of the sample, in [0, 2 pi)
        std::unique_ptr<const SampleEstimator> estimator;
    };

    /// As SampleEstimator::over, of each rotation of the set.
    [[nodiscard]] static Result<std::unique_ptr<const RotationsEstimator>> over(
        const SampleSet& set, const SampleEstimatorOptions& options);
    /// Of anything that answers at those rotations and incidences, on the cells of CellGrid.
    [[nodiscard]] static Result<std::unique_ptr<const RotationsEstimator>> over(
        const std::shared_ptr<const Scatterer>& measured,
        std::vector<Radians> rotations,
        const std::vector<Radians>& incidences,
        const DataOptions& assumed,
        const SampleEstimatorOptions& options);

    [[nodiscard]] Answer answer(const LightView& pair) const override;
    [[nodiscard]] BandCount bandCount() const override;

private:
    explicit RotationsEstimator(std::vector<Turn> turns);
    [[nodiscard]] Answer ofTurn(std::size_t turn, const LightView& pair) const;
    /// Of all rotations' answers, largest less least, 1/sr.
    [[nodiscard]] LedBands rangeAt(const LightView& pair) const;

    std::vector<Turn> turns_;  ///< ascending
    std::vector<double> deg_;
};

}  // namespace gonio::proc
