#include "proc/formats/gonio_exr.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "proc/core/number_text.h"
#include "proc/formats/exr_parts.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/shown.h"
#include "proc/optics/cell_grid.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

constexpr Size kPicture{360, CellGrid::kRows};
constexpr std::size_t kMostBytes = std::size_t{1}
                                   << 20U;  // of a part, whose 6 channels take 0.8 MB

/// The cell that a pixel repeats: the one that holds the middle of its column.
std::size_t cellOf(int x, int y) {
    const int sectors = CellGrid::sectors(y);
    return CellGrid::index({y, static_cast<int>((x + 0.5) * sectors / kPicture.width)});
}

const std::vector<std::uint32_t>& cellIds() {
    static const std::vector<std::uint32_t> ids = [] {
        std::vector<std::uint32_t> all;
        for (int y = 0; y < kPicture.height; ++y) {
            for (int x = 0; x < kPicture.width; ++x) {
                all.push_back(static_cast<std::uint32_t>(cellOf(x, y)));
            }
        }
        return all;
    }();
    return ids;
}

// Each text of SampleInfo and the attribute it stands in.
struct TextField {
    const char* key;
    std::string SampleInfo::*field;
};
constexpr TextField kTexts[] = {
    {"gonio.name", &SampleInfo::name},
    {"gonio.rig_serial", &SampleInfo::rigSerial},
    {"gonio.profile_hash", &SampleInfo::profileHash},
    {"gonio.calibration_id", &SampleInfo::calibrationId},
    {"gonio.session", &SampleInfo::session},
    {"gonio.date_utc", &SampleInfo::dateUtc},
    {"gonio.operator_notes", &SampleInfo::operatorNotes},
    {"gonio.software_version", &SampleInfo::softwareVersion},
    {"gonio.effort", &SampleInfo::effort},
    {"gonio.reference_certificate", &SampleInfo::referenceCertificate},
    {"gonio.qc_verdicts", &SampleInfo::qcVerdicts},
    {"gonio.truth_spec", &SampleInfo::truthSpec},
    {"gonio.budget", &SampleInfo::budgetJson},
};

std::map<std::string, std::string> textOf(const SampleInfo& info) {
    std::map<std::string, std::string> text{{"gonio.schema", std::string(kSampleSchema)},
                                            {"gonio.scatter", "BRDF"}};
    for (const TextField& t : kTexts) text[t.key] = info.*t.field;
    const auto add = [&](const char* key, std::optional<double> value) {
        if (value && std::isfinite(*value)) text[key] = shortest(*value);
    };
    add("gonio.rig_seconds", info.rigSeconds);
    add("gonio.compute_seconds", info.computeSeconds);
    add("gonio.requested_uncertainty", info.requestedUncertainty);
    add("gonio.achieved_uncertainty", info.achievedUncertainty);
    text["gonio.interruptions"] = std::to_string(info.interruptions);
    text["gonio.extra"] =
        nlohmann::json(info.extra).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return text;
}

constexpr const char* kRotation = "gonio.rotation_deg";

std::vector<float> spread(const std::vector<double>& cells) {
    std::vector<float> pixels;
    pixels.reserve(kPicture.pixels());
    for (const std::uint32_t cell : cellIds()) pixels.push_back(static_cast<float>(cells[cell]));
    return pixels;
}

std::vector<double> gathered(const std::vector<float>& pixels) {
    std::vector<double> cells(CellGrid::count());
    const auto& ids = cellIds();
    for (std::size_t i = 0; i < pixels.size(); ++i) cells[ids[i]] = static_cast<double>(pixels[i]);
    return cells;
}

std::string partName(std::size_t led, Band band) {
    return "led" + std::to_string(led) + "." + std::string(letter(band));
}

bool isWhole(const CellSamples& cells) {
    const std::size_t n = CellGrid::count();
    return cells.f.size() == n && cells.uRandom.size() == n && cells.uSystematic.size() == n &&
           cells.nEff.size() == n && cells.flags.size() == n;
}

ExrPart partOf(const LedTable& led, Band band) {
    const CellSamples& cells = led.bands[index(band)];
    ExrPart part;
    part.size = kPicture;
    part.text = {{"gonio.incidence_deg", shortest(fileDegrees(led.incidence))},
                 {"gonio.band", std::string(letter(band))},
                 {"gonio.wavelength_nm", shortest(nanometres(band))}};
    if (const double turned = fileDegrees(led.rotation); turned != 0) {
        part.text[kRotation] = shortest(turned);
    }
    part.floats = {{"f", spread(cells.f)},
                   {"u_random", spread(cells.uRandom)},
                   {"u_systematic", spread(cells.uSystematic)},
                   {"n_eff", spread(cells.nEff)}};
    part.counts["cell_id"] = cellIds();
    std::vector<std::uint32_t>& flags = part.counts["flags"];
    for (const std::uint32_t cell : cellIds()) flags.push_back(cells.flags[cell].mask());
    return part;
}

