#include "proc/formats/ssdd.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <set>
#include <utility>

#include "proc/core/number_text.h"
#include "proc/formats/shown.h"
#include "proc/formats/spherical_warnings.h"
#include "proc/formats/ssdd_grid.h"
#include "proc/formats/words.h"

namespace gonio::proc {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they stand");

constexpr std::string_view kSpherical = "spherical_coordinate_system";
constexpr std::string_view kSpecular = "specular_coordinate_system";

/// A table of fewer bytes than these, on average, is none: bounds the memory by the file.
constexpr std::size_t kLeastBytesPerTable = 16;

/// Lines of text, and the bytes of grids between them.
class Lines {
public:
    explicit Lines(std::string_view bytes) : bytes_(bytes) {
        if (bytes_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    }
    [[nodiscard]] bool done() const { return at_ >= bytes_.size(); }
    [[nodiscard]] int number() const { return line_; }
    [[nodiscard]] std::size_t bytesLeft() const { return bytes_.size() - at_; }
    [[nodiscard]] std::size_t size() const { return bytes_.size(); }

    std::string_view take() {
        const std::size_t end = std::min(bytes_.find_first_of("\r\n", at_), bytes_.size());
        const std::string_view line = bytes_.substr(at_, end - at_);
        at_ = std::min(bytes_.size(), end + (bytes_.substr(end).starts_with("\r\n") ? 2 : 1));
        ++line_;
        return line;
    }
    std::string_view takeBytes(std::size_t count) {
        const std::string_view taken = bytes_.substr(at_, count);
        at_ += taken.size();
        return taken;
    }

private:
    std::string_view bytes_;
    std::size_t at_ = 0;
    int line_ = 0;
};

std::vector<std::string_view> wordsOf(std::string_view line) {
    constexpr std::string_view kSpace = " \t\f\v";
    std::vector<std::string_view> words;
    for (std::size_t at = line.find_first_not_of(kSpace); at != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(kSpace, at), line.size());
        words.push_back(line.substr(at, end - at));
        at = line.find_first_not_of(kSpace, end);
    }
    return words;
}

class Reader {
public:
    Reader(std::string_view bytes, std::string_view name) : lines_(bytes), name_(name) {}

    Result<FileRead<SsddTable>> read() {
        while (!lines_.done()) {
            if (!line(lines_.take())) return *error_;
        }
        if (inBlock_ && !fail("the file ends, wanted DATA")) return *error_;
        if (!hasTable_ && !fail("no brdf or btdf of a kind that is read")) return *error_;
        finish();
        return std::move(out_);
    }

private:
    bool fail(const std::string& what) {
        if (!error_) {
            error_ = Error{ErrorKind::File,
                           "ssdd: " + std::string(name_) + ": line " +
                               std::to_string(lines_.number()) + ": " + what};
        }
        return false;
    }

    bool line(std::string_view text) {
        const std::size_t hash = text.find('#');
        if (hash != std::string_view::npos) {
            std::string_view comment = text.substr(hash + 1);
            if (comment.starts_with(' ')) comment.remove_prefix(1);
            if (comments_.size() == Words::kMostComments) {
                return fail("more than " + std::to_string(Words::kMostComments) + " comments");
            }
            comments_.emplace_back(comment);
            text = text.substr(0, hash);
        }
        const auto words = wordsOf(text);
        if (words.empty()) return true;
        const std::string key = lower(words[0]);
        if (!seen_.insert(key).second && key != "data_type") {
            return fail(shown(words[0]) + " is given twice");
        }
        const bool first = !hasVersion_;
        if (key == "version") {
            hasVersion_ = true;
            return words.size() == 2 &&
                           (words[1] == "0.1" || words[1] == "0.2" || words[1] == "0.3")
                       ? true
                       : fail(shown(text) + ", wanted VERSION 0.1, 0.2 or 0.3");
        }
        if (first) return fail(shown(words[0]) + ", wanted VERSION");
        if (isText(key, text)) return true;
        if (!inBlock_ && key != "data_type") return fail(shown(words[0]) + ", wanted DATA_TYPE");
        if (words.size() < 2) return fail("nothing after " + shown(words[0]));
        if (key == "data_type") return begin(words);
        return property(key, words);
    }

