// What files cost to read and to write, from bytes in memory to the table and back, beside a plain
// copy of the bytes in the same run: the ratio of the two is what other machines can be held to.

#include <benchmark/benchmark.h>

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>

#include "proc/formats/bird.h"
#include "proc/formats/gonio_exr.h"
#include "proc/formats/merl.h"
#include "proc/formats/rgl.h"
#include "proc/formats/zemax.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

template <class T>
T good(Result<T> result) {
    if (!result) throw std::runtime_error(result.error().message);
    return std::move(*result);
}

void bytesOf(benchmark::State& state, const std::string& bytes) {
    state.counters["file"] =
        benchmark::Counter(static_cast<double>(bytes.size()), {}, benchmark::Counter::kIs1024);
    state.SetBytesProcessed(static_cast<std::int64_t>(bytes.size()) *
                            static_cast<std::int64_t>(state.iterations()));
}

/// The plain read: the file's bytes into memory of their own.
void copied(benchmark::State& state, const std::string& bytes) {
    for (auto _ : state) {
        std::string copy(bytes);
        benchmark::DoNotOptimize(copy.data());
    }
    bytesOf(state, bytes);
}

template <class Read>
void readBy(benchmark::State& state, const std::string& bytes, const Read& read) {
    for (auto _ : state) {
        auto table = read(bytes);
        if (!table) throw std::runtime_error(table.error().message);
        benchmark::DoNotOptimize(table);
    }
    bytesOf(state, bytes);
}

template <class Write>
void writtenBy(benchmark::State& state, const std::string& bytes, const Write& write) {
    for (auto _ : state) {
        auto written = write();
        benchmark::DoNotOptimize(written);
    }
    bytesOf(state, bytes);
}

/// What a benchmark works on, made when the first one that is asked for needs it.
template <class T>
class Lazy {
public:
    explicit Lazy(std::function<T()> make) : make_(std::move(make)) {}
    const T& operator*() {
        if (!made_) made_ = make_();
        return *made_;
    }

private:
    std::function<T()> make_;
    std::optional<T> made_;
};

/// Registers the plain copy, the reading and the writing of one file. `encode` takes what `make`
/// makes to bytes, `decode` takes them back.
template <class Make, class Encode, class Decode>
void measure(const std::string& name, Make make, Encode encode, Decode decode) {
    auto table = std::make_shared<Lazy<decltype(make())>>(make);
    auto bytes = std::make_shared<Lazy<std::string>>([=] { return encode(**table); });
    const auto add = [&](const char* what, std::function<void(benchmark::State&)> run) {
        auto* bench = benchmark::RegisterBenchmark((name + what).c_str(), std::move(run));
        bench->Unit(benchmark::kMillisecond)->Repetitions(7)->ReportAggregatesOnly();
        bench->UseRealTime()->MeasureProcessCPUTime()->MinTime(0.1);
    };
    add("/copy", [=](auto& state) { copied(state, **bytes); });
    add("/read", [=](auto& state) { readBy(state, **bytes, decode); });
    add("/write", [=](auto& state) { writtenBy(state, **bytes, [&] { return encode(**table); }); });
}

/// A lobe over a floor, with 1 % of noise: as hard to pack as what is measured.
double noisy(double theta, std::mt19937_64& random) {
    std::normal_distribution<double> noise(1, 0.01);
    return (0.2 + 3 * std::exp(-theta * theta / 300)) * noise(random);
}

/// 4 incidences x 361 azimuths x 181 radials, X, Y and Z; `digits` significant ones, 0: all.
SpecularTable zemaxTable(int digits) {
    SpecularTable table;
    table.symmetry = TableSymmetry::Asymmetrical;
    table.colour = TableColour::Xyz;
    table.incidenceDeg = {0, 20, 40, 60};
    for (int a = 0; a <= 360; ++a) table.azimuthDeg.push_back(a);
    for (int r = 0; r <= 180; ++r) table.radialDeg.push_back(r);
    std::mt19937_64 random(1);
    table.planes.resize(3);
    for (TablePlane& plane : table.planes) {
        plane.tis.assign(table.incidenceDeg.size(), 0.5);
        for (std::size_t i = 0; i < table.nodeCount(); ++i) {
            double f = noisy(static_cast<double>(i % table.radialDeg.size()), random);
            if (digits > 0) {
                const double unit = std::pow(10, std::floor(std::log10(f)) + 1 - digits);
                f = std::stod(std::to_string(std::round(f / unit)) + "e" +
                              std::to_string(static_cast<int>(std::lround(std::log10(unit)))));
            }
            plane.f.push_back(f);
        }
    }
    return table;
}

