#include "proc/formats/speos_binary.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>

#include "proc/core/number_text.h"
#include "proc/formats/lz4_block.h"
#include "proc/formats/shown.h"
#include "proc/formats/speos.h"
#include "proc/formats/speos_values.h"

namespace gonio::proc {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they stand");

/// What an axis may hold, in degrees.
struct AxisRule {
    std::string_view name;
    double low = 0, high = 0;
};
constexpr AxisRule kIncidences{"incidence", 0, 89.999999};
constexpr AxisRule kThetas{"theta", 0, 90};
constexpr AxisRule kPhis{"phi", 0, 360};

/// Per incidence behind the tables, and behind all of them.
constexpr std::size_t kConeBytes = 32;
constexpr std::size_t kEndBytes = 9;

class Reader {
public:
    Reader(std::string_view bytes, std::string_view name, std::size_t start)
        : bytes_(bytes), name_(name), at_(start), unpackable_(kSpeosMostUnpacked * bytes.size()) {}

    Result<FileRead<SphericalTable>> read() {
        if (!header() || !spectrum() || !tables() || !end()) return *error_;
        out_.about.set(key::kCosine, "yes");
        settle(out_, SpeosOrigin::Binary);
        return std::move(out_);
    }

private:
    bool fail(const std::string& what) {
        if (!error_) {
            error_ = Error{
                ErrorKind::File,
                "speos: " + std::string(name_) + ": byte " + std::to_string(at_) + ": " + what};
        }
        return false;
    }
    [[nodiscard]] std::size_t bytesLeft() const { return bytes_.size() - at_; }

    template <class T>
    bool take(T& into, const std::string& what) {
        if (bytesLeft() < sizeof(T)) return fail("the file ends, wanted " + what);
        std::memcpy(&into, bytes_.data() + at_, sizeof(T));
        at_ += sizeof(T);
        return true;
    }
    /// A field that must have the one value that is known.
    template <class T>
    bool known(T wanted, const std::string& what) {
        T seen{};
        if (!take(seen, what)) return false;
        if (seen == wanted) return true;
        at_ -= sizeof(T);
        return fail(what + " is not as in the binary files that are known: export it as text");
    }
    bool number(double& into, const std::string& what, double low, double high) {
        if (!take(into, what)) return false;
        return (into >= low && into <= high) || fail(what + " " + shortest(into) + ", wanted [" +
                                                     shortest(low) + ", " + shortest(high) + "]");
    }
    bool count(std::size_t& into, const std::string& what) {
        std::uint32_t value = 0;
        if (!take(value, "the number of " + what)) return false;
        into = value;
        return value > 0 || fail("no " + what);
    }

    bool array(std::vector<double>& into, std::size_t size, const std::string& what) {
        std::uint64_t whole = 0;
        std::uint32_t part = 0;
        std::uint32_t packed = 0;
        const std::string sizes = "the sizes of " + what;
        if (!take(whole, sizes) || !take(part, sizes) || !take(packed, sizes)) return false;
        std::size_t wanted = 0;
        if (__builtin_mul_overflow(size, sizeof(double), &wanted) || whole != wanted ||
            part != whole) {
            return fail(what + " takes " + std::to_string(whole) + " bytes, wanted 8 each of " +
                        std::to_string(size));
        }
        if (packed > bytesLeft()) {
            return fail(what + " is packed in " + std::to_string(packed) + " bytes, " +
                        std::to_string(bytesLeft()) + " are left");
        }
        if (wanted > unpackable_) {
            return fail(what + " unpacks to more than " + std::to_string(kSpeosMostUnpacked) +
                        " times the file");
        }
        unpackable_ -= wanted;
        const auto unpacked = decodeLz4(bytes_.substr(at_, packed), wanted);
        if (!unpacked)
            return fail(what + " is no LZ4 block of " + std::to_string(wanted) + " bytes");
        into.resize(size);
        std::memcpy(into.data(), unpacked->data(), wanted);
        if (!std::all_of(into.begin(), into.end(), [](double v) { return std::isfinite(v); })) {
            return fail(what + " holds what is no finite number");
        }
        at_ += packed;
        return true;
    }

    bool axis(std::vector<double>& into, std::size_t size, const AxisRule& rule) {
        if (!array(into, size, std::string(rule.name))) return false;
        for (std::size_t i = 0; i < size; ++i) {
            if (into[i] < rule.low || into[i] > rule.high ||
                (i > 0 && into[i] < into[i - 1] + kFinestStepDeg)) {
                return fail(std::string(rule.name) + " " + shortest(into[i]) +
                            ", wanted ascending in [" + shortest(rule.low) + ", " +
                            shortest(rule.high) + "]");
            }
        }
        return true;
    }

