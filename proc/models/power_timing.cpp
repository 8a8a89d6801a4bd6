#include "proc/models/power_timing.h"

#include <algorithm>
#include <map>
#include <optional>
#include <random>

namespace gonio::proc {
namespace {

constexpr std::size_t kCount = 4096;

template <std::floating_point T>
struct PowerArrays {
    std::vector<T> n = std::vector<T>(kCount);
    std::vector<T> c = std::vector<T>(kCount);
    std::vector<T> cubicA = std::vector<T>(kCount);
    std::vector<T> cubicSlope = std::vector<T>(kCount);
    std::vector<T> cubicTCut = std::vector<T>(kCount);
    std::vector<T> out = std::vector<T>(kCount);

    PowerArrays() {
        std::mt19937_64 random(8);
        std::uniform_real_distribution<double> share;
        for (std::size_t i = 0; i < kCount; ++i) {
            const double power = 8 * std::pow(125.0, share(random));
            const double t = std::min(1.0, 12 * share(random) / power);
            const CubicCoefficients cubic = cubicCoefficients(power);
            n[i] = static_cast<T>(power);
            c[i] = static_cast<T>(1 - t);
            cubicA[i] = static_cast<T>(cubic.a);
            cubicSlope[i] = static_cast<T>(cubic.slope);
            cubicTCut[i] = static_cast<T>(cubic.tCut);
        }
    }
};

template <PowerForm Form>
struct OfForm {
    template <std::floating_point T>
    static T at(const PowerArrays<T>& in, std::size_t i) {
        const NearOne<T> x{.c = in.c[i], .t = T(1) - in.c[i]};
        if constexpr (Form == PowerForm::Cubic) {
            return cubicPower({in.cubicA[i], in.cubicSlope[i], in.cubicTCut[i]}, x);
        } else {
            return power<Form>(in.n[i], x);
        }
    }
};

struct OfLibrary {
    template <std::floating_point T>
    static T at(const PowerArrays<T>& in, std::size_t i) {
        return std::pow(in.c[i], in.n[i]);
    }
};

// `flatten` and not `inline`: a form that was not inlined would be called, one at a time.
template <class Form, class T>
[[gnu::flatten]] void baseline(PowerArrays<T>& arrays) {
    T* out = arrays.out.data();
    for (std::size_t i = 0; i < kCount; ++i) out[i] = Form::at(arrays, i);
}

template <class Form, class T>
[[gnu::flatten, gnu::target("arch=x86-64-v3")]] void avx2(PowerArrays<T>& arrays) {
    T* out = arrays.out.data();
    for (std::size_t i = 0; i < kCount; ++i) out[i] = Form::at(arrays, i);
}

template <class Form, class T>
[[gnu::flatten, gnu::target("arch=x86-64-v4")]] void avx512(PowerArrays<T>& arrays) {
    T* out = arrays.out.data();
    for (std::size_t i = 0; i < kCount; ++i) out[i] = Form::at(arrays, i);
}

template <class Form, class T>
[[gnu::flatten]] void scalar(PowerArrays<T>& arrays) {
    T* out = arrays.out.data();
    for (std::size_t i = 0; i < kCount; ++i) {
        T value = Form::at(arrays, i);
        // The value must be in a register of its own: the compiler cannot make vectors of it.
        asm volatile("" : "+x"(value));
        out[i] = value;
    }
}

template <class T>
struct TimedLoop {
    PowerTime time;
    void (*run)(PowerArrays<T>&);
    int passes = 1;
};

template <class Form, class T>
TimedLoop<T> loopOf(const std::string& form, PowerCode code) {
    TimedLoop<T> loop;
    loop.time.form = form;
    loop.time.precision = std::is_same_v<T, float> ? Precision::Float : Precision::Double;
    loop.time.code = code;
    loop.time.nanoseconds = std::numeric_limits<double>::infinity();
    switch (code) {
        case PowerCode::Scalar: loop.run = scalar<Form, T>; break;
        case PowerCode::Baseline: loop.run = baseline<Form, T>; break;
        case PowerCode::Avx2: loop.run = avx2<Form, T>; break;
        case PowerCode::Avx512: loop.run = avx512<Form, T>; break;
    }
    return loop;
}

template <class T, PowerForm... Forms>
void addLoops(std::vector<TimedLoop<T>>& loops, PowerCode code) {
    (loops.push_back(loopOf<OfForm<Forms>, T>(std::string(name(Forms)), code)), ...);
    loops.push_back(loopOf<OfLibrary, T>("std::pow", code));
}

template <class T>
class Bench {
public:
    Bench() {
        using enum PowerForm;
        for (const PowerCode code : powerCodes()) {
            addLoops<T,
                     Full75,
                     Full54,
                     Lite,
                     Sq8d3,
                     Sq8,
                     Rec3m4,
                     Rec2m4,
                     Schlick,
                     Bps,
                     F8,
                     Quadratic,
                     Cubic,
                     Gauss,
                     Lagarde,
                     Pow>(loops_, code);
        }
    }

    /// The second of two passes says how many fill the wanted time.
    void warmUp(const Stopwatch& watch, Seconds each) {
        for (TimedLoop<T>& loop : loops_) {
            loop.run(arrays_);
            const double pass = passTime(loop, watch);
            loop.passes = static_cast<int>(std::clamp(std::round(each.count() / pass), 1.0, 1e4));
        }
    }

