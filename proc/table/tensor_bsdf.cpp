#include "proc/table/tensor_bsdf.h"

#include <algorithm>
#include <cmath>

#include "proc/core/quantities.h"

namespace gonio::proc {
namespace {

/// Between which values of an axis, the ends held.
struct HeldPlace {
    std::size_t low = 0, high = 0;
    double t = 0;
};

HeldPlace heldPlace(const std::vector<float>& axis, double at) {
    const auto above = std::upper_bound(
        axis.begin(), axis.end(), at, [](double a, float b) { return a < static_cast<double>(b); });
    const auto high = static_cast<std::size_t>(above - axis.begin());
    if (high == 0) return {0, 0, 0};
    if (high == axis.size()) return {high - 1, high - 1, 0};
    const double low = axis[high - 1];
    return {high - 1, high, (at - low) / (static_cast<double>(axis[high]) - low)};
}

bool ascends(const std::vector<float>& axis) {
    return std::adjacent_find(
               axis.begin(), axis.end(), [](float a, float b) { return !(a < b); }) == axis.end();
}

std::string complaintOf(const GridStack& stack, std::string_view name, std::size_t slices) {
    if (stack.width >= 2 && stack.height >= 2 && stack.slices() == slices &&
        stack.values.size() == slices * stack.width * stack.height) {
        return "";
    }
    return std::string(name) + " has " + std::to_string(stack.values.size()) + " values, wanted " +
           std::to_string(slices) + " x " + std::to_string(stack.height) + " x " +
           std::to_string(stack.width) + ", at least 2 x 2 each";
}

/// A pair within the part of the circle that the table covers.
LightView within(int reduction, LightView pair) {
    if (reduction < 2) return pair;
    const bool turnY = pair.in.y() > 0;
    const bool turnX = reduction == 4 ? pair.in.x() > 0 : turnY;
    const auto turned = [&](const Direction& d) {
        const Eigen::Vector3d v(turnX ? -d.x() : d.x(), turnY ? -d.y() : d.y(), d.z());
        return *Direction::fromVector(v);
    };
    return {.in = turned(pair.in), .out = turned(pair.out)};
}

/// In [-pi, pi].
Radians phiOf(const Direction& d) { return Radians(std::atan2(d.y(), d.x())); }

}  // namespace

std::string complaintOf(const TensorTable& table) {
    if (table.thetaIn.empty() || !ascends(table.thetaIn) || table.thetaIn.front() < 0) {
        return "theta_i does not ascend from 0 or more";
    }
    if (table.phiIn.empty() || !ascends(table.phiIn)) return "phi_i does not ascend";
    if (const int parts = table.reduction(); parts != 1 && parts != 2 && parts != 4) {
        return "phi_i covers none of the whole circle, a half, a quarter";
    }
    const std::size_t lights = table.thetaIn.size() * table.phiIn.size();
    std::string wrong = complaintOf(table.ndf, "ndf", 1);
    if (wrong.empty()) wrong = complaintOf(table.sigma, "sigma", 1);
    if (wrong.empty()) wrong = complaintOf(table.vndf, "vndf", lights);
    if (wrong.empty()) wrong = complaintOf(table.luminance, "luminance", lights);
    if (wrong.empty()) wrong = complaintOf(table.values, "values", lights * table.channels.size());
    if (wrong.empty() && table.channels.empty()) wrong = "no channels";
    return wrong;
}

SliceBlend blendAt(const TensorTable& table, Radians theta, Radians phi) {
    const HeldPlace t = heldPlace(table.thetaIn, theta.value());
    const HeldPlace p = heldPlace(table.phiIn, phi.value());
    const std::size_t thetas = table.thetaIn.size();
    return {.slice = {p.low * thetas + t.low,
                      p.low * thetas + t.high,
                      p.high * thetas + t.low,
                      p.high * thetas + t.high},
            .share = {(1 - p.t) * (1 - t.t), (1 - p.t) * t.t, p.t * (1 - t.t), p.t * t.t}};
}

Result<TensorBsdf> TensorBsdf::over(TensorTable table) {
    if (const std::string wrong = complaintOf(table); !wrong.empty()) {
        return Error{ErrorKind::File, "look-up: " + wrong};
    }
    const auto bands = bandChannels(table.channels);
    if (!bands) return bands.error();
    auto vndf = Warp2d::over(std::move(table.vndf));
    if (!vndf) return Error{ErrorKind::File, "look-up: vndf is no density at some theta_i, phi_i"};
    table.vndf = {};
    table.luminance = {};  // for those who draw directions
    return TensorBsdf(std::move(table), std::move(*vndf), *bands);
}

Answer TensorBsdf::answer(const LightView& pair) const {
    if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
        return Answer::none({Flag::BelowHorizon}, Source::Interpolated);
    }
    const LightView at = within(table_.reduction(), pair);
    const Radians thetaIn = at.in.theta();
    const Radians phiIn = phiOf(at.in);
    const auto half = Direction::fromVector(at.in.vector() + at.out.vector());
    const double sigma = bilinear(table_.sigma, 0, squareOf(thetaIn, phiIn));
    if (!half || at.out.z() < kMinCosForBrdf || !(sigma > 0)) {
        return Answer::none({}, Source::Interpolated);
    }
    const Radians turn = table_.isotropic() ? phiIn : Radians(0);
    const SquarePoint h = squareOf(half->theta(), phiOf(*half) - turn);
    const SliceBlend blend = blendAt(table_, thetaIn, phiIn);
    const SquarePoint place = vndf_.invert(h, blend);
    const double scale =
        (table_.jacobian ? bilinear(table_.ndf, 0, h) / (4 * sigma) : 1) / at.out.z();

    Answer answer;
    const std::size_t channels = table_.channels.size();
    for (const Band band : kBands) {
        const double value = bands_.bands[index(band)].of([&](std::size_t channel) {
            return blend.of([&](std::size_t slice) {
                return bilinear(table_.values, slice * channels + channel, place);
            });
        });
        answer.f[band] = std::max(0.0, value * scale);
    }
    if (!answer.present()) return Answer::none({}, Source::Interpolated);  // beyond a double
    const bool beyond = thetaIn.value() > static_cast<double>(table_.thetaIn.back()) + 1e-6;
    answer.source = beyond ? Source::Extrapolated : Source::Interpolated;
    answer.flags.set(beyond ? Flag::Extrapolated : Flag::Interpolated);
    return answer;
}

}  // namespace gonio::proc
