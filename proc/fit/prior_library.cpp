#include "proc/fit/prior_library.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"
#include "proc/models/published_fits.h"
#include "proc/models/spec.h"

namespace gonio::proc {
namespace {

/// splitmix64 [Steele2014]: the same numbers on every machine, which the standard library's
/// distributions do not promise.
class Draws {
public:
    explicit Draws(std::uint64_t seed) : state_(seed) {}

    double uniform(double low, double high) { return low + (high - low) * unit(); }
    double logUniform(double low, double high) {
        return std::exp(uniform(std::log(low), std::log(high)));
    }
    bool chance(double share) { return unit() < share; }
    std::size_t oneOf(std::size_t count) {
        return static_cast<std::size_t>(unit() * static_cast<double>(count));
    }

private:
    double unit() {
        state_ += 0x9e3779b97f4a7c15ULL;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
        return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }
    std::uint64_t state_;
};

std::string with(std::string_view key, double value) {
    return "," + std::string(key) + "=" + shortest(value);
}

std::string lobe(Draws& draws, double f0) {
    const std::size_t kind = draws.oneOf(3);
    const std::string width = with("alpha", draws.logUniform(0.04, 0.7));
    const std::string reflectance = with("f0", f0);
    if (kind == 0) return "ggx" + width + reflectance;
    if (kind == 1) return "beckmann" + width + reflectance;
    return "gtr" + width + with("gamma", draws.logUniform(1.2, 4)) + reflectance;
}

std::string diffuse(Draws& draws) {
    const std::string albedo = with("albedo", draws.logUniform(0.005, 0.9));
    if (draws.chance(0.5)) return "lambert" + albedo;
    return "oren-nayar" + albedo + with("sigma", draws.uniform(0.1, 0.9));
}

std::string material(Draws& draws) {
    const double f0 = draws.chance(0.5) ? draws.uniform(0.02, 0.1) : draws.uniform(0.15, 1);
    std::string spec = lobe(draws, f0);
    if (draws.chance(0.5)) spec += "+" + lobe(draws, draws.logUniform(0.003, 0.5));
    if (draws.chance(0.8)) spec += "+" + diffuse(draws);
    return spec;
}

/// Of the narrowest lobe that a published fit has, in the sense of alpha; 1 for a spec of none.
double widthOf(const std::string& spec) {
    double width = 1;
    for (const std::string key : {"alpha=", "m=", "roughness="}) {
        const std::size_t at = spec.find(key);
        if (at != std::string::npos)
            width = std::min(width, std::stod(spec.substr(at + key.size())));
    }
    const std::size_t n = spec.find(",n=");
    if (n != std::string::npos)
        width = std::min(width, std::sqrt(0.5 / std::stod(spec.substr(n + 3))));
    return width;
}

}  // namespace

PriorLibrary PriorLibrary::standard(std::size_t count, std::uint64_t seed) {
    PriorLibrary library;
    Draws draws(seed);
    for (std::size_t i = 0; i < count; ++i) library.specs.push_back(material(draws));
    return library;
}

Result<std::size_t> PriorLibrary::addPublishedFits(const std::filesystem::path& file) {
    const auto fits = readPublishedFits(file);
    if (!fits) return fits.error();
    constexpr double kNarrowest = 0.04;
    std::size_t added = 0;
    for (const PublishedFit& fit : *fits) {
        if (widthOf(fit.spec) < kNarrowest) continue;
        specs.push_back(fit.spec);
        ++added;
    }
    return added;
}

std::string PriorLibrary::text() const {
    std::string all = "# Materials of a statistical prior, a model's spec per line.\n";
    for (const std::string& spec : specs) all += spec + "\n";
    return all;
}

Result<PriorLibrary> PriorLibrary::read(const std::filesystem::path& file) {
    const Result<std::string> text = readFile(file);
    if (!text) return text.error();
    std::istringstream in(*text);
    PriorLibrary library;
    std::string line;
    for (std::size_t number = 1; std::getline(in, line); ++number) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (line.empty() || line.front() == '#') continue;
        const auto made = makeModel(line);
        if (!made) {
            return Error{ErrorKind::File,
                         "prior library " + file.string() + ": line " + std::to_string(number) +
                             ": " + made.error().message};
        }
        library.specs.push_back(line);
    }
    const std::size_t different = std::set(library.specs.begin(), library.specs.end()).size();
    if (different < kFewest) {
        return Error{ErrorKind::File,
                     "prior library " + file.string() + ": " + std::to_string(different) +
                         " materials that differ, wanted at least " + std::to_string(kFewest) +
                         "; `gonio prior build -o FILE` writes a library"};
    }
    return library;
}

}  // namespace gonio::proc
