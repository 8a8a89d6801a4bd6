#include "daemon/sim_bench.h"

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "daemon/material.h"
#include "daemon/references.h"
#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"
#include "sim/band_mixture.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "gonio/sim/1";
constexpr double kLedDrift = 0.002;
constexpr const char* kRigErrors = "rig_errors";

Result<sim::RigErrors> rigErrorsOf(const SimState& state) {
    return sim::parseRigErrors(state.rigErrors,
                               {.ledDrift = state.systematic == "none" ? 0 : kLedDrift});
}

const char* nameOf(sim::Backing backing) {
    return backing == sim::Backing::White ? "white" : "black";
}

/// Absent where the file is of before there were any.
sim::SampleErrors sampleErrorsFrom(const Json& json) {
    return {.waviness = Radians::fromDegrees(json.value("waviness_deg", 0.0)),
            .translucency = json.value("translucency", 0.0),
            .backing = json.value("backing", "black") == "white" ? sim::Backing::White
                                                                 : sim::Backing::Black,
            .softness = json.value("softness", 0.0),
            .ambient = json.value("ambient", 0.0)};
}

/// Each with its name, in the order of the command line.
std::vector<std::pair<std::string, std::string>> wrongWithSample(const SimState& state) {
    const sim::SampleErrors& errors = state.sampleErrors;
    std::vector<std::pair<std::string, std::string>> list;
    const auto add = [&](const std::string& name, double size) {
        if (size != 0) list.emplace_back(name, shortest(size));
    };
    // From radians and back: seven digits are those that were said.
    const auto addAngle = [&](const std::string& name, Radians size) {
        if (size != Radians())
            list.emplace_back(name, shortest(static_cast<float>(size.degrees())));
    };
    addAngle("tilt_x_deg", state.wedge.aboutX);
    addAngle("tilt_y_deg", state.wedge.aboutY);
    addAngle("waviness_deg", errors.waviness);
    add("translucency", errors.translucency);
    if (errors.translucency != 0) list.emplace_back("backing", nameOf(errors.backing));
    add("softness", errors.softness);
    add("ambient", errors.ambient);
    return list;
}

}  // namespace

Result<SimState> readSimState(const Store& store) {
    if (!std::filesystem::exists(store.simState())) return SimState{};
    const Result<std::string> text = proc::readFile(store.simState());
    if (!text) return text.error();
    try {
        const Json json = Json::parse(*text);
        SimState state;
        if (json.at("schema") != kSchema) throw std::runtime_error("schema is not gonio/sim/1");
        state.serial = json.at("serial").get<std::string>();
        state.seed = json.at("seed").get<std::uint64_t>();
        state.systematic = json.at("systematic").get<std::string>();
        state.placed = json.at("placed").get<std::string>();
        state.wedge.aboutX = Radians::fromDegrees(json.at("tilt_x_deg").get<double>());
        state.wedge.aboutY = Radians::fromDegrees(json.at("tilt_y_deg").get<double>());
        state.rigErrors = json.value(kRigErrors, "none");
        state.turned = Radians::fromDegrees(json.value("turned_deg", 0.0));
        state.sampleErrors = sampleErrorsFrom(json);
        if (const auto good = sim::check(state.sampleErrors); !good) {
            throw std::runtime_error(good.error().message);
        }
        return state;
    } catch (const std::exception& error) {
        return Error{ErrorKind::File,
                     store.simState().string() + ": " + error.what() +
                         "; delete the file to start with a new simulated rig"};
    }
}

