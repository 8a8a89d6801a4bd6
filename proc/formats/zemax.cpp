#include "proc/formats/zemax.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <optional>

#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/shown.h"
#include "proc/formats/text_lines.h"
#include "proc/formats/words.h"
#include "proc/table/specular_integral.h"

namespace gonio::proc {
namespace {

/// What an axis of the header may hold, in degrees.
struct AxisRule {
    std::string_view keyword;
    double low;
    double high;
};
constexpr AxisRule kRotations{"SampleRotation", -360, 360};
constexpr AxisRule kIncidences{"AngleOfIncidence", 0, 180};
constexpr AxisRule kAzimuths{"ScatterAzimuth", 0, 360};
constexpr AxisRule kRadials{"ScatterRadial", 0, 180};

constexpr std::array<std::string_view, 3> kXyzSections{
    "TristimulusX", "TristimulusY", "TristimulusZ"};

std::string_view sectionName(TableColour colour, std::size_t plane) {
    return colour == TableColour::Xyz ? kXyzSections[plane] : std::string_view("Monochrome");
}

/// a * b, or the largest number where that does not fit.
std::size_t productOrMost(std::size_t a, std::size_t b) {
    std::size_t product = 0;
    return __builtin_mul_overflow(a, b, &product) ? SIZE_MAX : product;
}

/// Reads one text. The first complaint stops it: each step answers false once there is an error.
class Reader {
public:
    Reader(std::string_view text, std::string_view name) : words_(text), name_(name) {}

    Result<SpecularTable> read() {
        if (header() && headerIsWhole() && sections() && commentsFit()) {
            table_.comments = words_.takeComments();
            return std::move(table_);
        }
        return *error_;
    }

private:
    bool fail(const std::string& what) {
        if (!error_) {
            error_ = Error{ErrorKind::File,
                           "zemax: " + std::string(name_) + ": line " +
                               std::to_string(words_.line()) + ": " + what};
        }
        return false;
    }
    bool failSeen(const std::string& wanted) {
        if (words_.done()) return fail("the text ends, wanted " + wanted);
        return fail(shown(words_.peek()) + ", wanted " + wanted);
    }

    bool header() {
        while (!atSection()) {
            if (words_.done()) return fail("the text ends, wanted " + missingKeyword());
            const std::string key = lower(words_.peek());
            if (seen_[key]++ > 0) return fail(shown(words_.peek()) + " is given twice");
            if (!headerLine(key)) return false;
        }
        return true;
    }

    bool commentsFit() {
        return !words_.tooManyComments() ||
               fail("more than " + std::to_string(Words::kMostComments) + " comments");
    }

    [[nodiscard]] bool atSection() {
        const std::string word = lower(words_.peek());
        return word == "monochrome" || word.starts_with("tristimulus");
    }

    bool headerLine(const std::string& key) {
        if (key == "symmetry") return symmetry();
        if (key == "spectralcontent") {
            return choose<TableColour>(
                table_.colour,
                {{"Monochrome", TableColour::Monochrome}, {"XYZ", TableColour::Xyz}});
        }
        if (key == "scattertype") {
            return choose<ScatterKind>(table_.kind,
                                       {{"BRDF", ScatterKind::Brdf}, {"BTDF", ScatterKind::Btdf}});
        }
        if (key == "source") {
            int any = 0;
            return choose<int>(any, {{"Measured", 0}});
        }
        if (key == lower(kRotations.keyword)) return axis(kRotations, table_.rotationDeg);
        if (key == lower(kIncidences.keyword)) return axis(kIncidences, table_.incidenceDeg);
        if (key == lower(kAzimuths.keyword)) return axis(kAzimuths, table_.azimuthDeg);
        if (key == lower(kRadials.keyword)) return axis(kRadials, table_.radialDeg);
        return fail("unknown keyword " + shown(words_.peek()));
    }

    bool symmetry() {
        return choose<TableSymmetry>(table_.symmetry,
                                     {{"PlaneSymmetrical", TableSymmetry::PlaneSymmetrical},
                                      {"Asymmetrical", TableSymmetry::Asymmetrical},
                                      {"Asymmetrical4D", TableSymmetry::Asymmetrical4D}});
    }

