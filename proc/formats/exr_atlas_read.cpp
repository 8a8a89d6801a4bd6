// The reading half of exr_atlas.h.

#include <algorithm>
#include <cmath>
#include <optional>

#include "proc/core/number_text.h"
#include "proc/formats/exr_atlas.h"
#include "proc/formats/exr_tile_layout.h"
#include "proc/formats/exr_tile_pixels.h"
#include "proc/formats/metadata_text.h"
#include "proc/formats/shown.h"

namespace gonio::proc {
namespace {

constexpr int kMostSide = 1 << 15;

/// The fewest decimals that give the same float of radians again: 20, not 19.9999997.
double degreesOf(float radians) {
    const double exact = Radians(static_cast<double>(radians)).degrees();
    double scale = 1;
    for (int decimals = 0; decimals < 9; ++decimals, scale *= 10) {
        const double rounded = std::round(exact * scale) / scale;
        if (static_cast<float>(Radians::fromDegrees(rounded).value()) == radians) return rounded;
    }
    return exact;
}

/// Reads one picture. The first complaint stops it: each step answers false then.
class Reader {
public:
    Reader(ExrPart part, std::string_view name) : part_(std::move(part)), name_(name) {}

    Result<std::vector<FileRead<SpecularTable>>> read() {
        if (texts() && kind() && incidences() && layout() && channels()) return samples();
        return *error_;
    }

private:
    bool fail(const std::string& what) {
        error_ = Error{ErrorKind::File, "exr-tiles: " + std::string(name_) + ": " + what};
        return false;
    }
    [[nodiscard]] std::string text(const std::string& key) const {
        const auto found = part_.text.find(key);
        return found == part_.text.end() ? "" : found->second;
    }

    /// All lines together are bounded, however many samples there are.
    bool texts() {
        std::size_t lines = 0;
        for (const auto& [key, value] : part_.text) {
            lines += static_cast<std::size_t>(std::count(value.begin(), value.end(), '\n'));
        }
        return lines <= kMostMetadataLines ||
               fail("more than " + std::to_string(kMostMetadataLines) + " lines of text");
    }

    bool kind() {
        const std::string type = text("bsdfType");
        const std::string symmetry = text("bsdfSymmetry");
        const std::string phase = text("gonioPixelPhase");
        shape_.kind = type == "BTDF" ? ScatterKind::Btdf : ScatterKind::Brdf;
        shape_.symmetry = TableSymmetry::Asymmetrical;
        mirrored_ = symmetry == "PlaneSymmetrical";
        if (!type.empty() && type != "BRDF" && type != "BTDF") {
            return fail("bsdfType " + shown(type) + ", wanted BRDF or BTDF");
        }
        return phase.empty() || phase == "centre" ||
               fail("gonioPixelPhase " + shown(phase) + ", wanted centre");
    }

    bool incidences() {
        const auto found = part_.numbers.find("bsdfTileAngles");
        if (found == part_.numbers.end() || found->second.empty()) {
            return fail("no attribute bsdfTileAngles of floats");
        }
        const std::vector<float>& angles = found->second;
        std::string unit = text("gonioAngleUnit");
        if (unit.empty()) {
            const float largest = *std::max_element(angles.begin(), angles.end());
            unit = static_cast<double>(largest) > kPi / 2 ? "deg" : "rad";
            warnings_.push_back("no unit of bsdfTileAngles: taken for " + unit);
        }
        if (unit != "rad" && unit != "deg") {
            return fail("gonioAngleUnit " + shown(unit) + ", wanted rad or deg");
        }
        for (const float angle : angles) {
            const double degrees = unit == "rad" ? degreesOf(angle) : static_cast<double>(angle);
            const bool ascends =
                shape_.incidenceDeg.empty() || degrees > shape_.incidenceDeg.back();
            if (!(degrees >= 0 && degrees < 90) || !ascends) {
                return fail("bsdfTileAngles are not ascending incidences from 0 to below 90");
            }
            shape_.incidenceDeg.push_back(degrees);
        }
        return true;
    }

    /// A count in a text attribute, from 1 to `most`.
    static std::optional<std::size_t> countOf(std::string_view digits, std::size_t most) {
        const auto count = parseInteger(digits);
        if (!count || *count < 1 || static_cast<std::uint64_t>(*count) > most) return std::nullopt;
        return static_cast<std::size_t>(*count);
    }

    bool inner() {
        const std::string atlas = text("gonioAtlas");
        if (atlas.empty()) return true;
        const std::size_t space = atlas.find(' ');
        constexpr std::size_t most = kMostAtlasSamples;
        const auto samples = countOf(std::string_view(atlas).substr(0, space), most);
        const auto columns = space == std::string::npos
                                 ? std::nullopt
                                 : countOf(std::string_view(atlas).substr(space + 1), most);
        if (!samples || !columns || *columns > *samples) {
            return fail("gonioAtlas " + shown(atlas) + ", wanted samples and columns");
        }
        layout_.samples = *samples;
        layout_.innerColumns = *columns;
        return true;
    }

