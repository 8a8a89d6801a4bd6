#include "proc/formats/pab.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "proc/core/number_text.h"
#include "proc/core/quantities.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/row_notes.h"
#include "proc/formats/shown.h"
#include "proc/formats/text_lines.h"
#include "proc/formats/words.h"

namespace gonio::proc {
namespace {

constexpr std::string_view kForeign = "pab.";

class Reader {
public:
    Reader(std::string_view text, std::string_view name) : lines_(text), name_(name) {}

    Result<FileRead<BrdfRows>> read() {
        std::vector<std::string_view> words;
        while (const auto line = lines_.next()) {
            const std::string_view content = trimmed(*line);
            if (content.empty()) continue;
            const bool keyword = content.front() == '#';
            if (keyword && !headerLine(content.substr(1))) return *error_;
            if (keyword) continue;
            if (rows().channels.empty() && !begin()) return *error_;
            words = wordsIn(content, std::move(words));
            if (!row(words)) return *error_;
        }
        if (!end()) return *error_;
        return std::move(read_);
    }

private:
    bool fail(const std::string& what) {
        error_ = Error{ErrorKind::File,
                       "pab: " + std::string(name_) + ": line " + std::to_string(lines_.number()) +
                           ": " + what};
        return false;
    }
    bool keepComment(std::string_view line) {
        return comments_.add(line) ||
               fail("more than " + std::to_string(CommentLines::kMost) + " comments");
    }

    bool headerLine(std::string_view line) {
        const std::size_t size = std::min(line.find_first_of(" \t"), line.size());
        std::string_view keyword = line.substr(0, size);
        const std::string_view value = trimmed(line.substr(size));
        if (keyword.empty()) {
            return keepComment(line.empty() ? line : line.substr(1));
        }
        if (keyword.ends_with(':')) keyword.remove_suffix(1);
        const std::string known = lower(keyword);
        // Free text may begin with any word; only what is read must not come twice.
        constexpr std::array<std::string_view, 7> kKnown{"format",
                                                         "intheta",
                                                         "inphi",
                                                         "incident_angle",
                                                         "colorimetry",
                                                         "datapoints_in_file",
                                                         "sample_name"};
        if (std::find(kKnown.begin(), kKnown.end(), known) == kKnown.end()) {
            if (known == "upphi") return angle(keyword, value, upPhi_);
            return keepComment(line);
        }
        if (!keys_.insert(known).second) return fail("#" + known + " is given twice");
        if (!rows().channels.empty()) return fail("#" + known + " among the rows");
        return knownLine(known, value);
    }
    bool knownLine(const std::string& known, std::string_view value) {
        if (known == "format") return format(value);
        if (known == "intheta") return angle(known, value, theta_);
        if (known == "inphi") return angle(known, value, phi_);
        if (known == "incident_angle") return incidentAngle(value);
        if (known == "colorimetry") return colorimetry(value);
        if (known == "datapoints_in_file") {
            promised_ = parseInteger(value);
            return (promised_ && *promised_ >= 0) ||
                   fail("#datapoints_in_file: " + shown(value) + ", wanted a number of rows");
        }
        const bool quoted = value.size() >= 2 && value.front() == '"' && value.back() == '"';
        read_.about.set(key::kSample,
                        std::string(quoted ? value.substr(1, value.size() - 2) : value));
        return true;
    }
    bool angle(std::string_view keyword, std::string_view value, std::optional<double>& into) {
        const auto degrees = parseDouble(value);
        if (!degrees)
            return fail("#" + printable(keyword) + ": " + shown(value) + ", wanted degrees");
        if (into && *into != *degrees) {
            return fail("#" + printable(keyword) + " is " + shown(value) + ", said before to be " +
                        shortest(*into));
        }
        into = degrees;
        return true;
    }
    bool incidentAngle(std::string_view value) {
        const std::vector<std::string_view> words = wordsIn(value);
        if (words.size() != 2)
            return fail("#incident_angle " + shown(value) + ", wanted theta phi");
        return angle("incident_angle", words[0], theta_) && angle("incident_angle", words[1], phi_);
    }
    bool format(std::string_view value) {
        const std::vector<std::string_view> words = wordsIn(value);
        const bool columns =
            words.size() == 3 && lower(words[0]) == "theta" && lower(words[1]) == "phi";
        const std::string kind = columns ? lower(words[2]) : "";
        cosine_ = kind == "dsf";
        transmission_ = kind == "btdf";
        if (cosine_ || transmission_ || kind == "bsdf" || kind == "brdf") {
            formatIsSaid_ = true;
            return true;
        }
        return fail("#format " + shown(value) + ", wanted theta phi and DSF, BSDF, BRDF or BTDF");
    }
    bool colorimetry(std::string_view value) {
        const std::string kind = lower(value);
        xyz_ = kind == "cie-xyz";
        if (!xyz_ && kind != "cie-y") {
            return fail("#colorimetry " + shown(value) + ", wanted CIE-Y or CIE-XYZ");
        }
        return true;
    }

