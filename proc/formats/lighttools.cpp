#include "proc/formats/lighttools.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "proc/core/number_text.h"
#include "proc/formats/far_side.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/shown.h"
#include "proc/formats/spherical_warnings.h"
#include "proc/formats/words.h"

namespace gonio::proc {
namespace {

constexpr std::array<std::string_view, 3> kTristimulus{"trisx", "trisy", "trisz"};

/// A block's keywords, before it is known which blocks are read.
struct Head {
    std::optional<double> incidence, plane, wavelength, tis;
    std::optional<bool> back, transmission;
    std::optional<std::size_t> tristimulus;

    [[nodiscard]] bool fromBehind() const { return back.value_or(false) || *incidence > 90; }
};

double foldedIncidence(const Head& head) {
    return roundedDegrees(std::min(*head.incidence, 180 - *head.incidence));
}
double lightAzimuth(const Head& head) {
    const double plane = head.plane.value_or(0);
    const double azimuth = roundedDegrees(plane - 360 * std::floor(plane / 360));
    return azimuth >= 360 ? 0 : azimuth;
}

struct ReadBlock {
    Head head;
    std::vector<double> f;  ///< azimuth > radial, as the file has it
};

/// Reads one text. The first complaint stops it: each step answers false once there is an error.
class Reader {
public:
    Reader(std::string_view text, std::string_view name) : words_(text), name_(name) {}

    Result<FileRead<SphericalTable>> read(VendorExtrapolation beyond) {
        if (!header() || !blocks()) return *error_;
        if (!words_.done() && !failSeen("nothing after DataEnd")) return *error_;
        if (words_.tooManyComments() &&
            !fail("more than " + std::to_string(Words::kMostComments) + " comments")) {
            return *error_;
        }
        FileRead<SphericalTable> out{.content = {},
                                     .about = metadataOfLines(words_.takeComments())};
        if (miniDiff() && beyond == VendorExtrapolation::Masked) mask(out.warnings);
        chooseSide(out);
        fill(out.content);
        if (!out.content.isotropic() || out.content.blocks.front().lightAzimuthDeg != 0) {
            out.warnings.emplace_back(
                "POI is read as the light's azimuth, scatter azimuths as counted from its plane: "
                "no file was there to check it");
        }
        for (std::string& warning : sphericalWarnings(out.content)) {
            out.warnings.push_back(std::move(warning));
        }
        return out;
    }

private:
    bool fail(const std::string& what) {
        if (!error_) {
            error_ = Error{ErrorKind::File,
                           "lighttools: " + std::string(name_) + ": line " +
                               std::to_string(words_.line()) + ": " + what};
        }
        return false;
    }
    bool failSeen(const std::string& wanted) {
        if (words_.done()) return fail("the text ends, wanted " + wanted);
        return fail(shown(words_.peek()) + ", wanted " + wanted);
    }

    bool header() {
        std::set<std::string> seen;
        while (lower(words_.peek()) != "databegin") {
            if (words_.done()) return fail("the text ends, wanted " + missing(seen));
            const std::string key = lower(words_.peek());
            if (!seen.insert(key).second) return fail(shown(words_.peek()) + " is given twice");
            if (!headerLine(key)) return false;
        }
        if (missing(seen) != "DataBegin") {
            return fail("data begin, but the header has no " + missing(seen));
        }
        words_.take();
        return true;
    }

    [[nodiscard]] static std::string missing(const std::set<std::string>& seen) {
        for (const char* keyword :
             {"Symmetry", "SpectralContent", "ScatterAzimuth", "ScatterRadial"}) {
            if (!seen.contains(lower(keyword))) return keyword;
        }
        return "DataBegin";
    }

    bool headerLine(const std::string& key) {
        if (key == "symmetry") {
            return choose<bool>(
                symmetrical_,
                {{"PlaneSymmetrical", true}, {"Asymmetric", false}, {"Asymmetrical", false}});
        }
        if (key == "spectralcontent") {
            return choose<bool>(xyz_, {{"Monochrome", false}, {"XYZ", true}});
        }
        if (key == "scatterazimuth") return axis("ScatterAzimuth", 360, azimuthDeg_);
        if (key == "scatterradial") return axis("ScatterRadial", 90, radialDeg_);
        return fail("unknown keyword " + shown(words_.peek()));
    }

    template <class T, class Into>
    bool choose(Into& into, const std::vector<std::pair<std::string_view, T>>& choices) {
        const std::string keyword(words_.take());
        const std::string value = lower(words_.peek());
        std::string names;
        for (const auto& [name, choice] : choices) {
            if (lower(name) == value) {
                into = choice;
                words_.take();
                return true;
            }
            names += (names.empty() ? "" : ", ") + std::string(name);
        }
        return failSeen(keyword + " " + names);
    }