    /// Properties that are free text.
    bool isText(const std::string& key, std::string_view text) {
        constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kTexts{{
            {"software", key::kSoftware},
            {"api", ""},
            {"date", ""},
            {"name", key::kSample},
            {"device", key::kRig},
            {"measurement_date", key::kDate},
            {"creation_date", ""},
            {"source_type", ""},
        }};
        for (const auto& [known, name] : kTexts) {
            if (key != known) continue;
            const auto words = wordsOf(text);
            if (!name.empty() && words.size() > 1) {
                const auto start = static_cast<std::size_t>(words[1].data() - text.data());
                const auto end = static_cast<std::size_t>(words.back().data() - text.data()) +
                                 words.back().size();
                fields_.set(name, std::string(text.substr(start, end - start)));
            }
            return true;
        }
        return false;
    }

    bool begin(const std::vector<std::string_view>& words) {
        if (inBlock_) return fail("DATA_TYPE, but the block before has no DATA");
        inBlock_ = true;
        grid_ = {};
        seen_ = {"version"};
        type_ = lower(words[1]);
        for (const char* known :
             {"brdf", "btdf", "specular_reflectance", "specular_transmittance"}) {
            if (type_ != known) continue;
            return types_.insert(type_).second || fail("a second block of " + type_);
        }
        return fail(shown(words[1]) + " is no DATA_TYPE");
    }

    bool property(const std::string& key, const std::vector<std::string_view>& words) {
        if (key == "color_model") return colour(words[1]);
        if (key == "param_type") {
            grid_.parameters = lower(words[1]);
            return true;
        }
        if (key == "reduction_type") return reductions(words);
        if (key == "wavelength_list") return list(words, 1e9, wavelengths_);
        if (key.size() == 11 && key.starts_with("param") && key.ends_with("_list")) {
            const std::size_t which = static_cast<unsigned char>(key[5]) - std::size_t{'0'};
            if (which < 4) return list(words, 360, grid_.list[which]);
            if (which == 4) return offsets(words);
        }
        if (key == "data") return data(lower(words[1]));
        return fail("unknown property " + shown(words[0]));
    }

    bool colour(std::string_view word) {
        grid_.colourModel = lower(word);
        for (const char* known : {"monochrome", "rgb", "xyz", "spectrum"}) {
            if (grid_.colourModel == known) return true;
        }
        return fail(shown(word) + " is no COLOR_MODEL");
    }

    bool reductions(const std::vector<std::string_view>& words) {
        for (std::size_t i = 1; i < words.size(); ++i) {
            const std::string word = lower(words[i]);
            if (word == "bilateral_symmetry") {
                grid_.symmetrical = true;
            } else if (word == "reciprocity") {
                grid_.reciprocal = true;
            } else {
                return fail(shown(words[i]) + " is no REDUCTION_TYPE");
            }
        }
        return true;
    }

    bool list(const std::vector<std::string_view>& words, double most, std::vector<double>& into) {
        into.clear();
        for (std::size_t i = 1; i < words.size(); ++i) {
            const auto value = parseDouble(words[i]);
            if (!value || *value < 0 || *value > most) {
                return fail(shown(words[i]) + ", wanted numbers in [0, " + shortest(most) + "]");
            }
            if (!into.empty() && *value < into.back() + kFinestStepDeg) {
                return fail(shown(words[i]) + " after " + shortest(into.back()) +
                            ": lists must ascend");
            }
            into.push_back(*value);
        }
        return true;
    }
    bool offsets(const std::vector<std::string_view>& words) {
        for (std::size_t i = 1; i < words.size(); ++i) {
            const auto value = parseDouble(words[i]);
            if (!value) return fail(shown(words[i]) + " is not a finite number");
            grid_.list[4].push_back(*value);
        }
        return true;
    }

    [[nodiscard]] bool isTable() const { return type_ == "brdf" || type_ == "btdf"; }

