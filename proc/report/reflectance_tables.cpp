#include "proc/report/reflectance_tables.h"

#include <array>
#include <map>
#include <tuple>

#include "proc/estimate/sample_albedo.h"
#include "proc/quality/reciprocity.h"
#include "proc/report/plot_request.h"
#include "proc/report/report_words.h"
#include "proc/report/sample_cells.h"

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

}  // namespace

HtmlTable cellAlbedoTable(const SampleSet& sample) {
    const std::vector<Band> bands = measuredBands(sample);
    HtmlTable table = albedoTable(
        "Directional-hemispherical reflectance of the measured cells, a lower bound", bands);
    for (const LedTable& led : sample.leds)
        addRow(table, degreesLabel(led.incidence), directionalAlbedo(led), bands);
    if (sample.leds.size() > 1) addRow(table, "mean", meanAlbedo(sample), bands);
    return table;
}

HtmlTable filledAlbedoTable(const SampleSet& sample, const Scatterer& surface) {
    const std::vector<Band> bands = measuredBands(sample);
    HtmlTable table =
        albedoTable("Directional-hemispherical reflectance with what is missing filled in", bands);
    for (const LedTable& led : sample.leds)
        addRow(table, degreesLabel(led.incidence), filledAlbedo(led, surface), bands);
    return table;
}

HtmlTable reciprocityTable(const SampleSet& sample) {
    const std::vector<Band> bands = measuredBands(sample);
    std::map<std::tuple<std::size_t, std::size_t, bool>, std::array<std::string, 3>> rows;
    for (const ReciprocalPair& pair : reciprocalPairs(sample)) {
        rows[{pair.led, pair.other, pair.mirrored}][index(pair.band)] =
            "(" + withExpanded(100 * pair.difference, 100 * pair.u) + ") %";
    }
    HtmlTable table{.caption = "Light and view exchanged: difference over the mean of both",
                    .head = {"incidences", "view on the side"},
                    .rows = {}};
    for (const Band band : bands) table.head.push_back(bandName(band));
    for (const auto& [key, differences] : rows) {
        const auto& [led, other, mirrored] = key;
        std::vector<std::string> row{degreesLabel(sample.leds[led].incidence) + " and " +
                                         degreesLabel(sample.leds[other].incidence),
                                     mirrored ? "away from the light" : "of the light"};
        for (const Band band : bands) {
            const std::string& words = differences[index(band)];
            row.push_back(words.empty() ? "not seen" : words);
        }
        table.add(row);
    }
    return table;
}

}  // namespace gonio::proc