/// The first channel that holds an infinite value; empty where none does.
std::string infiniteChannel(const ExrPart& part) {
    for (const auto& [name, pixels] : part.floats) {
        if (std::any_of(pixels.begin(), pixels.end(), [](float f) { return std::isinf(f); })) {
            return name;
        }
    }
    return "";
}

/// Reads the parts of one file. The first complaint stops it.
class Decoder {
public:
    explicit Decoder(std::string_view name) : name_(name) {}

    /// Takes the parts: each is let go once it is read.
    Result<SampleSet> read(std::vector<ExrPart> parts) {
        const bool good = schema(parts.front()) && info(parts.front()) && leds(parts);
        if (!good) return *error_;
        return std::move(set_);
    }

private:
    bool fail(const std::string& what) {
        error_ = Error{ErrorKind::File, "gonio: " + std::string(name_) + ": " + what};
        return false;
    }

    bool schema(const ExrPart& part) {
        const std::string seen = textAt(part, "gonio.schema").value_or("");
        return seen == kSampleSchema ||
               fail("schema " + shown(seen) + ", wanted " + std::string(kSampleSchema));
    }

    static std::optional<std::string> textAt(const ExrPart& part, const std::string& key) {
        const auto found = part.text.find(key);
        if (found == part.text.end()) return std::nullopt;
        return found->second;
    }

    /// Absent stays as it is; present must be a number.
    template <class T>
    bool number(const ExrPart& part, const std::string& key, T& into) {
        const auto text = textAt(part, key);
        if (!text) return true;
        const auto value = parseDouble(*text);
        if (!value) return fail("attribute " + key + " is not a number");
        into = *value;
        return true;
    }

    bool info(const ExrPart& part) {
        SampleInfo& info = set_.info;
        for (const TextField& t : kTexts) info.*t.field = textAt(part, t.key).value_or("");
        const auto interruptions = parseInteger(textAt(part, "gonio.interruptions").value_or("0"));
        if (!interruptions || *interruptions < 0 || *interruptions > 1'000'000) {
            return fail("attribute gonio.interruptions is not a count");
        }
        info.interruptions = static_cast<int>(*interruptions);
        return number(part, "gonio.rig_seconds", info.rigSeconds) &&
               number(part, "gonio.compute_seconds", info.computeSeconds) &&
               number(part, "gonio.requested_uncertainty", info.requestedUncertainty) &&
               number(part, "gonio.achieved_uncertainty", info.achievedUncertainty) && extra(part);
    }

    bool extra(const ExrPart& part) {
        const auto json =
            nlohmann::json::parse(textAt(part, "gonio.extra").value_or("{}"), nullptr, false);
        if (!json.is_object()) return fail("attribute gonio.extra is not a JSON object");
        for (const auto& [key, value] : json.items()) {
            if (!value.is_string()) return fail("attribute gonio.extra: a value is not text");
            set_.info.extra[key] = value.get<std::string>();
        }
        return true;
    }

    bool leds(std::vector<ExrPart>& parts) {
        std::map<std::string, ExrPart*> byName;
        for (ExrPart& part : parts) byName[part.name] = &part;
        std::size_t used = 0;
        for (std::size_t led = 0; used < byName.size(); ++led) {
            LedTable table;
            const std::size_t before = used;
            for (const Band band : kBands) {
                const auto found = byName.find(partName(led, band));
                if (found == byName.end()) continue;
                ++used;
                if (!ledBand(*found->second, band, table)) return false;
                *found->second = {};
            }
            if (used == before)
                return fail("parts are missing: there is no led" + std::to_string(led) +
                            ".r, .g or .b");
            set_.leds.push_back(std::move(table));
        }
        return true;
    }

