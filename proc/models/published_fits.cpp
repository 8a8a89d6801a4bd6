#include "proc/models/published_fits.h"

#include <array>
#include <fstream>
#include <map>
#include <optional>
#include <string_view>

#include "proc/core/number_text.h"
#include "proc/core/units.h"
#include "proc/models/spec_parameters.h"

namespace gonio::proc {
namespace {

std::string_view stripped(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// "NAME(INSIDE)" at the start of `text`, and what follows it.
struct Call {
    std::string_view name;
    std::string_view inside;
    std::string_view rest;
};
std::optional<Call> callOf(std::string_view text) {
    text = stripped(text);
    const std::size_t open = text.find('(');
    if (open == std::string_view::npos) return std::nullopt;
    int depth = 0;
    for (std::size_t i = open; i < text.size(); ++i) {
        if (text[i] == '(') ++depth;
        if (text[i] == ')' && --depth == 0) {
            return Call{stripped(text.substr(0, open)),
                        text.substr(open + 1, i - open - 1),
                        text.substr(i + 1)};
        }
    }
    return std::nullopt;
}

using Values = std::map<std::string, std::vector<double>, std::less<>>;

/// "albedo = [a, b, c], roughness = x": lists of three and single numbers.
std::optional<Values> valuesOf(std::string_view inside) {
    Values values;
    while (!stripped(inside).empty()) {
        const std::size_t equals = inside.find('=');
        if (equals == std::string_view::npos) return std::nullopt;
        const std::string key(stripped(inside.substr(0, equals)));
        std::string_view rest = stripped(inside.substr(equals + 1));
        const bool list = rest.starts_with('[');
        const std::size_t end = rest.find(list ? ']' : ',');
        if (list && end == std::string_view::npos) return std::nullopt;
        std::vector<double>& numbers = values[key];
        for (std::string_view word : split(rest.substr(list ? 1 : 0, list ? end - 1 : end), ',')) {
            const auto number = parseDouble(stripped(word));
            if (!number) return std::nullopt;
            numbers.push_back(*number);
        }
        rest = end == std::string_view::npos ? std::string_view{}
                                             : stripped(rest.substr(end + (list ? 1 : 0)));
        if (!rest.empty() && rest.front() != ',') return std::nullopt;
        inside = rest.empty() ? rest : rest.substr(1);
    }
    return values;
}

std::string bandsText(const std::vector<double>& rgb, double factor = 1) {
    return shortest(rgb[0] * factor) + "/" + shortest(rgb[1] * factor) + "/" +
           shortest(rgb[2] * factor);
}

struct Lobe {
    std::string_view model;
    std::vector<std::string_view> keys;  ///< single numbers, besides the albedo
    std::string (*spec)(const Values& values);
};

double one(const Values& values, std::string_view key) { return values.find(key)->second.front(); }
const std::vector<double>& albedo(const Values& values) { return values.find("albedo")->second; }

const std::array<Lobe, 4>& lobes() {
    static const std::array<Lobe, 4> all{
        Lobe{"NganWard",
             {"roughness"},
             [](const Values& v) {
                 return "ward,ks=" + bandsText(albedo(v)) +
                        ",alpha=" + shortest(one(v, "roughness"));
             }},
        Lobe{"NganCookTorrance",
             {"eta", "roughness"},
             [](const Values& v) {
                 return "cook-torrance,ks=" + bandsText(albedo(v), 1 / kPi) +
                        ",f0=" + shortest(one(v, "eta")) + ",m=" + shortest(one(v, "roughness"));
             }},
        Lobe{"NganLafortune",
             {"Cxy", "Cz", "sharpness"},
             [](const Values& v) {
                 return "lafortune,ks=" + bandsText(albedo(v)) + ",cxy=" + shortest(one(v, "Cxy")) +
                        ",cz=" + shortest(one(v, "Cz")) + ",n=" + shortest(one(v, "sharpness"));
             }},
        Lobe{"LowCookTorrance", {"roughness", "eta"}, [](const Values& v) {
                 return "low,ks=" + bandsText(albedo(v)) +
                        ",roughness=" + shortest(one(v, "roughness")) +
                        ",eta=" + shortest(one(v, "eta"));
             }}};
    return all;
}

bool holds(const Values& values, const std::vector<std::string_view>& keys) {
    const auto found = values.find("albedo");
    if (found == values.end() || found->second.size() != 3) return false;
    for (std::string_view key : keys) {
        const auto value = values.find(key);
        if (value == values.end() || value->second.size() != 1) return false;
    }
    return values.size() == keys.size() + 1;
}

std::optional<std::string> specOf(const Call& part) {
    const std::optional<Values> values = valuesOf(part.inside);
    if (!values) return std::nullopt;
    if (part.name == "Lambertian") {
        if (!holds(*values, {})) return std::nullopt;
        return "lambert,albedo=" + bandsText(albedo(*values));
    }
    for (const Lobe& lobe : lobes()) {
        if (lobe.model == part.name && holds(*values, lobe.keys)) return lobe.spec(*values);
    }
    return std::nullopt;
}

/// What a line says of one material.
Result<PublishedFit> fitOf(std::string_view line) {
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) {
        return Error{ErrorKind::File, "wanted NAME = Aggregate(...)"};
    }
    PublishedFit fit{.material = std::string(stripped(line.substr(0, equals))), .spec = {}};
    const std::optional<Call> aggregate = callOf(line.substr(equals + 1));
    if (!aggregate || aggregate->name != "Aggregate" || fit.material.empty()) {
        return Error{ErrorKind::File, "wanted NAME = Aggregate(...)"};
    }
    for (std::string_view left = stripped(aggregate->inside); !left.empty();) {
        const std::optional<Call> part = callOf(left);
        const std::optional<std::string> spec = part ? specOf(*part) : std::nullopt;
        if (!spec) {
            return Error{ErrorKind::File,
                         fit.material + ": '" + std::string(left.substr(0, 40)) +
                             "' is none of Lambertian, NganWard, NganCookTorrance, NganLafortune, "
                             "LowCookTorrance with its parameters"};
        }
        fit.spec += (fit.spec.empty() ? "" : "+") + *spec;
        left = stripped(part->rest);
        if (left.starts_with(',')) left = stripped(left.substr(1));
    }
    return fit;
}

}  // namespace

Result<std::vector<PublishedFit>> readPublishedFits(const std::filesystem::path& file) {
    const std::string name = "'" + file.string() + "'";
    std::ifstream in(file);
    if (!in) return Error{ErrorKind::File, name + ": cannot be opened"};
    std::vector<PublishedFit> fits;
    std::string line;
    for (std::size_t number = 1; std::getline(in, line); ++number) {
        const std::string_view text = stripped(line);
        if (text.empty() || text.front() == '#') continue;
        Result<PublishedFit> fit = fitOf(text);
        if (!fit) return fit.error().in(name + ": line " + std::to_string(number));
        fits.push_back(std::move(*fit));
    }
    if (fits.empty()) return Error{ErrorKind::File, name + ": holds no fit"};
    return fits;
}

}  // namespace gonio::proc