    template <class T>
    bool choose(T& into, const std::vector<std::pair<std::string_view, T>>& choices) {
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

    bool axis(const AxisRule& rule, std::vector<double>& into) {
        words_.take();
        const std::string keyword(rule.keyword);
        const auto count = parseInteger(words_.peek());
        if (!count || *count < 1) return failSeen("the number of values of " + keyword);
        words_.take();
        if (static_cast<std::uint64_t>(*count) > words_.bytesLeft() / 2 + 1) {
            return fail(keyword + " promises " + std::to_string(*count) + " values, " +
                        std::to_string(words_.bytesLeft()) + " bytes are left");
        }
        into.clear();
        for (std::int64_t i = 0; i < *count; ++i) {
            const auto value = parseDouble(words_.peek());
            if (!value) {
                return failSeen("number " + std::to_string(i + 1) + " of the " +
                                std::to_string(*count) + " of " + keyword);
            }
            if (*value < rule.low || *value > rule.high) {
                return failSeen("degrees in [" + shortest(rule.low) + ", " + shortest(rule.high) +
                                "] for " + keyword);
            }
            if (!into.empty() && *value <= into.back()) {
                return failSeen("more than " + shortest(into.back()) + ": " + keyword +
                                " must ascend");
            }
            words_.take();
            into.push_back(*value);
        }
        return true;
    }

    [[nodiscard]] std::string missingKeyword() {
        constexpr std::array<std::string_view, 5> kNeeded{
            "Symmetry", "SpectralContent", "AngleOfIncidence", "ScatterAzimuth", "ScatterRadial"};
        for (const std::string_view keyword : kNeeded) {
            if (seen_[lower(keyword)] == 0) return std::string(keyword);
        }
        return "a data section";
    }

    bool headerIsWhole() {
        if (const std::string missing = missingKeyword(); missing != "a data section") {
            return fail("data begin, but the header has no " + missing);
        }
        if (table_.symmetry == TableSymmetry::PlaneSymmetrical && table_.azimuthDeg.back() > 180) {
            return fail("PlaneSymmetrical, but ScatterAzimuth goes to " +
                        shortest(table_.azimuthDeg.back()) + ", wanted at most 180");
        }
        if (table_.kind == ScatterKind::Brdf && table_.incidenceDeg.back() >= 90) {
            return fail("BRDF, but AngleOfIncidence goes to " +
                        shortest(table_.incidenceDeg.back()) + ", wanted below 90");
        }
        std::size_t promised = planeCount(table_.colour);
        for (const auto* each :
             {&table_.rotationDeg, &table_.incidenceDeg, &table_.azimuthDeg, &table_.radialDeg}) {
            promised = productOrMost(promised, each->size());
        }
        if (promised > words_.bytesLeft() / 2 + 1) {
            return fail("the header promises " + std::to_string(promised) + " values, " +
                        std::to_string(words_.bytesLeft()) + " bytes are left");
        }
        return true;
    }

    bool sections() {
        for (std::size_t plane = 0; plane < planeCount(table_.colour); ++plane) {
            if (!keyword(sectionName(table_.colour, plane)) || !keyword("DataBegin") || !data() ||
                !keyword("DataEnd")) {
                return false;
            }
        }
        return words_.done() || failSeen("nothing after the last DataEnd");
    }

    bool keyword(std::string_view wanted) {
        if (lower(words_.peek()) != lower(wanted)) return failSeen(std::string(wanted));
        words_.take();
        return true;
    }

    bool data() {
        TablePlane plane;
        const std::size_t blocks = table_.rotationDeg.size() * table_.incidenceDeg.size();
        plane.f.reserve(table_.nodeCount());  // bounded by headerIsWhole()
        plane.tis.reserve(blocks);
        for (std::size_t i = 0; i < blocks; ++i) {
            if (!keyword("TIS")) return false;
            const auto tis = parseDouble(words_.peek());
            if (!tis) return failSeen("the number of TIS");
            words_.take();
            plane.tis.push_back(*tis);
            if (!block(plane.f)) return false;
        }
        table_.planes.push_back(std::move(plane));
        return true;
    }

    bool block(std::vector<double>& f) {
        const std::size_t promised = table_.azimuthDeg.size() * table_.radialDeg.size();
        const std::size_t start = f.size();
        std::size_t got = 0;
        for (; got < promised; ++got) {
            const auto value = words_.takeNumber();
            if (!value) break;
            f.push_back(*value);
        }
        if (!atBlockEnd()) {
            if (!parseDouble(words_.peek())) {
                return fail(shown(words_.peek()) + " is not a finite number");
            }
            return fail("more than " + std::to_string(promised) +
                        " values in block, header promised " + std::to_string(promised));
        }
        if (got != promised) {
            return fail(std::to_string(got) + " values in block, header promised " +
                        std::to_string(promised));
        }
        if (table_.radialDeg.front() == 0) shareTheCentre(f, start);
        return true;
    }

    [[nodiscard]] bool atBlockEnd() {
        if (words_.done()) return true;
        const char first = words_.peek().front();
        if (first != 'T' && first != 't' && first != 'D' && first != 'd') return false;
        const std::string word = lower(words_.peek());
        return word == "tis" || word == "dataend";
    }

    /// At radial 0 every azimuth is the same direction: one value, the mean of those that are data.
    void shareTheCentre(std::vector<double>& f, std::size_t start) const {
        const std::size_t stride = table_.radialDeg.size();
        double mean = 0;
        double count = 0;
        bool differ = false;
        for (std::size_t i = start; i < f.size(); i += stride) {
            differ = differ || f[i] != f[start];
            if (f[i] == 0) continue;
            ++count;
            mean += f[i] / count - mean / count;  // stays finite: a sum might not
        }
        if (!differ) return;
        for (std::size_t i = start; i < f.size(); i += stride) f[i] = mean;
    }

    Words words_;
    std::string_view name_;
    SpecularTable table_;
    std::map<std::string, int> seen_;
    std::optional<Error> error_;
};

std::string_view spelling(TableSymmetry symmetry) {
    switch (symmetry) {
        case TableSymmetry::PlaneSymmetrical: return "PlaneSymmetrical";
        case TableSymmetry::Asymmetrical: return "Asymmetrical";
        case TableSymmetry::Asymmetrical4D: return "ASymmetrical4D";
    }
    return "";
}

void appendAxis(std::string& text, const AxisRule& rule, const std::vector<double>& axis) {
    text += std::string(rule.keyword) + "  " + std::to_string(axis.size()) + "\n";
    for (std::size_t i = 0; i < axis.size(); ++i) text += (i > 0 ? "\t" : "") + shortest(axis[i]);
    text += "\n";
}

void appendComments(std::string& text, const std::vector<std::string>& comments) {
    for (const std::string& comment : comments) {
        text += "# " + onOneLine(comment) + "\n";
    }
}

void appendPlane(Written& out, const SpecularTable& table, std::size_t plane) {
    const TablePlane& values = table.planes[plane];
    const std::size_t radials = table.radialDeg.size();
    const std::size_t block = table.azimuthDeg.size() * radials;
    std::size_t lost = 0;
    std::size_t lostTis = 0;
    const auto append = [&](double value, std::size_t& count) {
        count += std::isfinite(value) ? 0U : 1U;
        appendShortest(out.bytes, std::isfinite(value) ? value : 0);
    };
    const auto tisOf = [&](std::size_t light) {
        if (std::isfinite(values.tis[light])) return values.tis[light];
        const std::size_t incidences = table.incidenceDeg.size();
        return specularIntegral(
            table, plane, {.rotation = light / incidences, .incidence = light % incidences});
    };
    out.bytes += "\n" + std::string(sectionName(table.colour, plane)) + "\nDataBegin\n";
    for (std::size_t i = 0; i < values.f.size(); ++i) {
        if (i % block == 0) {
            out.bytes += "TIS  ";
            append(tisOf(i / block), lostTis);
            out.bytes += '\n';
        }
        append(values.f[i], lost);
        out.bytes += (i + 1) % radials == 0 ? '\n' : '\t';
    }
    out.bytes += "DataEnd\n";
    out.loss.add(Loss::Masked, "nodes without a finite value, written as 0", lost);
    out.loss.add(Loss::Dropped, "TIS without a finite value, written as 0", lostTis);
}

}  // namespace

Result<SpecularTable> parseZemax(std::string_view text, std::string_view name) {
    return Reader(text, name).read();
}

Result<SpecularTable> readZemax(const std::filesystem::path& path) {
    const Result<std::string> text = readFile(path);
    if (!text) return text.error();
    return parseZemax(*text, path.string());
}

Written writeZemax(const SpecularTable& table) {
    assert(table.colour != TableColour::LedBands);  // three files, or a stated conversion to XYZ
    Written out;
    appendComments(out.bytes, table.comments);
    out.bytes += "Source  Measured\nSymmetry  " + std::string(spelling(table.symmetry));
    out.bytes += table.colour == TableColour::Xyz ? "\nSpectralContent  XYZ\n"
                                                  : "\nSpectralContent  Monochrome\n";
    out.bytes += table.kind == ScatterKind::Brdf ? "ScatterType  BRDF\n" : "ScatterType  BTDF\n";
    appendAxis(out.bytes, kRotations, table.rotationDeg);
    appendAxis(out.bytes, kIncidences, table.incidenceDeg);
    appendAxis(out.bytes, kAzimuths, table.azimuthDeg);
    appendAxis(out.bytes, kRadials, table.radialDeg);
    for (std::size_t plane = 0; plane < table.planes.size(); ++plane) {
        appendPlane(out, table, plane);
    }
    return out;
}

std::string wavelengthComment(double nanometres) {
    return "Wavelength (nm) = " + shortest(nanometres);
}

}  // namespace gonio::proc
