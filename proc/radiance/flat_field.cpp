#include "proc/radiance/flat_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "proc/core/median.h"

namespace gonio::proc {
namespace {

constexpr int kReach = 7;             // of the neighbourhood, in each direction
constexpr double kMostSpread = 0.06;  // of a neighbourhood, relative
constexpr double kLeastCovered = 0.2;

/// Running sums over rectangles that begin at the upper left corner.
class Areas {
public:
    explicit Areas(const Image<float>& picture)
        : size_(picture.size()), sums_(Size{size_.width + 1, size_.height + 1}) {
        for (int y = 0; y < size_.height; ++y) {
            Sums row;
            for (int x = 0; x < size_.width; ++x) {
                const double v = picture.at(x, y);
                if (std::isfinite(v)) row += {1, v, v * v};
                sums_.at(x + 1, y + 1) = sums_.at(x + 1, y);
                sums_.at(x + 1, y + 1) += row;
            }
        }
    }

    /// The mean about a pixel; empty: it says nothing.
    [[nodiscard]] std::optional<double> smooth(int x, int y) const {
        const int left = x - kReach, top = y - kReach;
        const int right = x + kReach + 1, bottom = y + kReach + 1;
        if (left < 0 || top < 0 || right > size_.width || bottom > size_.height) return {};
        Sums sums = sums_.at(right, bottom);
        sums -= sums_.at(left, bottom);
        sums -= sums_.at(right, top);
        sums += sums_.at(left, top);
        constexpr double kAll = (2 * kReach + 1) * (2 * kReach + 1);
        const double mean = sums.values / kAll;
        if (sums.count < kAll || !(mean > 0)) return {};
        const double variance = sums.squares / kAll - mean * mean;
        if (variance > std::pow(kMostSpread * mean, 2)) return {};
        return mean;
    }

private:
    struct Sums {
        double count = 0, values = 0, squares = 0;
        Sums& operator+=(const Sums& other) {
            count += other.count;
            values += other.values;
            squares += other.squares;
            return *this;
        }
        Sums& operator-=(const Sums& other) {
            return *this += {-other.count, -other.values, -other.squares};
        }
    };
    Size size_;
    Image<Sums> sums_;
};

Error refused(const std::string& what) {
    return {.kind = ErrorKind::Quality, .message = "flat field: " + what};
}

}  // namespace

bool FlatField::apply(MergedState& state) const {
    if (state.window != window || state.radiance.size() != response.size()) return false;
    const std::span<const float> by = response.pixels();
    const std::span<float> radiance = state.radiance.pixels(), variance = state.variance.pixels();
    for (std::size_t i = 0; i < by.size(); ++i) {
        radiance[i] /= by[i];
        variance[i] /= by[i] * by[i];
    }
    return true;
}

Result<FlatField> flatField(std::span<const MergedState* const> white) {
    if (white.empty()) return refused("no pictures of the white reference");
    FlatField flat{.response = Image<float>(white.front()->radiance.size(), 1.0F),
                   .window = white.front()->window};
    std::vector<Areas> areas;
    for (const MergedState* state : white) {
        if (state->window != flat.window || state->radiance.size() != flat.response.size()) {
            return refused("pictures of different windows");
        }
        areas.emplace_back(state->radiance);
    }
    std::vector<double> ratios, relative, noise;
    double sum = 0, squares = 0;
    for (int y = 0; y < flat.response.height(); ++y) {
        for (int x = 0; x < flat.response.width(); ++x) {
            ratios.clear();
            double variance = 0;
            for (std::size_t i = 0; i < white.size(); ++i) {
                const std::optional<double> smooth = areas[i].smooth(x, y);
                if (!smooth) continue;
                ratios.push_back(white[i]->radiance.at(x, y) / *smooth);
                variance += white[i]->variance.at(x, y) / (*smooth * *smooth);
            }
            if (ratios.empty()) continue;
            const auto n = static_cast<double>(ratios.size());
            const double response = median(ratios);
            if (!(response > 0)) continue;
            flat.response.at(x, y) = static_cast<float>(response);
            noise.push_back(std::sqrt(M_PI / 2 * variance) / n);  // a median's
            sum += response;
            squares += response * response;
        }
    }
    const auto known = static_cast<double>(noise.size());
    flat.coveredPixels = known / static_cast<double>(flat.response.size().pixels());
    if (flat.coveredPixels < kLeastCovered) {
        return refused("only " + std::to_string(std::lround(100 * flat.coveredPixels)) +
                       " % of the pixels see a smooth light; is the white reference placed?");
    }
    const double mean = sum / known;
    flat.spread = std::sqrt(std::max(squares / known - mean * mean, 0.0));
    flat.uResponse = median(std::move(noise));
    return flat;
}

}  // namespace gonio::proc