    bool begin() {
        if (!formatIsSaid_) return fail("no #format before the first row");
        if (!theta_ || !phi_) return fail("no #intheta and #inphi, or #incident_angle");
        if (*theta_ < 0 || *theta_ > 180) {
            return fail("#intheta " + shortest(*theta_) + ", wanted [0, 180]");
        }
        in_ = fileDirection(Radians::fromDegrees(*theta_), Radians::fromDegrees(*phi_));
        if (xyz_) {
            for (const char* letter : {"X", "Y", "Z"}) {
                rows().channels.push_back({letter, std::nullopt});
            }
        } else {
            rows().channels.emplace_back();
        }
        return true;
    }

    bool row(const std::vector<std::string_view>& words) {
        const std::size_t values = rows().channels.size();
        if (words.size() != 2 + values) {
            return fail(std::to_string(words.size()) + " numbers, wanted theta, phi and " +
                        std::to_string(values) + (values == 1 ? " value" : " values"));
        }
        std::array<double, 5> numbers{};
        for (std::size_t i = 0; i < words.size(); ++i) {
            const auto number = parseDouble(words[i]);
            if (!number) return fail(shown(words[i]) + ", wanted a number");
            numbers[i] = *number;
        }
        if (numbers[0] < 0 || numbers[0] > 180) {
            return fail("a theta of " + shown(words[0]) + ", wanted degrees in [0, 180]");
        }
        const Direction out =
            fileDirection(Radians::fromDegrees(numbers[0]), Radians::fromDegrees(numbers[1]));
        rows().pairs.push_back({.in = in_, .out = out});
        if (transmission_ && out.z() * in_.z() > 0) ++sameSide_;
        for (std::size_t c = 0; c < values; ++c) {
            double f = numbers[2 + c];
            if (cosine_) f = toBrdf(Ars(f), std::abs(out.z())).value();
            if (std::isnan(f)) ++atHorizon_;
            rows().f.push_back(f);
        }
        return true;
    }

    bool end() {
        const auto count = static_cast<std::int64_t>(rows().pairs.size());
        if (count == 0) return fail("no row of values");
        if (promised_ && *promised_ != count) {
            return fail(std::to_string(count) + " rows, #datapoints_in_file promised " +
                        std::to_string(*promised_));
        }
        Metadata told = metadataOfLines(comments_.all());
        for (auto& [name, value] : told.values) read_.about.set(name, std::move(value));
        read_.about.comments = std::move(told.comments);
        if (upPhi_) read_.about.set(std::string(kForeign) + "upphi", shortest(*upPhi_));
        takeRowNotes(read_.about, rows());
        if (cosine_) read_.about.set(key::kCosine, "yes");
        read_.warnings = negativeValues(rows());
        const auto warn = [&](std::size_t number, const char* what) {
            if (number > 0) read_.warnings.push_back(std::to_string(number) + what);
        };
        warn(atHorizon_, " values at the horizon, where a DSF tells no f");
        warn(sameSide_, " rows of a BTDF on the light's side of the surface");
        return true;
    }