    bool axis(const std::string& keyword, double most, std::vector<double>& into) {
        words_.take();
        const auto count = parseInteger(words_.peek());
        if (!count || *count < 1) return failSeen("the number of values of " + keyword);
        words_.take();
        if (static_cast<std::uint64_t>(*count) > words_.bytesLeft() / 2 + 1) {
            return fail(keyword + " promises " + std::to_string(*count) + " values, " +
                        std::to_string(words_.bytesLeft()) + " bytes are left");
        }
        for (std::int64_t i = 0; i < *count; ++i) {
            const auto value = parseDouble(words_.peek());
            if (!value || *value < 0 || *value > most) {
                return failSeen("degrees in [0, " + shortest(most) + "], number " +
                                std::to_string(i + 1) + " of the " + std::to_string(*count) +
                                " of " + keyword);
            }
            if (!into.empty() && *value < into.back() + kFinestStepDeg) {
                return failSeen("more than " + shortest(into.back()) + ": " + keyword +
                                " must ascend");
            }
            words_.take();
            into.push_back(*value);
        }
        return true;
    }

    bool blocks() {
        while (lower(words_.peek()) != "dataend") {
            if (!block()) return false;
        }
        words_.take();
        return !blocks_.empty() || fail("DataEnd, wanted a block of data");
    }

    bool block() {
        ReadBlock block;
        while (!block.head.tis) {
            if (!blockLine(block.head)) return false;
        }
        if (!isWhole(block.head) || !isNew(block.head) || !values(block.f)) return false;
        blocks_.push_back(std::move(block));
        return true;
    }

    bool blockLine(Head& head) {
        const std::string key = lower(words_.peek());
        if (key == "aoi") return number(head.incidence, 0, 180);
        if (key == "poi") return number(head.plane, -360, 360);
        if (key == "wavelength") return number(head.wavelength, 0, 1e9);
        if (key == "tis") return number(head.tis, std::numeric_limits<double>::lowest(), 1e300);
        if (key == "side") {
            return once(head.back) && choose<bool>(head.back, {{"Front", false}, {"Back", true}});
        }
        if (key == "scattertype") {
            return once(head.transmission) &&
                   choose<bool>(head.transmission, {{"BRDF", false}, {"BTDF", true}});
        }
        if (key == "tristimulusvalue") {
            return once(head.tristimulus) &&
                   choose<std::size_t>(head.tristimulus,
                                       {{"TrisX", 0U}, {"TrisY", 1U}, {"TrisZ", 2U}});
        }
        return failSeen(
            "AOI, POI, Side, Wavelength, ScatterType, TristimulusValue, TIS or DataEnd");
    }

    template <class T>
    bool once(const std::optional<T>& value) {
        return !value || fail(shown(words_.peek()) + " is given twice in one block");
    }

    bool number(std::optional<double>& into, double low, double high) {
        if (!once(into)) return false;
        const std::string keyword(words_.take());
        const auto value = parseDouble(words_.peek());
        if (!value) return failSeen("the number of " + printable(keyword));
        if (*value < low || *value > high) {
            return failSeen(printable(keyword) + " in [" + shortest(low) + ", " + shortest(high) +
                            "]");
        }
        words_.take();
        into = value;
        return true;
    }

    bool isWhole(Head& head) {
        if (!head.incidence) return fail("a block has no AOI");
        if (foldedIncidence(head) >= 90) return fail("AOI 90 is grazing, wanted below it");
        if (!head.transmission) return fail("a block has no ScatterType");
        if (xyz_ != head.tristimulus.has_value()) {
            return fail(xyz_ ? "XYZ, but a block has no TristimulusValue"
                             : "Monochrome, but a block has a TristimulusValue");
        }
        return true;
    }

    bool isNew(const Head& head) {
        const double channel =
            xyz_ ? static_cast<double>(*head.tristimulus) : head.wavelength.value_or(0);
        const auto id = std::tuple(head.fromBehind(),
                                   *head.transmission,
                                   foldedIncidence(head),
                                   lightAzimuth(head),
                                   channel);
        return seen_.insert(id).second ||
               fail("a second block of AOI " + shortest(*head.incidence) + ", same side, type, " +
                    "plane and wavelength");
    }

    bool values(std::vector<double>& f) {
        std::size_t promised = 0;
        if (__builtin_mul_overflow(azimuthDeg_.size(), radialDeg_.size(), &promised) ||
            promised > words_.bytesLeft() / 2 + 1) {
            return fail("the header promises " + std::to_string(azimuthDeg_.size()) + " x " +
                        std::to_string(radialDeg_.size()) + " values, " +
                        std::to_string(words_.bytesLeft()) + " bytes are left");
        }
        f.reserve(promised);
        while (f.size() < promised) {
            const auto value = words_.takeNumber();
            if (!value && (words_.done() || atKeyword())) {
                return fail(std::to_string(f.size()) + " values in block, header promised " +
                            std::to_string(promised));
            }
            if (!value) return fail(shown(words_.peek()) + " is not a finite number");
            f.push_back(*value);
        }
        return !parseDouble(words_.peek()) ||
               fail("more than " + std::to_string(promised) + " values in block, header promised " +
                    std::to_string(promised));
    }

