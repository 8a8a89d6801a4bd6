#include "proc/report/reflectance_tables.h"

#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "proc/estimate/sample_albedo.h"
#include "proc/quality/reciprocity.h"
#include "proc/report/plot_request.h"
#include "proc/report/report_words.h"
#include "proc/report/sample_cells.h"
#include "proc/table/merged_info.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

HtmlTable albedoTable(const std::string& caption, const std::vector<Band>& bands) {
    HtmlTable table{.caption = caption, .head = {"light at"}, .rows = {}};
    for (const Band band : bands) {
        table.head.push_back(bandName(band));
        table.head.emplace_back("no answer in");
    }
    return table;
}

void addRow(HtmlTable& table,
            const std::string& light,
            const Albedo& albedo,
            const std::vector<Band>& bands) {
    std::vector<std::string> row{light};
    for (const Band band : bands) {
        row.push_back(withExpanded(albedo[band].value, albedo[band].u()));
        row.push_back(shareText(albedo[band].missing));
    }
    table.add(row);
}

/// "0.1800 +- 0.0052, line within 0.0031".
std::string withBound(const BandAlbedo& mean) {
    const std::string value = withExpanded(mean.value, mean.u());
    if (!std::isfinite(mean.value)) return value;
    return value + (std::isfinite(mean.errorBound)
                        ? ", line within " + significant(mean.errorBound, 2)
                        : ", error of the line not known");
}

void addMean(HtmlTable& table, const SampleSet& sample, const std::vector<Band>& bands) {
    const Albedo mean = meanAlbedo(sample);
    std::vector<std::string> row{"bihemispherical mean"};
    for (const Band band : bands) {
        row.push_back(withBound(mean[band]));
        row.push_back(shareText(mean[band].missing));
    }
    table.add(row);
}

/// Of the LEDs of one rotation.
void addPairs(HtmlTable& table, const SampleSet& part, const std::vector<Band>& bands) {
    std::map<std::tuple<std::size_t, std::size_t, bool>, std::array<std::string, 3>> rows;
    for (const ReciprocalPair& pair : reciprocalPairs(part)) {
        rows[{pair.led, pair.other, pair.mirrored}][index(pair.band)] =
            "(" + withExpanded(100 * pair.difference, 100 * pair.u) + ") %";
    }
    for (const auto& [key, differences] : rows) {
        const auto& [led, other, mirrored] = key;
        std::vector<std::string> row{
            degreesLabel(part.leds[led].incidence) + " and " + lightLabel(part.leds[other]),
            mirrored ? "away from the light" : "of the light"};
        for (const Band band : bands) {
            const std::string& words = differences[index(band)];
            row.push_back(words.empty() ? "not seen" : words);
        }
        table.add(row);
    }
}

}  // namespace

HtmlTable cellAlbedoTable(const SampleSet& sample) {
    const std::vector<Band> bands = measuredBands(sample);
    HtmlTable table = albedoTable(
        "Reflectance of the measured cells: directional-hemispherical by incidence, each a lower "
        "bound, and the bihemispherical mean over the incidences",
        bands);
    for (const LedTable& led : sample.leds)
        addRow(table, lightLabel(led), directionalAlbedo(led), bands);
    if (sample.leds.size() > 1) addMean(table, sample, bands);
    return table;
}

HtmlTable filledAlbedoTable(const SampleSet& sample, const Scatterer& surface) {
    const std::vector<Band> bands = measuredBands(sample);
    HtmlTable table =
        albedoTable("Directional-hemispherical reflectance with what is missing filled in", bands);
    for (const LedTable& led : sample.leds)
        addRow(table, lightLabel(led), filledAlbedo(led, surface), bands);
    return table;
}

HtmlTable reciprocityTable(const SampleSet& sample) {
    const std::vector<Band> bands = measuredBands(sample);
    HtmlTable table{.caption = "Light and view exchanged: difference over the mean of both",
                    .head = {"incidences", "view on the side"},
                    .rows = {}};
    for (const Band band : bands) table.head.push_back(bandName(band));
    for (const Radians rotation : rotationsOf(sample)) {
        SampleSet part = tablesAt(sample, rotation);
        sortTables(part);  // as the pairs number its LEDs
        addPairs(table, part, bands);
    }
    return table;
}

}  // namespace gonio::proc