Result<void> writeSimState(const Store& store, const SimState& state) {
    const Json json = {{"schema", kSchema},
                       {"serial", state.serial},
                       {"seed", state.seed},
                       {"systematic", state.systematic},
                       {"placed", state.placed},
                       {"tilt_x_deg", state.wedge.aboutX.degrees()},
                       {"tilt_y_deg", state.wedge.aboutY.degrees()},
                       {kRigErrors, state.rigErrors},
                       {"waviness_deg", state.sampleErrors.waviness.degrees()},
                       {"translucency", state.sampleErrors.translucency},
                       {"backing", nameOf(state.sampleErrors.backing)},
                       {"softness", state.sampleErrors.softness},
                       {"ambient", state.sampleErrors.ambient},
                       {"turned_deg", state.turned.degrees()}};
    return proc::writeFile(store.simState(),
                           json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

Result<sim::Placement> makePlacement(const SimState& state, const Store& store) {
    sim::Placement placement{.role = sim::Role::Sample,
                             .surface = nullptr,
                             .wedge = state.wedge,
                             .errors = state.sampleErrors};
    if (state.placed == "nothing") {
        placement.role = sim::Role::Nothing;
    } else if (state.placed == "mirror") {
        placement.role = sim::Role::Mirror;
    } else if (state.placed == "zero") {
        placement.role = sim::Role::Zero;
    } else if (state.placed == "white" || state.placed == "black") {
        const Result<References> references = loadReferences();
        if (!references) return references.error();
        const bool white = state.placed == "white";
        placement.role = white ? sim::Role::White : sim::Role::Black;
        placement.surface = white ? references->white : references->black;
        if (white) placement.turned = state.turned;
    } else {
        placement.turned = state.turned;
        Result<Material> material = openMaterial(state.placed, store.root());
        if (!material) return material.error();
        placement.surface = std::move(material->scatterer);
    }
    return placement;
}

bool isReference(const std::string& placed) {
    return placed == "nothing" || placed == "mirror" || placed == "white" || placed == "black" ||
           placed == "zero";
}

void describe(const SimState& state, proc::SampleInfo& info) {
    info.truthSpec = state.placed;
    info.extra["seed"] = std::to_string(state.seed);
    info.extra["rig"] = "simulated, systematic errors of the references: " + state.systematic;
    if (state.rigErrors != "none") info.extra[kRigErrors] = state.rigErrors;
    std::string sample;
    for (const auto& [name, size] : wrongWithSample(state)) {
        sample += (sample.empty() ? "" : ",") + name + "=" + size;
    }
    if (!sample.empty()) info.extra["sample_errors"] = sample;
    if (state.turned != Radians())
        info.extra["sample_turned_deg"] = shortest(static_cast<float>(state.turned.degrees()));
}

Result<std::shared_ptr<const Scatterer>> truthOf(const proc::SampleInfo& info,
                                                 const std::filesystem::path& store) {
    if (info.truthSpec.empty() || isReference(info.truthSpec)) {
        return Error{ErrorKind::Usage,
                     "its truth is not known: it is no sample of a simulated rig"};
    }
    Result<Material> material = openMaterial(info.truthSpec, store);
    if (!material) return material.error();
    const auto said = info.extra.find(kRigErrors);
    if (said == info.extra.end()) return std::move(material->scatterer);
    const Result<sim::RigErrors> rig = sim::parseRigErrors(said->second, {});
    if (!rig) return rig.error();
    return std::shared_ptr<const Scatterer>(
        std::make_shared<const sim::MixedBands>(std::move(material->scatterer), rig->crosstalk));
}

Result<sim::DeviceConfig> simDevice(const SimState& state, int cameraUsb) {
    const auto errors = sim::ReferenceErrors::parse(state.systematic, state.seed);
    if (!errors) return errors.error();
    const Result<sim::RigErrors> rig = rigErrorsOf(state);
    if (!rig) return rig.error();
    const bool small = state.serial.starts_with("SMALL");  // docs/simulator.md
    return sim::DeviceConfig{
        .serial = state.serial,
        .seed = state.seed,
        .bootCount = 1,
        .errors = *errors,
        .camera = cameraUsb == 3 ? sim::CameraKind::Usb3 : sim::CameraKind::Usb2,
        .rig = *rig,
        .binnings = small ? sim::kCoarsestBinning : sim::kAllBinnings,
        .leds = small ? 1 : sim::kLeds};
}

Result<sim::FaultScript> readFaults(const std::filesystem::path& file) {
    const Result<std::string> text = proc::readFile(file);
    if (!text) return text.error();
    Result<sim::FaultScript> script = sim::FaultScript::parse(*text);
    if (!script) return script.error().in(file.string());
    return script;
}

Result<std::unique_ptr<sim::InProcessDoor>> openSim(const SimState& state,
                                                    const Store& store,
                                                    int cameraUsb) {
    const auto config = simDevice(state, cameraUsb);
    if (!config) return config.error();
    Result<sim::Placement> placement = makePlacement(state, store);
    if (!placement) return placement.error();
    auto door = std::make_unique<sim::InProcessDoor>(*config);
    door->device().place(std::move(*placement));
    return door;
}

}  // namespace gonio::daemon