    bool layout() {
        layout_.tiles = shape_.incidenceDeg.size();
        if (!inner()) return false;
        const std::string columns = text("gonioTileColumns");
        if (columns.empty()) return guess();
        const auto count = countOf(columns, layout_.tiles);
        if (!count)
            return fail("gonioTileColumns " + shown(columns) + ", wanted a number of tiles");
        layout_.columns = *count;
        return divide();
    }

    bool guess() {
        const auto found = layout_.samples == 1 ? guessedLayout(layout_, part_.size) : std::nullopt;
        if (!found) {
            return fail(std::to_string(layout_.tiles) + " tiles in " +
                        std::to_string(part_.size.width) + " x " +
                        std::to_string(part_.size.height) +
                        " pixels: say how many beside each other in gonioTileColumns");
        }
        layout_ = *found;
        warnings_.push_back("tiles are taken to stand " + std::to_string(layout_.columns) +
                            " beside each other");
        return true;
    }

    bool divide() {
        const std::size_t across = layout_.columns * layout_.innerColumns;
        const std::size_t down = layout_.rows() * layout_.innerRows();
        const auto width = static_cast<std::size_t>(part_.size.width);
        const auto height = static_cast<std::size_t>(part_.size.height);
        if (width % across != 0 || height % down != 0) {
            return fail(std::to_string(across) + " x " + std::to_string(down) +
                        " tiles do not divide " + std::to_string(width) + " x " +
                        std::to_string(height) + " pixels");
        }
        layout_.width = width / across;
        layout_.height = height / down;
        return true;
    }

    bool channels() {
        const bool bands =
            part_.floats.contains("R") && part_.floats.contains("G") && part_.floats.contains("B");
        if (!bands && (!part_.floats.contains("Y") || part_.floats.contains("R"))) {
            return fail("no channels R, G, B, nor Y alone");
        }
        shape_.colour = bands ? TableColour::LedBands : TableColour::Monochrome;
        for (const auto& [channel, pixels] : part_.floats) {
            const auto odd = std::find_if(
                pixels.begin(), pixels.end(), [](float value) { return !std::isfinite(value); });
            if (odd != pixels.end()) {
                const auto at = static_cast<std::size_t>(odd - pixels.begin());
                const auto width = static_cast<std::size_t>(part_.size.width);
                return fail("channel " + shown(channel) + ", pixel " + std::to_string(at % width) +
                            ", " + std::to_string(at / width) + " is not a finite number");
            }
        }
        return true;
    }

    std::vector<FileRead<SpecularTable>> samples() {
        shape_.azimuthDeg = centreDegrees(layout_.width, 360);
        shape_.radialDeg = centreDegrees(layout_.height, 180);
        std::vector<SpecularTable> tables(layout_.samples, shape_);
        takeSamples(part_, tables, layout_);
        std::vector<FileRead<SpecularTable>> read;
        for (std::size_t k = 0; k < tables.size(); ++k) read.push_back(sample(k, tables[k]));
        return read;
    }

    FileRead<SpecularTable> sample(std::size_t k, SpecularTable& table) {
        const std::string number = part_.text.contains("gonioAtlas") ? std::to_string(k) : "";
        FileRead<SpecularTable> read{.content = {}, .about = {}, .warnings = warnings_};
        read.about = metadataOfText(text("gonioAbout" + number)).value_or(Metadata{});
        if (read.about.at("method").empty() && text("bsdfMethod") != "measured") {
            read.about.set("method", text("bsdfMethod"));
        }
        takeTis(table, number);
        std::size_t negative = 0;
        for (const TablePlane& plane : table.planes) {
            for (const double f : plane.f) negative += f < 0 ? 1U : 0U;
        }
        if (negative > 0) read.warnings.push_back(std::to_string(negative) + " negative values");
        if (mirrored_ && isMirrored(table)) {
            keepOneSide(table);
        } else if (mirrored_) {
            read.warnings.emplace_back("PlaneSymmetrical, but its two sides differ: both are kept");
        }
        read.content = std::move(table);
        return read;
    }

    /// TIS as written; NaN where it is not.
    void takeTis(SpecularTable& table, const std::string& number) const {
        const std::size_t each = table.incidenceDeg.size();
        const auto found = part_.numbers.find("gonioTis" + number);
        for (std::size_t p = 0; p < table.planes.size(); ++p) {
            table.planes[p].tis.assign(each, std::numeric_limits<double>::quiet_NaN());
            if (found == part_.numbers.end() || found->second.size() < (p + 1) * each) continue;
            for (std::size_t i = 0; i < each; ++i) {
                table.planes[p].tis[i] = static_cast<double>(found->second[p * each + i]);
            }
        }
    }

    ExrPart part_;
    std::string_view name_;
    SpecularTable shape_;  ///< what the tables share
    bool mirrored_ = false;
    ExrTileLayout layout_;
    std::vector<std::string> warnings_;
    std::optional<Error> error_;
};

}  // namespace

Result<std::vector<FileRead<SpecularTable>>> decodeExrAtlas(std::string_view bytes,
                                                            std::string_view name) {
    auto parts = decodeExr(
        bytes,
        {.largest = {kMostSide, kMostSide}, .parts = 1, .bytes = mostPixelBytes(bytes.size())});
    if (!parts) return parts.error().in("exr-tiles: " + std::string(name));
    return Reader(std::move(parts->front()), name).read();
}

}  // namespace gonio::proc