    void repeat(const Stopwatch& watch) {
        for (TimedLoop<T>& loop : loops_) {
            const double each = passTime(loop, watch) / kCount * 1e9;
            loop.time.nanoseconds = std::min(loop.time.nanoseconds, each);
        }
    }

    /// The scalar loops come first.
    double largestDifference() {
        std::map<std::string, std::vector<T>> scalars;
        double largest = 0;
        for (const TimedLoop<T>& loop : loops_) {
            std::ranges::fill(arrays_.out, std::numeric_limits<T>::infinity());
            loop.run(arrays_);
            const auto [known, isNew] = scalars.try_emplace(loop.time.form, arrays_.out);
            for (std::size_t i = 0; i < kCount && !isNew; ++i) {
                const double difference = std::abs(arrays_.out[i] - known->second[i]);
                largest = difference <= largest ? largest : difference;  // NaN is kept
            }
        }
        return largest;
    }

    void giveTo(std::vector<PowerTime>& times) const {
        for (const TimedLoop<T>& loop : loops_) times.push_back(loop.time);
    }

private:
    /// In seconds; a clock that stands still makes it a nanosecond.
    double passTime(const TimedLoop<T>& loop, const Stopwatch& watch) {
        const Seconds begin = watch.elapsed();
        for (int i = 0; i < loop.passes; ++i) loop.run(arrays_);
        return std::max(1e-9, (watch.elapsed() - begin).count() / loop.passes);
    }

    PowerArrays<T> arrays_;
    std::vector<TimedLoop<T>> loops_;
};

std::optional<double> timeOf(std::span<const PowerTime> times,
                             std::string_view form,
                             const PowerTime& like) {
    for (const PowerTime& time : times) {
        if (time.form == form && time.precision == like.precision && time.code == like.code) {
            return time.nanoseconds;
        }
    }
    return std::nullopt;
}

/// The fastest of ours that errs no more than `rival`, at `time`'s precision and code.
std::optional<NotBeaten> fastestOfOurs(std::span<const PowerErrors> errors,
                                       std::span<const PowerTime> times,
                                       const PowerErrors& rival,
                                       const PowerTime& time) {
    std::optional<NotBeaten> best;
    for (const PowerErrors& ours : errors) {
        if (!isOurs(ours.form) || ours.precision != rival.precision) continue;
        if (ours.absolute > rival.absolute) continue;
        const std::optional<double> needs = timeOf(times, name(ours.form), time);
        if (!needs || (best && best->oursNanoseconds <= *needs)) continue;
        best = NotBeaten{.form = rival.form,
                         .precision = rival.precision,
                         .code = time.code,
                         .nanoseconds = time.nanoseconds,
                         .ours = ours.form,
                         .oursNanoseconds = *needs};
    }
    return best;
}

}  // namespace

std::string_view name(PowerCode code) {
    switch (code) {
        case PowerCode::Scalar: return "scalar";
        case PowerCode::Baseline: return "x86-64";
        case PowerCode::Avx2: return "x86-64-v3";
        case PowerCode::Avx512: return "x86-64-v4";
    }
    return "";
}

std::vector<PowerCode> powerCodes() {
    std::vector<PowerCode> codes{PowerCode::Scalar, PowerCode::Baseline};
    // Clang 16 does not know the levels by name; these are what tells one from the next.
    __builtin_cpu_init();
    const bool avx2 = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0 &&
                      __builtin_cpu_supports("bmi") != 0 && __builtin_cpu_supports("bmi2") != 0;
    const bool avx512 =
        __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
        __builtin_cpu_supports("avx512cd") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
        __builtin_cpu_supports("avx512vl") != 0;
    if (avx2) codes.push_back(PowerCode::Avx2);
    if (avx2 && avx512) codes.push_back(PowerCode::Avx512);
    return codes;
}

std::vector<PowerTime> timePowers(const Stopwatch& watch,
                                  const TimingEffort& effort,
                                  const StudyProgress& progress) {
    Bench<double> exact;
    Bench<float> narrow;
    exact.warmUp(watch, effort.each);
    narrow.warmUp(watch, effort.each);
    const auto repeats = static_cast<std::size_t>(effort.repeats);
    for (std::size_t i = 0; i < repeats; ++i) {
        if (progress) progress(i, repeats);
        exact.repeat(watch);
        narrow.repeat(watch);
    }
    std::vector<PowerTime> times;
    exact.giveTo(times);
    narrow.giveTo(times);
    return times;
}

double largestLoopDifference() {
    return std::max(Bench<double>().largestDifference(), Bench<float>().largestDifference());
}

std::vector<NotBeaten> notBeaten(std::span<const PowerErrors> errors,
                                 std::span<const PowerTime> times) {
    std::vector<NotBeaten> all;
    for (const PowerTime& time : times) {
        for (const PowerErrors& rival : errors) {
            const bool published = !isOurs(rival.form) && rival.form != PowerForm::Pow;
            if (!published || rival.precision != time.precision || name(rival.form) != time.form) {
                continue;
            }
            const auto best = fastestOfOurs(errors, times, rival, time);
            if (best && best->oursNanoseconds > time.nanoseconds) all.push_back(*best);
        }
    }
    return all;
}

}  // namespace gonio::proc
