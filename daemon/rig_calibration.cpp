#include "daemon/rig_calibration.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "proc/formats/gonio_exr.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kLensSchema = "gonio/lens/1";

proc::CellSamples toSamples(const proc::CellSignal& signal) {
    proc::CellSamples samples = proc::CellSamples::missing(signal.size());
    for (std::size_t cell = 0; cell < signal.size(); ++cell) {
        samples.f[cell] = signal.signal[cell];
        samples.uRandom[cell] = std::sqrt(signal.variance[cell]);
        if (signal.present(cell)) samples.uSystematic[cell] = signal.uGlare[cell];
    }
    samples.nEff = signal.nEff;
    samples.flags = signal.flags;
    return samples;
}

proc::CellSignal toSignal(const proc::CellSamples& samples) {
    proc::CellSignal signal = proc::CellSignal::missing(samples.size());
    for (std::size_t cell = 0; cell < samples.size(); ++cell) {
        signal.variance[cell] = samples.uRandom[cell] * samples.uRandom[cell];
        if (samples.present(cell)) signal.uGlare[cell] = samples.uSystematic[cell];
    }
    signal.signal = samples.f;
    signal.nEff = samples.nEff;
    signal.flags = samples.flags;
    return signal;
}

Json toJson(const proc::GlareSpread& glare) {
    return {{"everywhere", glare.everywhere},
            {"halo", glare.halo},
            {"radius_px", glare.radius},
            {"exponent", glare.exponent},
            {"u_share", glare.uShare},
            {"u_relative", glare.uRelative}};
}

/// Absent where the lens map is of before it was fitted.
std::optional<proc::GlareSpread> glareFrom(const Json& lens) {
    const auto found = lens.find("glare");
    if (found == lens.end()) return std::nullopt;
    const auto number = [&](const char* key) { return found->at(key).get<double>(); };
    return proc::GlareSpread{.everywhere = number("everywhere"),
                             .halo = number("halo"),
                             .radius = number("radius_px"),
                             .exponent = number("exponent"),
                             .uShare = number("u_share"),
                             .uRelative = number("u_relative")};
}

}  // namespace

proc::GlareFilter glareFilterOf(const LensRecord& lens, const Window& window) {
    return {lens.glare.value_or(proc::GlareSpread{}), lens.fit.map, window, kField};
}

std::string encodeLens(const LensRecord& lens) {
    const auto values = lens.fit.map.values();
    const Eigen::MatrixXd& covariance = lens.fit.covariance;
    Json json = {
        {"schema", kLensSchema},
        {"date", lens.dateUtc},
        {"spots", lens.spots},
        {"parameters", {"centre_x_px", "centre_y_px", "rotation_rad", "a", "b", "c1", "c3", "c5"}},
        {"values", values},
        {"covariance",
         std::vector<double>(covariance.data(), covariance.data() + covariance.size())},
        {"rms_px", lens.fit.rmsPixels},
        {"worst_px", lens.fit.worstPixels}};
    if (lens.glare) json["glare"] = toJson(*lens.glare);
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<LensRecord> decodeLens(std::string_view text, const std::string& name) {
    try {
        const Json json = Json::parse(text);
        constexpr std::size_t kN = proc::LensMap::kParameters;
        const auto values = json.at("values").get<std::vector<double>>();
        const auto covariance = json.at("covariance").get<std::vector<double>>();
        if (json.at("schema") != kLensSchema || values.size() != kN ||
            covariance.size() != kN * kN) {
            throw std::runtime_error("not a lens map of this version");
        }
        const auto n = static_cast<Eigen::Index>(kN);
        return LensRecord{
            .fit = {.map = proc::LensMap::fromValues(values),
                    .covariance = Eigen::Map<const Eigen::MatrixXd>(covariance.data(), n, n),
                    .rmsPixels = json.at("rms_px").get<double>(),
                    .worstPixels = json.at("worst_px").get<double>()},
            .spots = json.at("spots").get<int>(),
            .dateUtc = json.at("date").get<std::string>(),
            .glare = glareFrom(json)};
    } catch (const std::exception& error) {
        return Error{ErrorKind::File, name + ": " + error.what() + "; run: gonio calibrate mirror"};
    }
}

Result<std::string> encodeReference(const ReferenceRecord& reference,
                                    const std::vector<Radians>& ledAngles) {
    proc::SampleSet set{.info = reference.info, .leds = {}};
    for (std::size_t led = 0; led < reference.signals.size(); ++led) {
        proc::LedTable table{.incidence = ledAngles[led], .bands = {}};
        for (Band band : kBands) {
            table.bands[index(band)] = toSamples(reference.signals[led][index(band)]);
        }
        set.leds.push_back(std::move(table));
    }
    return proc::encodeGonio(set);
}

Result<ReferenceRecord> decodeReference(std::string_view bytes, const std::string& name) {
    const Result<proc::SampleSet> set = proc::decodeGonio(bytes, name);
    if (!set) return set.error();
    ReferenceRecord record{.info = set->info, .signals = {}};
    for (const proc::LedTable& led : set->leds) {
        auto& bands = record.signals.emplace_back();
        for (Band band : kBands) {
            const proc::CellSamples& cells = led.bands[index(band)];
            if (cells.size() == 0) {
                return Error{ErrorKind::File, name + ": a band is missing; calibrate again"};
            }
            bands[index(band)] = toSignal(cells);
        }
    }
    return record;
}

}  // namespace gonio::daemon