    BrdfRows& rows() { return read_.content; }

    TextLines lines_;
    std::string_view name_;
    FileRead<BrdfRows> read_;
    std::set<std::string> keys_;
    CommentLines comments_;
    std::optional<double> theta_, phi_, upPhi_;
    std::optional<std::int64_t> promised_;
    bool formatIsSaid_ = false, cosine_ = false, transmission_ = false, xyz_ = false;
    Direction in_;
    std::size_t atHorizon_ = 0, sameSide_ = 0;
    std::optional<Error> error_;
};

/// The rows of one light on one side of the surface.
struct OneLight {
    Direction in;
    double thetaDeg = 0, phiDeg = 0;
    bool back = false;
    std::vector<std::size_t> pairs;
};

class Writer {
public:
    Writer(const BrdfRows& rows, const Metadata& about) : rows_(rows), about_(about) {}

    Result<WrittenPab> write() {
        if (!gather()) {
            return Error{ErrorKind::Usage,
                         "pab: more than " + std::to_string(kMostPabLights) +
                             " light directions: each would be a file"};
        }
        nameFiles();
        nameChannels();
        for (std::size_t i = 0; i < lights_.size(); ++i) {
            if (isXyz()) {
                add(lights_[i], suffixes_[i], 0, 3);
                continue;
            }
            for (std::size_t c = 0; c < rows_.channels.size(); ++c) {
                add(lights_[i], suffixes_[i] + channelSuffixes_[c], c, c + 1);
            }
        }
        if (written_.files.empty()) return noWholeRow("pab");
        written_.loss.add(Loss::Masked, "missing values of all its files, left out", missing_);
        written_.loss.add(Loss::Dropped,
                          "values of all its files beside a missing one, left out with it",
                          beside_);
        countDroppedColumns(rows_, written_.loss);
        const auto named = [](const Channel& channel) { return !channel.name.empty(); };
        const auto names = std::count_if(rows_.channels.begin(), rows_.channels.end(), named);
        if (!isXyz()) {
            written_.loss.add(Loss::Dropped, "names of channels", static_cast<std::size_t>(names));
        }
        return std::move(written_);
    }

private:
    [[nodiscard]] bool isXyz() const {
        std::string letters;
        for (const Channel& channel : rows_.channels) letters += channel.name + " ";
        return letters == "X Y Z ";
    }

    bool gather() {
        std::size_t last = 0;
        std::array<std::size_t, 2> sides{};
        for (std::size_t pair = 0; pair < rows_.pairs.size(); ++pair) {
            const LightView& at = rows_.pairs[pair];
            const double theta = fileDegrees(at.in.theta());
            const double phi = fileAzimuthDegrees(at.in.phi());
            const bool back = at.out.z() * at.in.z() < 0;
            const auto same = [&](const OneLight& one) {
                return one.thetaDeg == theta && one.phiDeg == phi && one.back == back;
            };
            if (lights_.empty() || !same(lights_[last])) {
                const auto found = std::find_if(lights_.begin(), lights_.end(), same);
                last = static_cast<std::size_t>(found - lights_.begin());
                if (found == lights_.end()) {
                    if (++sides[back ? 1 : 0] > kMostPabLights) return false;
                    lights_.push_back({at.in, theta, phi, back, {}});
                }
            }
            lights_[last].pairs.push_back(pair);
        }
        return true;
    }

