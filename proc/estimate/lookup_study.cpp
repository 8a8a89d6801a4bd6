#include "proc/estimate/lookup_study.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "proc/core/number_text.h"
#include "proc/estimate/bake.h"
#include "proc/estimate/lobe_draw.h"
#include "proc/estimate/lookup_pairs.h"
#include "proc/estimate/merl_layout.h"
#include "proc/models/spec.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr EvalPath kCarrierPath{Effort::Standard, Precision::Float};

/// Pairs with what the truth answers there.
struct Judged {
    std::vector<LightView> pairs;
    std::vector<LedBands> truth;

    Judged(std::vector<LightView> from, const Scatterer& of) : pairs(std::move(from)) {
        for (const LightView& pair : pairs) truth.push_back(of.answer(pair).f);
    }
};

/// What the optimiser may not drop.
class Sink {
public:
    void take(const LedBands& f) { sum_ += f.value[0]; }
    void take(double value) { sum_ += value; }
    ~Sink() { asm volatile("" : : "x"(sum_)); }

private:
    double sum_ = 0;
};

template <class Lookup>
LookupErrors errorsOf(const Judged& at, const Lookup& lookup) {
    if (at.pairs.empty()) return {};
    std::vector<double> relative;
    double difference = 0, light = 0;
    for (std::size_t i = 0; i < at.pairs.size(); ++i) {
        const LedBands f = lookup(at.pairs[i]);
        double worst = 0;
        for (std::size_t band = 0; band < 3; ++band) {
            // No answer where there is one errs by all of it.
            const double value = std::isnan(f.value[band]) ? 0 : f.value[band];
            const double truth = at.truth[i].value[band];
            worst = std::max(worst, std::abs(value / truth - 1));
            difference += std::abs(value - truth);
            light += truth;
        }
        relative.push_back(worst);
    }
    std::sort(relative.begin(), relative.end());
    return {.worst = relative.back(),
            .p99 = relative[relative.size() * 99 / 100],
            .mean = difference / light};
}

/// In nanoseconds a pair; a clock that stands still makes it 0.
template <class Pass>
double leastTime(const Stopwatch& watch, int repeats, std::size_t pairs, const Pass& pass) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < repeats; ++i) {
        const Seconds begin = watch.elapsed();
        pass();
        least = std::min(least, (watch.elapsed() - begin).count());
    }
    return least / static_cast<double>(pairs) * 1e9;
}

template <class Lookup>
double scalarTime(const Stopwatch& watch, int repeats, const Judged& at, const Lookup& lookup) {
    return leastTime(watch, repeats, at.pairs.size(), [&] {
        Sink sink;
        for (const LightView& pair : at.pairs) sink.take(lookup(pair));
    });
}

/// Components of pairs, and room for their f.
class Arrays {
public:
    explicit Arrays(const std::vector<LightView>& pairs) {
        for (auto& values : values_) values.resize(pairs.size());
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                const auto axis = static_cast<Eigen::Index>(k);
                values_[k][i] = static_cast<float>(pairs[i].in.vector()[axis]);
                values_[k + 3][i] = static_cast<float>(pairs[i].out.vector()[axis]);
            }
        }
    }
    [[nodiscard]] PairArrays<float> pairs() const {
        return {values_[0], values_[1], values_[2], values_[3], values_[4], values_[5]};
    }
    [[nodiscard]] BandArrays<float> f() { return {values_[6], values_[7], values_[8]}; }

private:
    std::array<std::vector<float>, 9> values_;
};

double drawTime(const Stopwatch& watch, int repeats, const Judged& at, const LobeDraw& draw) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit;
    std::vector<Uniforms> numbers(at.pairs.size());
    for (Uniforms& one : numbers) one = {unit(random), unit(random), unit(random)};
    return leastTime(watch, repeats, at.pairs.size(), [&] {
        Sink sink;
        for (std::size_t i = 0; i < at.pairs.size(); ++i) {
            const auto drawn = draw.draw(at.pairs[i].in, numbers[i]);
            sink.take(drawn ? drawn->density : 0);
        }
    });
}

std::string text(const BoxResolution& resolution) {
    return std::to_string(resolution.tanHalf) + "x" + std::to_string(resolution.cosDiff) + "x" +
           std::to_string(resolution.skew);
}

/// One material of the sweep, with what all its rows are held against.
class MaterialStudy {
public:
    MaterialStudy(const LookupSweep& sweep,
                  const LookupMaterial& material,
                  const Scatterer& truth,
                  const Stopwatch& watch)
        : sweep_(sweep),
          material_(material),
          truth_(truth),
          watch_(watch),
          width_(halfWidthTangent(truth)),
          cosine_(cosinePairs({sweep.pairs, 1}), truth),
          lobe_(lobePairs({sweep.pairs, 2}, width_), truth),
          arrays_(cosine_.pairs) {}