    bool data(const std::string& mode) {
        if (mode != "ascii" && mode != "binary") {
            return fail(shown(mode) + ", wanted DATA ascii or binary");
        }
        if (!gridIsWhole()) return false;
        if (mode == "ascii" ? !ascii() : !binary()) return false;
        inBlock_ = false;
        seen_ = {"version"};
        if (!isTable()) {
            out_.warnings.push_back("the block of " + type_ + " is not read");
            return true;
        }
        return keep();
    }

    bool gridIsWhole() {
        if (grid_.colourModel.empty()) return fail("a block has no COLOR_MODEL");
        if (grid_.colourModel == "spectrum") {
            if (wavelengths_.empty()) return fail("a spectrum has no WAVELENGTH_LIST");
            for (const double nm : wavelengths_) grid_.channels.push_back(Channel::at(nm));
        } else if (grid_.colourModel == "rgb") {
            grid_.channels = {{"R", {}}, {"G", {}}, {"B", {}}};
        } else if (grid_.colourModel == "xyz") {
            grid_.channels = {{"X", {}}, {"Y", {}}, {"Z", {}}};
        } else {
            grid_.channels = {Channel{}};
        }
        wavelengths_.clear();
        if (grid_.list[0].empty()) return fail("a block has no PARAM0_LIST");
        if (grid_.list[1].empty()) grid_.list[1] = {0};
        for (const std::size_t i : {2U, 3U}) {
            if (!isTable()) grid_.list[i] = {0};
            if (grid_.list[i].empty()) {
                return fail("a block has no PARAM" + std::to_string(i) + "_LIST");
            }
        }
        return !isTable() || parametersAreKnown();
    }

    bool parametersAreKnown() {
        if (grid_.parameters != kSpherical && grid_.parameters != kSpecular) {
            return fail("PARAM_TYPE " + shown(grid_.parameters) + " is not read, only " +
                        std::string(kSpherical) + " and " + std::string(kSpecular));
        }
        if (grid_.reciprocal) {
            return fail("REDUCTION_TYPE reciprocity is of half_difference_coordinate_system only");
        }
        const bool spherical = grid_.parameters == kSpherical;
        if (grid_.list[0].back() > 90) return fail("PARAM0_LIST goes beyond 90 degrees");
        if (grid_.list[2].back() > (spherical ? 90 : 180)) {
            return fail("PARAM2_LIST goes beyond " + std::string(spherical ? "90" : "180") +
                        " degrees");
        }
        if (grid_.symmetrical && grid_.list[1].size() > 1) {
            return fail("bilateral_symmetry of several incoming azimuths is not read");
        }
        if (grid_.symmetrical && grid_.list[1].front() != 0) {
            return fail("bilateral_symmetry of light at azimuth " + shortest(grid_.list[1][0]) +
                        " (PARAM1_LIST), wanted 0: only there the sides of x and of the light "
                        "are the same");
        }
        if (grid_.symmetrical && grid_.list[3].back() > 180) {
            return fail("bilateral_symmetry, but PARAM3_LIST goes beyond 180 degrees");
        }
        return true;
    }

    /// Points of the grid, not more than there is room for; empty after a complaint.
    std::optional<std::size_t> points(std::size_t bytesPerValue) {
        std::size_t values = grid_.channels.size();
        bool fits = true;
        for (std::size_t i = 0; i < 4; ++i) {
            fits = fits && !__builtin_mul_overflow(values, grid_.list[i].size(), &values);
        }
        if (!fits || values > lines_.bytesLeft() / bytesPerValue + 1) {
            fail("a grid of " + std::to_string(grid_.list[0].size()) + " x " +
                 std::to_string(grid_.list[1].size()) + " x " +
                 std::to_string(grid_.list[2].size()) + " x " +
                 std::to_string(grid_.list[3].size()) + " colours, " +
                 std::to_string(lines_.bytesLeft()) + " bytes are left");
            return std::nullopt;
        }
        const std::size_t tables =
            grid_.channels.size() * grid_.list[0].size() * grid_.list[1].size();
        if (isTable() && tables > lines_.size() / kLeastBytesPerTable + 1) {
            fail(std::to_string(tables) + " light directions and channels in a file of " +
                 std::to_string(lines_.size()) + " bytes");
            return std::nullopt;
        }
        return values / grid_.channels.size();
    }