    bool header() {
        std::size_t characters = 0;
        if (!known('1', "mode") || !known(std::uint32_t{3}, "the field before the description") ||
            !count(characters, "characters of the description")) {
            return false;
        }
        if (characters > bytesLeft()) {
            return fail("a description of " + std::to_string(characters) + " characters, " +
                        std::to_string(bytesLeft()) + " bytes are left");
        }
        const std::string_view text = bytes_.substr(at_, characters);
        at_ += characters;
        const std::string description = printable(text.substr(0, text.find('\0')));
        if (!description.empty()) out_.about.comments.push_back(description);
        double vector = 0;
        for (int i = 0; i < 3; ++i) {
            if (!number(vector, "anisotropy vector", -1e9, 1e9)) return false;
        }
        return known(std::uint64_t{0}, "the field behind the vector") &&
               known('\1', "reflection") && known('\0', "transmission") &&
               known(1.0, "the first factor") && known(1.0, "the second factor") &&
               known('\0', "the kind of values") &&
               known('\0', "the field behind the kind of values") && incidences();
    }

    bool incidences() {
        std::vector<double> angles;
        std::size_t count = 0;
        if (!known(std::uint32_t{1}, "the number of anisotropy angles") ||
            !array(angles, 1, "anisotropy angle") || !this->count(count, "incidences") ||
            !axis(incidenceDeg_, count, kIncidences)) {
            return false;
        }
        lightAzimuthDeg_ = lightAzimuthOf(angles[0]);
        return std::abs(angles[0]) <= 360 || fail("anisotropy angle " + shortest(angles[0]));
    }

    bool spectrum() {
        std::size_t rows = 0;
        double theta = 0;
        double phi = 0;
        if (!number(theta, "theta of the spectrum", 0, 90) ||
            !number(phi, "phi of the spectrum", -360, 360) ||
            !known(std::uint32_t{0}, "the field before the spectrum") ||
            !count(rows, "wavelengths")) {
            return false;
        }
        if (rows > bytesLeft() / 16) {
            return fail(std::to_string(rows) + " wavelengths, " + std::to_string(bytesLeft()) +
                        " bytes are left");
        }
        std::vector<double> nanometres(rows);
        std::string text;
        for (double& nm : nanometres) {
            if (!number(nm, "wavelength", 1e-3, 1e9)) return false;
        }
        for (const double nm : nanometres) {
            double percent = 0;
            if (!number(percent, "per cent", 0, std::numeric_limits<double>::max())) return false;
            text += (text.empty() ? "" : ", ") + shortest(nm) + " " + shortest(percent);
        }
        out_.content.channels = {rows == 1 ? Channel::at(nanometres[0]) : Channel{}};
        out_.about.set(kSpeosSpectrum, text);
        return true;
    }

    bool tables() {
        for (const double incidence : incidenceDeg_) {
            SphericalBlock block{.lightAzimuthDeg = lightAzimuthDeg_, .incidenceDeg = incidence};
            std::size_t thetas = 0;
            std::size_t phis = 0;
            std::size_t values = 0;
            std::vector<double> rows;
            if (!count(thetas, "thetas") || !count(phis, "phis") ||
                !axis(block.thetaDeg, thetas, kThetas) || !axis(block.azimuthDeg, phis, kPhis)) {
                return false;
            }
            if (__builtin_mul_overflow(thetas, phis, &values)) return fail("table too large");
            if (!array(rows, values, "table")) return false;
            block.f.resize(values);
            for (std::size_t t = 0; t < thetas; ++t) {
                for (std::size_t a = 0; a < phis; ++a)
                    block.f[block.index(a, t)] = rows[t * phis + a];
            }
            divideByCosine(block);
            out_.content.blocks.push_back(std::move(block));
        }
        return true;
    }

    bool end() {
        const std::size_t wanted = kConeBytes * incidenceDeg_.size() + kEndBytes;
        return bytesLeft() == wanted ||
               fail(std::to_string(bytesLeft()) + " bytes behind the tables, wanted " +
                    std::to_string(wanted));
    }

    std::string_view bytes_;
    std::string_view name_;
    std::size_t at_ = 0;
    std::size_t unpackable_ = 0;
    double lightAzimuthDeg_ = 0;
    std::vector<double> incidenceDeg_;
    FileRead<SphericalTable> out_{.content = {}, .about = {}};
    std::optional<Error> error_;
};

}  // namespace

Result<FileRead<SphericalTable>> parseSpeosBinary(std::string_view bytes,
                                                  std::string_view name,
                                                  std::size_t start) {
    return Reader(bytes, name, start).read();
}

}  // namespace gonio::proc
