#pragma once
// Answers of a sample that was measured at several rotations on the stage: rotation r put the light
// at azimuth -r in the sample's frame. Each rotation has an estimator of its own, over what was
// measured at it alone and without exchanging light and view, whose azimuths belong to different
// rotations. Between two neighbouring rotations an answer is linear in the light's azimuth, at
// equal angles between light and view.
//
// Its error by that is a chord's: with d the larger second difference over the four rotations about
// the azimuth (f_before - 2 f_low + f_high, f_low - 2 f_high + f_after), t (1 - t) / 2 times d, and
// no less than 2 t (1 - t) times the difference of the two; it is in u_systematic. A wave of half a
// turn at steps of 45 degrees errs by up to 1.7 times as much. Where only one of the outer two is
// there, it is one difference; where none is (two rotations), and where no two neighbours enclose
// the azimuth (axis.h, placeOnCircle; flagged extrapolated), no uncertainty is known, and none
// told.
//
// At the normal the light has no azimuth, and the first rotation answers; beside it each rotation
// is asked at the angle between light and view, as everywhere.

#include <memory>
#include <optional>
#include <vector>

#include "proc/estimate/sample_estimator.h"
#include "proc/table/axis.h"

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
    /// Standard error of an answer between two rotations, 1/sr; empty where nobody knows.
    [[nodiscard]] std::optional<LedBands> chordError(const AxisPlace& place,
                                                     const LightView& pair,
                                                     const Answer& low,
                                                     const Answer& high) const;

    std::vector<Turn> turns_;  ///< ascending
    std::vector<double> deg_;
};

}  // namespace gonio::proc