    bool ledBand(const ExrPart& part, Band band, LedTable& into) {
        const auto degrees = parseDouble(textAt(part, "gonio.incidence_deg").value_or(""));
        if (!degrees || *degrees < 0 || *degrees >= 90) {
            return fail("part " + part.name + ": gonio.incidence_deg is not in [0, 90)");
        }
        const Radians incidence = Radians::fromDegrees(*degrees);
        const bool first = std::all_of(into.bands.begin(), into.bands.end(), [](const auto& cells) {
            return cells.size() == 0;
        });
        if (!first && incidence != into.incidence) {
            return fail("part " + part.name + ": another incidence than the LED's first band");
        }
        const auto turned = parseDouble(textAt(part, kRotation).value_or("0"));
        if (!turned || *turned < 0 || *turned >= 360) {
            return fail("part " + part.name + ": gonio.rotation_deg is not in [0, 360)");
        }
        const Radians rotation = rotationOf(*turned);
        if (!first && rotation != into.rotation) {
            return fail("part " + part.name + ": another rotation than the LED's first band");
        }
        const auto nm = parseDouble(textAt(part, "gonio.wavelength_nm").value_or("0"));
        if (!nm || (*nm != 0 && *nm != nanometres(band))) {
            return fail("part " + part.name + ": gonio.wavelength_nm is not " +
                        shortest(nanometres(band)) + ", which the band is");
        }
        if (!wholePicture(part)) return false;
        into.incidence = incidence;
        into.rotation = rotation;
        CellSamples& cells = into.bands[index(band)];
        cells.f = gathered(part.floats.at("f"));
        cells.uRandom = gathered(part.floats.at("u_random"));
        cells.uSystematic = gathered(part.floats.at("u_systematic"));
        cells.nEff = gathered(part.floats.at("n_eff"));
        cells.flags.resize(CellGrid::count());
        const auto& flags = part.counts.at("flags");
        for (std::size_t i = 0; i < flags.size(); ++i) {
            cells.flags[cellIds()[i]] = Flags::fromMask(flags[i]);
        }
        return true;
    }

    bool wholePicture(const ExrPart& part) {
        const std::string where = "part " + part.name + ": ";
        if (!(part.size == kPicture)) return fail(where + "not 360 x 90");
        for (const char* channel : {"f", "u_random", "u_systematic", "n_eff"}) {
            if (!part.floats.contains(channel)) return fail(where + "no float channel " + channel);
        }
        if (const std::string channel = infiniteChannel(part); !channel.empty()) {
            return fail(where + "an infinite value in " + channel);
        }
        const auto flags = part.counts.find("flags");
        const auto ids = part.counts.find("cell_id");
        if (flags == part.counts.end()) return fail(where + "no UINT channel flags");
        for (const std::uint32_t mask : flags->second) {
            if ((mask >> static_cast<unsigned>(kFlagCount)) != 0) {
                return fail(where + "unknown bits in flags");
            }
        }
        const bool sameGrid = ids != part.counts.end() && ids->second == cellIds();
        return sameGrid || fail(where + "cell_id is not the grid that this program knows");
    }

    std::string_view name_;
    SampleSet set_;
    std::optional<Error> error_;
};

}  // namespace

Result<std::string> encodeGonio(const SampleSet& set) {
    if (set.leds.size() > kMostTables) {
        return Error{ErrorKind::Internal,
                     "gonio: " + std::to_string(set.leds.size()) + " tables, at most " +
                         std::to_string(kMostTables) + " fit into a file"};
    }
    std::vector<ExrPart> parts;
    for (std::size_t led = 0; led < set.leds.size(); ++led) {
        const std::size_t before = parts.size();
        for (const Band band : kBands) {
            const CellSamples& cells = set.leds[led].bands[index(band)];
            if (cells.size() == 0) continue;
            if (!isWhole(cells)) {
                return Error{ErrorKind::Internal,
                             "gonio: " + partName(led, band) + ": " + std::to_string(cells.size()) +
                                 " cells, the grid has " + std::to_string(CellGrid::count())};
            }
            parts.push_back(partOf(set.leds[led], band));
            parts.back().name = partName(led, band);
            if (const std::string channel = infiniteChannel(parts.back()); !channel.empty()) {
                return Error{ErrorKind::Internal,
                             "gonio: " + partName(led, band) + ": an infinite value in " + channel};
            }
        }
        if (parts.size() == before) {
            return Error{ErrorKind::Internal,
                         "gonio: led" + std::to_string(led) + " has no measured band"};
        }
    }
    if (parts.empty()) return Error{ErrorKind::Internal, "gonio: the sample has no LED"};
    parts.front().text.merge(textOf(set.info));
    return encodeExr(parts);
}

Result<SampleSet> decodeGonio(std::string_view bytes, std::string_view name) {
    auto parts = decodeExr(
        bytes, {.largest = kPicture, .parts = 3 * kMostTables, .bytesOfAPart = kMostBytes});
    if (!parts) return parts.error().in("gonio: " + std::string(name));
    return Decoder(name).read(std::move(*parts));
}

Result<void> writeGonio(const std::filesystem::path& path, const SampleSet& set) {
    const Result<std::string> bytes = encodeGonio(set);
    if (!bytes) return bytes.error();
    return writeFile(path, *bytes);
}

Result<SampleSet> readGonio(const std::filesystem::path& path) {
    const Result<std::string> bytes = readFile(path);
    if (!bytes) return bytes.error();
    return decodeGonio(*bytes, path.string());
}

}  // namespace gonio::proc
