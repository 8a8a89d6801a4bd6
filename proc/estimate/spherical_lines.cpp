#include "proc/estimate/spherical_lines.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace gonio::proc {
namespace {

constexpr std::size_t kAxes = 4;
constexpr double kSame = 1e-9;
constexpr double kTurn = 2 * kPi;

double wrapped(double phi) {
    const double within = phi - kTurn * std::floor(phi / kTurn);
    return within < kTurn ? within : 0;
}

enum class Way {
    Down,
    Up
};

}  // namespace

struct SphericalLines::Ordered {
    Coordinates at;
    std::size_t sample;
};

/// One question: the state of its walk through the branches.
struct SphericalLines::Search {
    using Shares = std::vector<LineShare>;

    Coordinates at;
    AxisReach reach;
    PairSymmetry symmetry;
    std::size_t looks = 0;

    /// What was found along one way, and how far along the axis.
    struct Found {
        Shares shares;
        double away = 0;
    };

    [[nodiscard]] bool circular(std::size_t axis) const {
        return axis == 1 ? symmetry == PairSymmetry::None
                         : axis == 3 && symmetry != PairSymmetry::Plane;
    }

    /// `scale`: length on the sphere of a unit of this axis.
    Shares along(const std::vector<Branch>& branches, std::size_t axis, double scale) {
        const std::optional<Found> below = nearest(branches, axis, scale, Way::Down);
        if (below && below->away == 0) return below->shares;
        const std::optional<Found> above = nearest(branches, axis, scale, Way::Up);
        if (!below || !above) return below ? below->shares : above ? above->shares : Shares{};
        const double t = below->away / (below->away + above->away);
        Shares both;
        for (const LineShare& share : below->shares) {
            both.push_back({share.sample, (1 - t) * share.weight});
        }
        for (const LineShare& share : above->shares) {
            both.push_back({share.sample, t * share.weight});
        }
        return both;
    }

    /// The nearest branch one way that answers. At the pair's own coordinate: away = 0, downwards.
    std::optional<Found> nearest(const std::vector<Branch>& branches,
                                 std::size_t axis,
                                 double scale,
                                 Way way) {
        const double limit = (axis < 2 ? reach.incoming : reach.outgoing).value();
        const auto count = branches.size();
        const auto behind = std::upper_bound(
            branches.begin(), branches.end(), at[axis] + kSame, [](double v, const Branch& b) {
                return v < b.at;
            });
        const auto start = static_cast<std::size_t>(behind - branches.begin());
        for (std::size_t step = 0; step < count && looks < reach.maxPoints; ++step) {
            const bool turned = way == Way::Down ? step >= start : start + step >= count;
            if (turned && !circular(axis)) return std::nullopt;
            const Branch& branch = way == Way::Down
                                       ? branches[(start + 2 * count - 1 - step) % count]
                                       : branches[(start + step) % count];
            const double apart = way == Way::Down ? at[axis] - branch.at : branch.at - at[axis];
            const double away = std::max(0.0, turned ? apart + kTurn : apart);
            if (away * scale > limit) return std::nullopt;
            ++looks;
            Shares shares = within(branch, axis);
            if (!shares.empty()) return Found{std::move(shares), away <= kSame ? 0 : away};
        }
        return std::nullopt;
    }

    Shares within(const Branch& branch, std::size_t axis) {
        if (axis + 1 < kAxes) {
            const bool azimuthNext = axis % 2 == 0;
            return along(branch.next, axis + 1, azimuthNext ? std::sin(branch.at) : 1);
        }
        Shares equal;
        for (const std::size_t sample : branch.samples) {
            equal.push_back({sample, 1 / static_cast<double>(branch.samples.size())});
        }
        return equal;
    }
};

SphericalLines::SphericalLines(const ScatteredSet& set) : symmetry_(set.symmetry()) {
    std::vector<Ordered> samples;
    for (const SampleId id : set.ids()) {
        samples.push_back({coordinatesOf(set.find(id)->pair), samples.size()});
    }
    root_ = branchesOf(samples, 0);
}

/// Sorts as it goes, axis by axis: coordinates that differ by rounding alone are one, and leave the
/// order along the axes behind whole.
std::vector<SphericalLines::Branch> SphericalLines::branchesOf(std::span<Ordered> samples,
                                                               std::size_t axis) {
    std::sort(samples.begin(), samples.end(), [axis](const Ordered& a, const Ordered& b) {
        return std::pair(a.at[axis], a.sample) < std::pair(b.at[axis], b.sample);
    });
    std::vector<Branch> branches;
    for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
        Branch branch{.at = samples[begin].at[axis], .next = {}, .samples = {}};
        end = begin + 1;
        while (end < samples.size() && samples[end].at[axis] - samples[end - 1].at[axis] <= kSame) {
            ++end;
        }
        const std::span<Ordered> line = samples.subspan(begin, end - begin);
        if (axis + 1 < kAxes) {
            branch.next = branchesOf(line, axis + 1);
        } else {
            for (const Ordered& one : line) branch.samples.push_back(one.sample);
        }
        branches.push_back(std::move(branch));
    }
    return branches;
}

SphericalLines::Coordinates SphericalLines::coordinatesOf(const LightView& pair) const {
    const bool turns = symmetry_ != PairSymmetry::None;
    const double phiIn = pair.in.phi().value();
    double phiOut = pair.out.phi().value();
    if (turns && pair.out.theta() > Radians(0)) phiOut = wrapped(phiOut - phiIn);
    if (symmetry_ == PairSymmetry::Plane) phiOut = std::min(phiOut, kTurn - phiOut);
    return {pair.in.theta().value(), turns ? 0 : phiIn, pair.out.theta().value(), phiOut};
}

std::vector<LineShare> SphericalLines::sharesAt(const LightView& pair,
                                                const AxisReach& reach) const {
    Search search{.at = coordinatesOf(pair), .reach = reach, .symmetry = symmetry_};
    std::vector<LineShare> shares = search.along(root_, 0, 1);
    std::erase_if(shares, [](const LineShare& share) { return share.weight == 0; });
    return shares;
}

}  // namespace gonio::proc