    bool ascii() {
        const auto wanted = points(2);
        if (!wanted) return false;
        grid_.values.reserve(*wanted * grid_.channels.size());
        for (std::size_t got = 0; got < *wanted;) {
            if (lines_.done()) {
                return fail(std::to_string(got) + " colours, the lists promised " +
                            std::to_string(*wanted));
            }
            const std::string_view text = lines_.take();
            const auto words = wordsOf(text.substr(0, text.find('#')));
            if (words.empty()) continue;
            for (const std::string_view word : words) {
                const auto value = parseDouble(word);
                if (!value) return fail(shown(word) + " is not a finite number");
                grid_.values.push_back(*value);
            }
            if (words.size() != grid_.channels.size()) {
                return fail(std::to_string(words.size()) + " values in a line, wanted " +
                            std::to_string(grid_.channels.size()));
            }
            ++got;
        }
        return true;
    }

    bool binary() {
        const auto wanted = points(sizeof(float));
        if (!wanted) return false;
        const std::size_t values = *wanted * grid_.channels.size();
        const std::string_view bytes = lines_.takeBytes(values * sizeof(float));
        if (bytes.size() < values * sizeof(float)) {
            return fail(std::to_string(bytes.size()) +
                        " bytes of binary data, the lists promised " +
                        std::to_string(values * sizeof(float)));
        }
        grid_.values.resize(values);
        for (std::size_t i = 0; i < values; ++i) {
            float value = 0;
            std::memcpy(&value, bytes.data() + i * sizeof(float), sizeof(float));
            if (!std::isfinite(value)) {
                return fail("value " + std::to_string(i + 1) + " of the binary data is not finite");
            }
            grid_.values[i] = static_cast<double>(value);
        }
        return true;
    }

    bool keep() {
        grid_.transmission = type_ == "btdf";
        for (std::string& warning : withoutGrazingLight(grid_)) {
            out_.warnings.push_back(type_ + ": " + warning);
        }
        if (grid_.list[0].empty()) return fail(type_ + " has no incidence below 90 degrees");
        if (!hasTable_) {
            hasTable_ = true;
            return first();
        }
        auto* spherical = std::get_if<SphericalTable>(&out_.content);
        if (spherical == nullptr || grid_.parameters != kSpherical ||
            spherical->channels != grid_.channels ||
            spherical->planeSymmetrical != grid_.symmetrical) {
            out_.warnings.push_back("the block of " + type_ +
                                    " is not read: it does not fit into one table with the first");
            return true;
        }
        appendSpherical(grid_, *spherical);
        return true;
    }

    bool first() {
        if (grid_.parameters == kSpherical) {
            SphericalTable table{.channels = grid_.channels, .blocks = {}};
            appendSpherical(grid_, table);
            out_.content = std::move(table);
            return true;
        }
        auto table = specularTable(grid_);
        if (!table) return fail(table.error().message);
        out_.content = std::move(*table);
        return true;
    }

    void finish() {
        out_.about = metadataOfLines(std::exchange(comments_, {}));
        for (const auto& [name, value] : fields_.values) {
            if (out_.about.at(name).empty()) out_.about.set(name, value);
        }
        if (auto* specular = std::get_if<SpecularTable>(&out_.content)) {
            specular->comments = metadataLines(out_.about);
            return;
        }
        for (std::string& warning : sphericalWarnings(std::get<SphericalTable>(out_.content))) {
            out_.warnings.push_back(std::move(warning));
        }
    }

    Lines lines_;
    std::string_view name_;
    FileRead<SsddTable> out_{.content = {}, .about = {}};
    Metadata fields_;
    std::vector<std::string> comments_;
    std::set<std::string> seen_, types_;
    std::vector<double> wavelengths_;
    SsddGrid grid_;
    std::string type_;
    bool hasVersion_ = false, inBlock_ = false, hasTable_ = false;
    std::optional<Error> error_;
};

}  // namespace

Result<FileRead<SsddTable>> parseSsdd(std::string_view bytes, std::string_view name) {
    return Reader(bytes, name).read();
}

}  // namespace gonio::proc