    static std::string padded(double degrees) {
        const std::string whole = std::to_string(static_cast<int>(degrees));
        const std::string text = shortest(degrees);
        return std::string(whole.size() < 3 ? 3 - whole.size() : 0, '0') + text;
    }
    void nameFiles() {
        for (const OneLight& light : lights_) {
            suffixes_.push_back("_t" + padded(light.thetaDeg) + "p" + padded(light.phiDeg) +
                                (light.back ? "_back" : ""));
        }
    }
    [[nodiscard]] std::string channelSuffix(std::size_t channel) const {
        if (rows_.channels.size() == 1) return "";
        const Channel& one = rows_.channels[channel];
        std::string name = lower(one.name);
        for (char& c : name) {
            if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
        }
        if (name.empty() && one.nanometres) name = shortest(*one.nanometres) + "nm";
        return "_" + (name.empty() ? std::to_string(channel + 1) : name);
    }

    /// Names of which only the letters differ that a file's name has not are told by their numbers.
    void nameChannels() {
        std::set<std::string> used;
        for (std::size_t c = 0; c < rows_.channels.size(); ++c) {
            std::string suffix = channelSuffix(c);
            while (!used.insert(suffix).second) suffix += "_" + std::to_string(c + 1);
            channelSuffixes_.push_back(std::move(suffix));
        }
    }

    /// Channels `first` up to `last`.
    void add(const OneLight& light, std::string suffix, std::size_t first, std::size_t last) {
        std::string body;
        std::size_t count = 0;
        for (const std::size_t pair : light.pairs) {
            std::size_t there = 0;
            for (std::size_t c = first; c < last; ++c) {
                there += std::isfinite(rows_.f[rows_.index(pair, c)]) ? 1U : 0U;
            }
            if (there < last - first) {
                missing_ += last - first - there;
                beside_ += there;
                continue;
            }
            ++count;
            const Direction& out = rows_.pairs[pair].out;
            appendShortest(body, fileDegrees(out.theta()));
            body += ' ';
            appendShortest(body, fileAzimuthDegrees(out.phi()));
            for (std::size_t c = first; c < last; ++c) {
                body += ' ';
                appendShortest(body, rows_.f[rows_.index(pair, c)]);
            }
            body += '\n';
        }
        if (count == 0) return;
        written_.files.push_back({std::move(suffix), header(light, first, last, count) + body});
    }
    std::string header(const OneLight& light,
                       std::size_t first,
                       std::size_t last,
                       std::size_t count) const {
        BrdfRows own;  // what the notes of this file are about
        own.channels = {rows_.channels.begin() + static_cast<std::ptrdiff_t>(first),
                        rows_.channels.begin() + static_cast<std::ptrdiff_t>(last)};
        own.isotropic = rows_.isotropic;
        Metadata rest = withRowNotes(about_, own, true);
        const std::string theta = shortest(light.thetaDeg), phi = shortest(light.phiDeg);
        std::string text;
        const std::string sample = onOneLine(about_.at(key::kSample));
        if (!sample.empty()) text += "#sample_name \"" + sample + "\"\n";
        for (const std::string& line : metadataLines(rest)) {
            if (!line.starts_with("gonio.pab.")) text += "# " + onOneLine(line) + "\n";
        }
        text += "#incident_angle " + theta + " " + phi + "\n#intheta " + theta + "\n#inphi " + phi +
                "\n";
        const std::string_view up = about_.at(std::string(kForeign) + "upphi");
        if (!up.empty()) text += "#upphi " + onOneLine(up) + "\n";
        if (last - first == 3) text += "#colorimetry: CIE-XYZ\n";
        return text + "#datapoints_in_file: " + std::to_string(count) + "\n#format: theta phi " +
               (light.back ? "BTDF" : "BRDF") + "\n";
    }

    const BrdfRows& rows_;
    const Metadata& about_;
    std::vector<OneLight> lights_;
    std::vector<std::string> suffixes_, channelSuffixes_;
    WrittenPab written_;
    std::size_t missing_ = 0, beside_ = 0;
};

}  // namespace

Result<FileRead<BrdfRows>> parsePab(std::string_view text, std::string_view name) {
    return Reader(text, name).read();
}

Result<WrittenPab> writePab(const BrdfRows& rows, const Metadata& about) {
    return Writer(rows, about).write();
}

}  // namespace gonio::proc
