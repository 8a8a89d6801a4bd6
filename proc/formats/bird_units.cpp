#include <algorithm>
#include <cmath>

#include "proc/core/flags.h"
#include "proc/core/number_text.h"
#include "proc/core/units.h"
#include "proc/formats/bird_columns.h"
#include "proc/formats/shown.h"

namespace gonio::proc::bird {
namespace {

class Converter {
public:
    explicit Converter(Columns& columns) : columns_(columns) {}

    std::string complaint() {
        if (complete()) convert();
        return complaint_;
    }

private:
    bool fail(const std::string& what) {
        complaint_ = what;
        return false;
    }
    [[nodiscard]] const std::vector<double>& of(Number number) const { return columns_.of(number); }
    [[nodiscard]] bool has(Number number) const { return columns_.has(number); }

    bool complete() {
        for (const Number number : {ThetaI, PhiI, ThetaR, PhiR, Value}) {
            if (!has(number)) return fail("there is no " + std::string(kNumberNames[number]));
        }
        columns_.entries = of(Value).size();
        const auto fits = [&](std::string_view name, std::size_t size) {
            return size == columns_.entries ||
                   fail(std::string(name) + ": " + std::to_string(size) + " values, BRDF has " +
                        std::to_string(columns_.entries));
        };
        for (std::size_t i = 0; i < kNumbers; ++i) {
            if (columns_.numbers[i].given &&
                !fits(kNumberNames[i], columns_.numbers[i].values.size())) {
                return false;
            }
        }
        for (std::size_t i = 0; i < kWords; ++i) {
            if (columns_.words[i].given && !fits(kWordNames[i], columns_.words[i].values.size()))
                return false;
        }
        return columns_.entries > 0 || fail("BRDF has no values");
    }

    bool unitOf(Number number, std::initializer_list<std::string_view> known) {
        const std::string& unit = columns_.numbers[number].unit;
        if (std::find(known.begin(), known.end(), unit) != known.end()) return true;
        std::string wanted;
        for (const std::string_view one : known) {
            wanted += (wanted.empty() ? "" : ", ") + std::string(one);
        }
        return fail(std::string(kNumberNames[number]) + ": unit " + shown(unit) + ", wanted " +
                    printable(wanted));
    }

    /// Angles to radians, wavelengths to nanometres, uncertainties to 1/sr.
    bool convert() {
        for (const Number number : {ThetaI, PhiI, ThetaR, PhiR}) {
            if (!unitOf(number, {"deg", "rad", "\xC2\xB0"})) return false;
            if (!toRadians(number)) return false;
        }
        for (const Number number : {WavelengthI, WavelengthR}) {
            // Both letters that look like a Greek mu.
            if (!has(number)) continue;
            if (!unitOf(number, {"nm", "\xCE\xBCm", "\xC2\xB5m", "um"})) return false;
            const double scale = columns_.numbers[number].unit == "nm" ? 1 : 1000;
            for (double& one : columns_.numbers[number].values) {
                one *= scale;
                if (one < 0) return fail(std::string(kNumberNames[number]) + ": " + shortest(one));
            }
        }
        if (!unitOf(Value, {"sr^-1", "1/sr", "sr-1"})) return false;
        return addNegative() && convertUncertainty() && checkFlags();
    }
    bool toRadians(Number number) {
        const bool radians = columns_.numbers[number].unit == "rad";
        const bool theta = number == ThetaI || number == ThetaR;
        const double most = radians ? kPi + 1e-5 : 180;
        for (double& one : columns_.numbers[number].values) {
            if (theta && (one < 0 || one > most)) {
                return fail(std::string(kNumberNames[number]) + ": " + shortest(one) +
                            ", wanted [0, 180] degrees");
            }
            if (!radians) one = Radians::fromDegrees(one).value();
        }
        return true;
    }
    bool addNegative() {
        std::vector<double>& f = columns_.numbers[Value].values;
        if (has(Negative)) {
            for (std::size_t i = 0; i < columns_.entries; ++i) {
                if (of(Negative)[i] < 0) f[i] += of(Negative)[i];
            }
        }
        const auto below = std::count_if(f.begin(), f.end(), [](double one) { return one < 0; });
        if (below > 0) columns_.warnings.push_back(std::to_string(below) + " negative values");
        return true;
    }
    bool convertUncertainty() {
        if (!has(Combined) && columns_.constantU) {
            columns_.numbers[Combined] = {
                true, columns_.constantUnit, std::vector(columns_.entries, *columns_.constantU)};
        }
        for (const Number number : {Combined, Random, Systematic}) {
            if (has(number) && !toInverseSteradians(number)) return false;
        }
        if (has(Combined) && !columns_.coverageIsSaid) {
            columns_.warnings.emplace_back("uBRDF taken as standard uncertainty (k = 1): not said");
        }
        return true;
    }
    bool toInverseSteradians(Number number) {
        if (!unitOf(number, {"sr^-1", "1/sr", "sr-1", "%"})) return false;
        std::vector<double>& u = columns_.numbers[number].values;
        for (std::size_t i = 0; i < columns_.entries; ++i) {
            if (u[i] < 0) {
                return fail(std::string(kNumberNames[number]) + ": " + shortest(u[i]) +
                            ", wanted 0 or more");
            }
            if (columns_.numbers[number].unit == "%") u[i] *= std::abs(of(Value)[i]) / 100;
        }
        return true;
    }
    bool checkFlags() {
        for (const double mask : of(FlagMask)) {
            if (!(mask >= 0 && mask < 1 << kFlagCount && mask == std::floor(mask))) {
                return fail("flags: " + shortest(mask) + ", wanted a mask of " +
                            std::to_string(kFlagCount) + " flags");
            }
        }
        return true;
    }

    Columns& columns_;
    std::string complaint_;
};

}  // namespace

std::string convertColumns(Columns& columns) { return Converter(columns).complaint(); }

}  // namespace gonio::proc::bird