SampleSet gonioSample() {
    std::mt19937_64 random(1);
    return test::sampleSet([&](Radians incidence, const Direction& wo) {
        return noisy(std::abs(wo.theta().degrees() - incidence.degrees()), random);
    });
}

/// MERL's own size; every value there.
HalfDifferenceTable merlTable() {
    HalfDifferenceTable table;
    std::mt19937_64 random(1);
    for (auto& plane : table.planes) {
        for (std::size_t i = 0; i < table.nodeCount(); ++i) {
            plane.push_back(noisy(static_cast<double>(i % 90), random));
        }
    }
    return table;
}

/// As large as RGL's isotropic rgb files: 8 incidences, 128 x 128 visible normals, 32 x 32 values.
TensorTable rglTable() {
    std::mt19937_64 random(1);
    const auto grid = [&](std::size_t slices, std::size_t width, std::size_t height) {
        GridStack stack{.width = width, .height = height, .values = {}};
        for (std::size_t i = 0; i < slices * width * height; ++i) {
            stack.values.push_back(static_cast<float>(noisy(30, random)));
        }
        return stack;
    };
    TensorTable table;
    table.phiIn = {0};
    for (int k = 0; k < 8; ++k) table.thetaIn.push_back(0.2F * static_cast<float>(k));
    table.ndf = table.sigma = grid(1, 128, 2);
    table.vndf = grid(8, 128, 128);
    table.luminance = grid(8, 32, 32);
    table.channels = {{"R", {}}, {"G", {}}, {"B", {}}};
    table.values = grid(24, 32, 32);
    return table;
}

/// 4 incidences x 25 000 directions x 3 bands: 300 000 entries, with uncertainties and flags or
/// not.
BrdfRows birdRows(bool measured) {
    std::mt19937_64 random(1);
    BrdfRows rows;
    rows.channels = Channel::ofBands();
    for (const double incidence : {0.0, 20.0, 40.0, 60.0}) {
        for (int i = 0; i < 25'000; ++i) {
            const double theta = 0.003 * i;
            rows.pairs.push_back(
                {.in = Direction::fromSpherical(Radians::fromDegrees(incidence), 0_deg),
                 .out = Direction::fromSpherical(Radians::fromDegrees(theta),
                                                 Radians::fromDegrees(std::fmod(137.5 * i, 360)))});
            for (int band = 0; band < 3; ++band) {
                rows.f.push_back(noisy(std::abs(theta - incidence), random));
                if (!measured) continue;
                rows.uRandom.push_back(0.01 * rows.f.back());
                rows.uSystematic.push_back(0.02 * rows.f.back());
                rows.flags.push_back(Flags{Flag::Measured});
            }
        }
    }
    return rows;
}

void registerAll() {
    for (const int digits : {7, 0}) {
        measure(
            "zemax 4x361x181 XYZ, " + (digits > 0 ? std::to_string(digits) : "all") + " digits",
            [=] { return zemaxTable(digits); },
            [](const SpecularTable& table) { return writeZemax(table).bytes; },
            [](std::string_view bytes) { return parseZemax(bytes, "in"); });
    }
    measure(
        "gonio 4 LEDs x 3 bands",
        gonioSample,
        [](const SampleSet& sample) { return good(encodeGonio(sample)); },
        [](std::string_view bytes) { return decodeGonio(bytes, "in"); });
    measure(
        "merl 90x90x180",
        merlTable,
        [](const HalfDifferenceTable& table) { return writeMerl(table).bytes; },
        [](std::string_view bytes) { return parseMerl(bytes, "in"); });
    measure(
        "rgl 8 incidences rgb",
        rglTable,
        [](const TensorTable& table) { return good(writeRgl(table)).bytes; },
        [](std::string_view bytes) { return parseRgl(bytes, "in"); });
    for (const bool measured : {false, true}) {
        measure(
            std::string("bird 300 000 rows") + (measured ? " with u and flags" : ""),
            [=] { return birdRows(measured); },
            [](const BrdfRows& rows) { return writeBird(rows, {})->bytes; },
            [](std::string_view bytes) { return parseBird(bytes, "in"); });
    }
}

}  // namespace
}  // namespace gonio::proc

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    gonio::proc::registerAll();
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
