#include "proc/formats/klems.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <tuple>
#include <utility>

#include "proc/core/number_text.h"
#include "proc/formats/shown.h"

namespace gonio::proc {
namespace {

/// No basis that we know has more than 145.
constexpr std::size_t kMostPatches = 20'000;

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kSpace = " \t\r\n";
    const std::size_t first = text.find_first_not_of(kSpace);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

std::string_view textOf(const pugi::xml_node& parent, const char* child) {
    return trimmed(parent.child_value(child));
}

class Reader {
public:
    Reader(std::string_view text, std::string_view name) : text_(text), name_(name) {}

    Result<FileRead<KlemsTable>> read() {
        pugi::xml_document document;
        const pugi::xml_parse_result parsed = document.load_buffer(text_.data(), text_.size());
        if (!parsed) {
            failAt(lineOf(parsed.offset), std::string("no XML: ") + parsed.description());
            return *error_;
        }
        const pugi::xml_node root = document.child("WindowElement");
        if (!root && !failAt(1, "wanted <WindowElement>")) return *error_;
        const pugi::xml_node layer = root.child("Optical").child("Layer");
        if (!layer && !fail(root, "wanted <Optical> with a <Layer>")) return *error_;
        if (layer.next_sibling("Layer")) {
            out_.warnings.emplace_back("layers beyond the first are not read");
        }
        if (!definition(layer.child("DataDefinition"))) return *error_;
        material(layer.child("Material"));
        for (const pugi::xml_node& data : layer.children("WavelengthData")) {
            for (const pugi::xml_node& block : data.children("WavelengthDataBlock")) {
                if (!matrix(data, block)) return *error_;
            }
        }
        if (out_.content.matrices.empty() && !fail(layer, "no <WavelengthDataBlock>")) {
            return *error_;
        }
        warn();
        return std::move(out_);
    }

private:
    bool failAt(std::size_t line, const std::string& what) {
        if (!error_) {
            error_ = Error{
                ErrorKind::File,
                "klems: " + std::string(name_) + ": line " + std::to_string(line) + ": " + what};
        }
        return false;
    }
    bool fail(const pugi::xml_node& node, const std::string& what) {
        return failAt(lineOf(node.offset_debug()), what);
    }
    [[nodiscard]] std::size_t lineOf(std::ptrdiff_t offset) const {
        const auto end = std::clamp<std::ptrdiff_t>(offset, 0, std::ssize(text_));
        return 1 + static_cast<std::size_t>(std::count(text_.begin(), text_.begin() + end, '\n'));
    }

    bool definition(const pugi::xml_node& node) {
        if (!node) return failAt(1, "wanted <DataDefinition>");
        const std::string_view order = textOf(node, "IncidentDataStructure");
        if (order != "Columns" && order != "Rows") {
            return fail(node,
                        "IncidentDataStructure " + shown(order) +
                            " is not read, only Columns and Rows of a Klems basis");
        }
        incidentIsRow_ = order == "Rows";
        for (const pugi::xml_node& basis : node.children("AngleBasis")) {
            if (!angleBasis(basis)) return false;
        }
        return true;
    }

    bool number(const pugi::xml_node& node, const char* child, double& into) {
        const auto value = parseDouble(textOf(node, child));
        if (!value) {
            return fail(node,
                        shown(textOf(node, child)) + ", wanted the number of <" + child + ">");
        }
        into = *value;
        return true;
    }

    bool angleBasis(const pugi::xml_node& node) {
        KlemsBasis basis{.name = std::string(textOf(node, "AngleBasisName")), .rings = {}};
        if (basis.name.empty()) return fail(node, "a basis without a name");
        if (find(basis.name)) return fail(node, "a second basis " + shown(basis.name));
        double reached = 0;
        std::size_t patches = 0;
        for (const pugi::xml_node& block : node.children("AngleBasisBlock")) {
            const pugi::xml_node bounds = block.child("ThetaBounds");
            double lower = 0;
            KlemsBasis::Ring ring;
            if (!bounds) return fail(block, "wanted <ThetaBounds>");
            if (!number(bounds, "LowerTheta", lower) ||
                !number(bounds, "UpperTheta", ring.upperDeg)) {
                return false;
            }
            if (std::abs(lower - reached) > 1e-6 || ring.upperDeg <= lower || ring.upperDeg > 90) {
                return fail(bounds,
                            "ring of " + shortest(lower) + " to " + shortest(ring.upperDeg) +
                                " degrees behind " + shortest(reached) +
                                ", wanted a gapless 0..90");
            }
            const auto phis = parseInteger(textOf(block, "nPhis"));
            if (!phis || *phis < 1 || static_cast<std::uint64_t>(*phis) > kMostPatches - patches) {
                return fail(block, shown(textOf(block, "nPhis")) + ", wanted the number of nPhis");
            }
            ring.phis = static_cast<std::size_t>(*phis);
            patches += ring.phis;
            reached = ring.upperDeg;
            basis.rings.push_back(ring);
        }
        if (basis.rings.empty()) return fail(node, "a basis without blocks");
        out_.content.bases.push_back(std::move(basis));
        return true;
    }

