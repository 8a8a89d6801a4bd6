#include "proc/export/tensor_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "proc/core/parallel.h"
#include "proc/table/tensor_bsdf.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// What a node was answered, as bits.
enum Got : unsigned char {
    Above = 1,
    Answered = 2,
    Negative = 4,
    Uncertain = 8,
    Extrapolated = 16
};

class Fitter {
public:
    Fitter(const Scatterer& from, const TensorFitOptions& options)
        : from_(from), options_(options) {
        TensorTable& table = fitted_.table;
        for (const double theta : options.thetaInDeg) {
            table.thetaIn.push_back(static_cast<float>(Radians::fromDegrees(theta).value()));
        }
        for (const double phi : options.phiInDeg) {
            table.phiIn.push_back(static_cast<float>(Radians::fromDegrees(phi).value()));
        }
        if (options.phiInDeg.size() > 2 && options_.normals.height == 2) {
            options_.normals.height = 65;
        }
        channels_ = from.bandCount() == BandCount::One && !options.spectral ? 1 : 3;
    }

    FittedTensor fit() {
        FittedNormals normals = fitNormals(from_, options_.normals);
        TensorTable& table = fitted_.table;
        table.ndf = std::move(normals.ndf);
        table.sigma = std::move(normals.sigma);
        fitted_.retroFilled = normals.filled;
        fillVisibleNormals();
        askValues();
        for (std::size_t phi = 0; phi < table.phiIn.size(); ++phi) fillMissing(phi);
        count();
        takeValues();
        nameChannels();
        return std::move(fitted_);
    }

private:
    [[nodiscard]] std::size_t lights() const {
        return fitted_.table.phiIn.size() * fitted_.table.thetaIn.size();
    }
    [[nodiscard]] Radians azimuthOf(std::size_t slice) const {
        return Radians::fromDegrees(options_.phiInDeg[slice / options_.thetaInDeg.size()]);
    }
    /// By the numbers asked for: the file's floats may lie beyond the last incidence of a table.
    [[nodiscard]] Direction lightOf(std::size_t slice) const {
        const double theta = options_.thetaInDeg[slice % options_.thetaInDeg.size()];
        return Direction::fromSpherical(Radians::fromDegrees(theta), azimuthOf(slice));
    }
    /// An isotropic table counts the azimuth of h from the light's.
    [[nodiscard]] Direction halfOf(const SquarePoint& at, std::size_t slice) const {
        const Direction h = directionOf(at);
        if (!fitted_.table.isotropic()) return h;
        return h.turned(azimuthOf(slice));
    }

    void fillVisibleNormals() {
        // Normals turned away from the light are hardly there, but no row is without any: readers
        // divide by its sum.
        constexpr double kLeastCosine = 1e-3;
        TensorTable& table = fitted_.table;
        GridStack& vndf = table.vndf;
        vndf = {.width = options_.vndfWidth, .height = options_.vndfHeight, .values = {}};
        const std::size_t each = vndf.width * vndf.height;
        vndf.values.resize(lights() * each);
        for (std::size_t slice = 0; slice < lights(); ++slice) {
            const Direction wi = lightOf(slice);
            for (std::size_t i = 0; i < each; ++i) {
                const SquarePoint at = nodeOf(vndf, i);
                const Direction h = halfOf(at, slice);
                const double shown = std::max(kLeastCosine, h.vector().dot(wi.vector()));
                // Per area of the square: x sin(theta) of the solid angle.
                const double area = at.x * std::sin(at.x * at.x * kPi / 2);
                vndf.values[slice * each + i] =
                    static_cast<float>(bilinear(table.ndf, 0, at) * shown * area);
            }
        }
    }

    void askValues() {
        TensorTable& table = fitted_.table;
        const std::size_t each = options_.side * options_.side;
        got_.assign(lights() * each, 0);
        ratios_.assign(lights() * each, {kNan, kNan, kNan});
        const auto warp = Warp2d::over(table.vndf);
        if (!warp) return;
        parallelFor(got_.size(), [&](IndexRange range) {
            for (std::size_t i = range.begin; i < range.end; ++i) ask(*warp, i / each, i);
        });
    }