    [[nodiscard]] Result<LookupRow> baked(const BakeOptions& options, bool carried) {
        std::unique_ptr<const AnalyticModel> carrier;
        if (carried) {
            auto made = makeModel(material_.carrier, kCarrierPath);
            if (!made) return made.error();
            carrier = std::move(*made);
        }
        const auto table = bakeTable(truth_, std::move(carrier), options);
        if (!table) return table.error();
        LookupRow row = judged([&](const LightView& pair) { return table->evaluate(pair); });
        row.method = carried ? "baked" : "baked, no carrier";
        row.resolution = text(options.resolution);
        row.storage = options.storage == TableStorage::Half ? "half" : "float";
        row.bytes = table->bytes();
        row.batchNs = leastTime(watch_, sweep_.repeats, cosine_.pairs.size(), [&] {
            table->evaluate(arrays_.pairs(), arrays_.f());
        });
        const LobeDraw draw(*table, lobesAbout(width_));
        row.drawNs = drawTime(watch_, sweep_.repeats, cosine_, draw);
        const Direction wi = Direction::fromSpherical(45_deg, Radians(0));
        row.draws = relativeVariance(*table, wi, draw.mixtureAt(wi));
        row.drawsByCosine = relativeVariance(*table, wi, {WeightedLobe{}});
        return row;
    }

    [[nodiscard]] LookupRow merl(const MerlLayout& table, MerlLookup how) const {
        LookupRow row = judged([&](const LightView& pair) { return table.evaluate(pair, how); });
        row.method = how == MerlLookup::Nearest ? "MERL nearest" : "MERL trilinear";
        row.resolution = "90x90x180";
        row.storage = "double";
        row.bytes = table.bytes();
        row.batchNs = row.drawNs = row.draws = row.drawsByCosine = kNan;
        return row;
    }

private:
    template <class Lookup>
    [[nodiscard]] LookupRow judged(const Lookup& lookup) const {
        LookupRow row;
        row.material = material_.name;
        row.cosine = errorsOf(cosine_, lookup);
        row.lobe = errorsOf(lobe_, lookup);
        row.scalarNs = scalarTime(watch_, sweep_.repeats, cosine_, lookup);
        return row;
    }

    const LookupSweep& sweep_;
    const LookupMaterial& material_;
    const Scatterer& truth_;
    const Stopwatch& watch_;
    double width_;
    Judged cosine_, lobe_;
    Arrays arrays_;
};

struct BakedKind {
    BakeOptions options;
    bool carried;
};

std::vector<BakedKind> kindsOf(const LookupSweep& sweep) {
    std::vector<BakedKind> kinds;
    for (const BoxResolution& resolution : sweep.resolutions) {
        for (const TableStorage storage : {TableStorage::Float, TableStorage::Half}) {
            for (const bool carried : {true, false}) {
                kinds.push_back({{.resolution = resolution, .storage = storage}, carried});
            }
        }
    }
    return kinds;
}

LookupMaterial twoLobes(double alpha, const std::string& second) {
    const std::string base = "lambert,albedo=0.3/0.2/0.1+ggx,";
    return {"ggx " + shortest(alpha) + " and " + second + " " + shortest(2 * alpha),
            base + "f0=0.04,alpha=" + shortest(alpha) + "+" + second +
                ",f0=0.03,alpha=" + shortest(2 * alpha),
            base + "f0=0.055,alpha=" + shortest(1.3 * alpha)};
}

}  // namespace

LookupSweep LookupSweep::full() {
    LookupSweep sweep;
    for (const double alpha : {0.16, 0.02}) {
        for (const char* second : {"ggx", "beckmann"}) {
            sweep.materials.push_back(twoLobes(alpha, second));
        }
    }
    sweep.resolutions = {{16, 8, 4},
                         {32, 16, 8},
                         {64, 24, 8},
                         {64, 32, 16},
                         {96, 32, 16},
                         {128, 48, 12},
                         {128, 48, 24}};
    return sweep;
}

LookupSweep LookupSweep::quick() {
    LookupSweep sweep;
    sweep.materials = {twoLobes(0.16, "ggx"), twoLobes(0.02, "ggx")};
    sweep.resolutions = {{16, 8, 4}, {32, 16, 8}, {64, 32, 16}};
    sweep.pairs = 4000;
    sweep.repeats = 3;
    return sweep;
}

Result<std::vector<LookupRow>> lookupStudy(const LookupSweep& sweep,
                                           const Stopwatch& watch,
                                           const StudyProgress& progress) {
    std::vector<LookupRow> rows;
    const std::vector<BakedKind> kinds = kindsOf(sweep);
    const std::size_t steps = sweep.materials.size() * (kinds.size() + (sweep.merl ? 2 : 0));
    const auto announce = [&] {
        if (progress) progress(rows.size(), steps);
    };
    for (const LookupMaterial& material : sweep.materials) {
        auto truth = makeModel(material.truth);
        if (!truth) return truth.error();
        MaterialStudy study(sweep, material, **truth, watch);
        for (const BakedKind& kind : kinds) {
            announce();
            auto row = study.baked(kind.options, kind.carried);
            if (!row) return row.error();
            rows.push_back(std::move(*row));
        }
        if (!sweep.merl) continue;
        const MerlLayout table(**truth);
        for (const MerlLookup how : {MerlLookup::Nearest, MerlLookup::Trilinear}) {
            announce();
            rows.push_back(study.merl(table, how));
        }
    }
    markFront(rows);
    return rows;
}

}  // namespace gonio::proc