    [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const {
        const auto& bases = out_.content.bases;
        const auto found = std::find_if(bases.begin(), bases.end(), [&](const KlemsBasis& basis) {
            return basis.name == name;
        });
        if (found == bases.end()) return std::nullopt;
        return static_cast<std::size_t>(found - bases.begin());
    }
    bool basisOf(const pugi::xml_node& block, const char* child, std::size_t& into) {
        const std::string name(textOf(block, child));
        auto place = find(name);
        if (!place) {
            if (auto known = knownKlemsBasis(name)) {
                place = out_.content.bases.size();
                out_.content.bases.push_back(std::move(*known));
            }
        }
        if (!place) return fail(block, std::string(child) + " " + shown(name) + " is not known");
        into = *place;
        return true;
    }

    void material(const pugi::xml_node& node) {
        out_.about.set(key::kSample, printable(textOf(node, "Name")));
        out_.about.set("manufacturer", printable(textOf(node, "Manufacturer")));
        const std::string thickness = printable(textOf(node, "Thickness"));
        const std::string unit = printable(node.child("Thickness").attribute("unit").value());
        if (!thickness.empty()) out_.about.set("thickness", thickness + " " + unit);
    }

    bool way(const pugi::xml_node& block, KlemsMatrix& matrix) {
        const std::string_view text = textOf(block, "WavelengthDataDirection");
        const bool front = text.ends_with(" Front");
        const bool transmission = text.starts_with("Transmission ");
        if ((!front && !text.ends_with(" Back")) ||
            (!transmission && !text.starts_with("Reflection "))) {
            return fail(block,
                        "WavelengthDataDirection " + shown(text) +
                            ", wanted Transmission or Reflection, Front or Back");
        }
        matrix.face = front ? KlemsFace::Front : KlemsFace::Back;
        matrix.transmission = transmission;
        return true;
    }

    bool matrix(const pugi::xml_node& data, const pugi::xml_node& block) {
        KlemsMatrix matrix;
        matrix.spectrum = printable(textOf(data, "Wavelength").substr(0, 80));
        matrix.detector = printable(textOf(data, "DetectorSpectrum").substr(0, 80));
        if (matrix.spectrum.empty()) return fail(data, "wanted <Wavelength>");
        if (!way(block, matrix) || !basisOf(block, "ColumnAngleBasis", matrix.incident) ||
            !basisOf(block, "RowAngleBasis", matrix.outgoing)) {
            return false;
        }
        const auto id =
            std::tuple(matrix.face, matrix.transmission, matrix.spectrum, matrix.detector);
        if (!seen_.insert(id).second) {
            return fail(block, "a second matrix of this direction and wavelength");
        }
        const std::size_t incident = out_.content.bases[matrix.incident].patchCount();
        const std::size_t outgoing = out_.content.bases[matrix.outgoing].patchCount();
        const pugi::xml_node scattering = block.child("ScatteringData");
        if (!scattering) return fail(block, "wanted <ScatteringData>");
        if (!values(scattering, incident, outgoing, matrix.f)) return false;
        if (incidentIsRow_) transpose(matrix.f, incident, outgoing);
        out_.content.matrices.push_back(std::move(matrix));
        return true;
    }

    /// Numbers between white space and commas.
    bool values(const pugi::xml_node& node,
                std::size_t incident,
                std::size_t outgoing,
                std::vector<double>& f) {
        constexpr std::string_view kBetween = " \t\r\n,";
        const std::string_view text = node.child_value();
        const std::size_t wanted = incident * outgoing;  // at most kMostPatches squared
        const auto sized = [&](std::size_t got) {
            return std::to_string(got) + " values, wanted " + std::to_string(outgoing) + " x " +
                   std::to_string(incident);
        };
        if (wanted > text.size() / 2 + 1) {
            return fail(node, "at most " + sized(text.size() / 2 + 1));
        }
        f.reserve(wanted);
        std::size_t at = text.find_first_not_of(kBetween);
        while (at != std::string_view::npos) {
            const std::size_t end = std::min(text.find_first_of(kBetween, at), text.size());
            const std::string_view word = text.substr(at, end - at);
            const auto value = parseDouble(word);
            if (!value || f.size() == wanted) {
                const auto lines =
                    std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n');
                return failAt(
                    lineOf(node.offset_debug()) + static_cast<std::size_t>(lines),
                    value ? "more than " + sized(wanted) : shown(word) + " is not a finite number");
            }
            negative_ += *value < 0 ? 1U : 0U;
            f.push_back(*value);
            at = text.find_first_not_of(kBetween, end);
        }
        return f.size() == wanted || fail(node, sized(f.size()));
    }

    static void transpose(std::vector<double>& f, std::size_t incident, std::size_t outgoing) {
        const std::vector<double> rows = std::exchange(f, std::vector<double>(f.size()));
        for (std::size_t in = 0; in < incident; ++in) {
            for (std::size_t out = 0; out < outgoing; ++out) {
                f[out * incident + in] = rows[in * outgoing + out];
            }
        }
    }

    void warn() {
        const KlemsTable& table = out_.content;
        if (negative_ > 0) out_.warnings.push_back(std::to_string(negative_) + " negative values");
        std::size_t bright = 0;
        for (const KlemsMatrix& matrix : table.matrices) {
            for (const double share : table.hemispherical(matrix)) {
                bright += share > 1 + 1e-6 ? 1U : 0U;
            }
        }
        if (bright > 0) {
            out_.warnings.push_back(std::to_string(bright) +
                                    " incident patches scatter more than falls on them");
        }
    }

    std::string_view text_;
    std::string_view name_;
    FileRead<KlemsTable> out_{.content = {}, .about = {}};
    bool incidentIsRow_ = false;
    std::set<std::tuple<KlemsFace, bool, std::string, std::string>> seen_;
    std::size_t negative_ = 0;
    std::optional<Error> error_;
};

}  // namespace

Result<FileRead<KlemsTable>> parseKlems(std::string_view text, std::string_view name) {
    return Reader(text, name).read();
}

}  // namespace gonio::proc