    void ask(const Warp2d& warp, std::size_t slice, std::size_t i) {
        const TensorTable& table = fitted_.table;
        const std::size_t side = options_.side;
        const GridStack square{.width = side, .height = side, .values = {}};
        SliceBlend only;
        only.slice[0] = slice;
        const SquarePoint at = warp.sample(nodeOf(square, i % (side * side)), only);
        const Direction wi = lightOf(slice);
        const Direction h = halfOf(at, slice);
        const double cosDiff = wi.vector().dot(h.vector());
        const auto wo = Direction::fromVector(2 * cosDiff * h.vector() - wi.vector());
        if (!wo || cosDiff <= 0 || !wo->aboveHorizon()) return;
        got_[i] = Above;
        const Answer answer = from_.answer({.in = wi, .out = *wo});
        if (!answer.present()) return;
        unsigned got = Above | Answered;
        if (answer.uRandom || answer.uSystematic) got |= Uncertain;
        if (answer.flags.has(Flag::Extrapolated)) got |= Extrapolated;
        const Radians phi(std::atan2(wi.y(), wi.x()));
        const double sigma = bilinear(table.sigma, 0, squareOf(wi.theta(), phi));
        const double scale = wo->z() * 4 * sigma / bilinear(table.ndf, 0, at);
        for (std::size_t band = 0; band < 3; ++band) {
            if (answer.f.value[band] < 0) got |= Negative;
            ratios_[i][band] = std::max(0.0, answer.f.value[band]) * scale;
        }
        got_[i] = static_cast<unsigned char>(got);
    }

    void fillMissing(std::size_t phi) {
        const std::size_t each = options_.side * options_.side;
        const std::size_t thetas = fitted_.table.thetaIn.size();
        for (std::size_t i = 0; i < each; ++i) {
            const auto at = [&](std::size_t theta) { return (phi * thetas + theta) * each + i; };
            const auto missing = [&](std::size_t theta) {
                return (got_[at(theta)] & (Above | Answered)) == Above;
            };
            const auto answered = [&](std::size_t theta) {
                return (got_[at(theta)] & Answered) != 0;
            };
            for (std::size_t theta = 0; theta < thetas; ++theta) {
                if (!missing(theta)) continue;
                std::size_t from = theta;
                while (from > 0 && !answered(from)) --from;
                if (!answered(from)) {
                    from = theta;
                    while (from + 1 < thetas && !answered(from)) ++from;
                }
                ratios_[at(theta)] =
                    answered(from) ? ratios_[at(from)] : std::array<double, 3>{0, 0, 0};
            }
        }
    }

    void count() {
        for (const unsigned char g : got_) {
            fitted_.nodes += (g & Above) != 0 ? 1U : 0U;
            fitted_.filled += (g & (Above | Answered)) == Above ? 1U : 0U;
            fitted_.negative += (g & Negative) != 0 ? 1U : 0U;
            fitted_.uncertain += (g & Uncertain) != 0 ? 1U : 0U;
            fitted_.extrapolated += (g & Extrapolated) != 0 ? 1U : 0U;
        }
    }

    void takeValues() {
        TensorTable& table = fitted_.table;
        const std::size_t side = options_.side;
        const std::size_t each = side * side;
        table.values = {.width = side, .height = side, .values = {}};
        table.luminance = table.values;
        table.values.values.resize(ratios_.size() * channels_);
        for (std::size_t i = 0; i < ratios_.size(); ++i) {
            double mean = 0;
            for (std::size_t c = 0; c < channels_; ++c) {
                // Wavelengths ascend: B, G, R.
                const std::size_t band = options_.spectral ? 2 - c : c;
                const double ratio = std::isnan(ratios_[i][band]) ? 0 : ratios_[i][band];
                mean += ratio / static_cast<double>(channels_);
                table.values.values[(i / each * channels_ + c) * each + i % each] =
                    static_cast<float>(ratio);
            }
            table.luminance.values.push_back(static_cast<float>(mean));
        }
        keepDense(table.luminance);
    }

    /// Where nothing is reflected, any direction is as good as another.
    static void keepDense(GridStack& luminance) {
        const std::size_t each = luminance.width * luminance.height;
        for (std::size_t at = 0; at < luminance.values.size(); at += each) {
            const auto begin = luminance.values.begin() + static_cast<std::ptrdiff_t>(at);
            const auto end = begin + static_cast<std::ptrdiff_t>(each);
            if (*std::max_element(begin, end) <= 0) std::fill(begin, end, 1.0F);
        }
    }

    void nameChannels() {
        std::vector<Channel>& channels = fitted_.table.channels;
        if (channels_ == 1) {
            channels = {{}};
            return;
        }
        for (std::size_t c = 0; c < 3; ++c) {
            const Band band = kBands[options_.spectral ? 2 - c : c];
            channels.push_back(options_.spectral ? Channel{"", nanometres(band)}
                                                 : Channel::of(band));
        }
    }

    const Scatterer& from_;
    TensorFitOptions options_;
    std::size_t channels_ = 3;
    FittedTensor fitted_;
    std::vector<unsigned char> got_;             ///< light > node
    std::vector<std::array<double, 3>> ratios_;  ///< likewise
};

}  // namespace

FittedTensor fitTensor(const Scatterer& from, const TensorFitOptions& options) {
    return Fitter(from, options).fit();
}

}  // namespace gonio::proc