    [[nodiscard]] bool atKeyword() {
        const std::string word = lower(words_.peek().substr(0, 20));
        return word == "aoi" || word == "poi" || word == "side" || word == "wavelength" ||
               word == "scattertype" || word == "tristimulusvalue" || word == "tis" ||
               word == "dataend";
    }

    [[nodiscard]] bool miniDiff() const {
        const auto whole = [](const std::vector<double>& axis, std::size_t size) {
            if (axis.size() != size) return false;
            for (std::size_t i = 0; i < size; ++i) {
                if (axis[i] != static_cast<double>(i)) return false;
            }
            return true;
        };
        std::set<double> incidences;
        std::set<double> wavelengths;
        std::size_t transmissions = 0;
        for (const ReadBlock& block : blocks_) {
            incidences.insert(foldedIncidence(block.head));
            wavelengths.insert(block.head.wavelength.value_or(0));
            transmissions += *block.head.transmission ? 1U : 0U;
        }
        return blocks_.size() == 24 && incidences.size() == 4 && wavelengths.size() == 3 &&
               transmissions == 12 && whole(azimuthDeg_, 361) && whole(radialDeg_, 91);
    }

    void mask(std::vector<std::string>& warnings) {
        std::size_t masked = 0;
        for (ReadBlock& block : blocks_) {
            for (std::size_t i = 0; i < block.f.size(); ++i) {
                if (radialDeg_[i % radialDeg_.size()] <= kMiniDiffReachDeg) continue;
                block.f[i] = std::numeric_limits<double>::quiet_NaN();
                ++masked;
            }
        }
        warnings.push_back(std::to_string(masked) + " values beyond " +
                           shortest(kMiniDiffReachDeg) +
                           " degrees masked: this is a MiniDiff export, and there it extrapolates");
    }

    /// The blocks of the front; of the back where there are no others.
    void chooseSide(FileRead<SphericalTable>& out) {
        const auto behind =
            std::stable_partition(blocks_.begin(), blocks_.end(), [](const ReadBlock& b) {
                return !b.head.fromBehind();
            });
        const auto count = static_cast<std::size_t>(blocks_.end() - behind);
        if (count == 0) return;
        if (count == blocks_.size()) {
            out.about.set(kLightToolsSide, "back");
            out.warnings.emplace_back(
                "all blocks are of light from behind: the table is the back's, seen from there");
            return;
        }
        blocks_.erase(behind, blocks_.end());
        out.warnings.push_back(std::to_string(count) + " blocks of light from behind are not read");
    }

    void fill(SphericalTable& table) {
        table.mirrorAzimuthDeg = kLightToolsMirrorDeg;
        table.planeSymmetrical = symmetrical_;
        std::map<double, std::size_t> channels;
        if (xyz_) table.channels = {{"X", {}}, {"Y", {}}, {"Z", {}}};
        for (ReadBlock& read : blocks_) {
            SphericalBlock block{.transmission = *read.head.transmission};
            if (xyz_) {
                block.channel = *read.head.tristimulus;
            } else {
                const double nanometres = read.head.wavelength.value_or(0);
                const auto [at, fresh] = channels.emplace(nanometres, table.channels.size());
                if (fresh)
                    table.channels.push_back(nanometres > 0 ? Channel::at(nanometres) : Channel{});
                block.channel = at->second;
            }
            block.incidenceDeg = foldedIncidence(read.head);
            block.lightAzimuthDeg = lightAzimuth(read.head);
            block.azimuthDeg = azimuthDeg_;
            block.thetaDeg = radialDeg_;
            block.tis = *read.head.tis;
            block.f = std::move(read.f);
            if (block.transmission) turnOver(block);
            table.blocks.push_back(std::move(block));
        }
    }

    Words words_;
    std::string_view name_;
    bool symmetrical_ = false, xyz_ = false;
    std::vector<double> azimuthDeg_, radialDeg_;
    std::vector<ReadBlock> blocks_;
    std::set<std::tuple<bool, bool, double, double, double>> seen_;
    std::optional<Error> error_;
};

}  // namespace

Result<FileRead<SphericalTable>> parseLightTools(std::string_view text,
                                                 std::string_view name,
                                                 VendorExtrapolation beyond) {
    return Reader(text, name).read(beyond);
}

}  // namespace gonio::proc
