#include "daemon/sim_bench.h"

#include <nlohmann/json.hpp>

#include "daemon/material.h"
#include "daemon/references.h"
#include "proc/formats/file_bytes.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "gonio/sim/1";
constexpr double kLedDrift = 0.002;

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
                       {"tilt_y_deg", state.wedge.aboutY.degrees()}};
    return proc::writeFile(store.simState(),
                           json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

Result<sim::Placement> makePlacement(const SimState& state, const Store& store) {
    sim::Placement placement{.role = sim::Role::Sample, .surface = nullptr, .wedge = state.wedge};
    if (state.placed == "nothing") {
        placement.role = sim::Role::Nothing;
    } else if (state.placed == "mirror") {
        placement.role = sim::Role::Mirror;
    } else if (state.placed == "white" || state.placed == "black") {
        const Result<References> references = loadReferences();
        if (!references) return references.error();
        const bool white = state.placed == "white";
        placement.role = white ? sim::Role::White : sim::Role::Black;
        placement.surface = white ? references->white : references->black;
    } else {
        Result<Material> material = openMaterial(state.placed, store.root());
        if (!material) return material.error();
        placement.surface = std::move(material->scatterer);
    }
    return placement;
}

Result<std::unique_ptr<sim::InProcessDoor>> openSim(const SimState& state,
                                                    const Store& store,
                                                    int cameraUsb) {
    const auto errors = sim::ReferenceErrors::parse(state.systematic, state.seed);
    if (!errors) return errors.error();
    Result<sim::Placement> placement = makePlacement(state, store);
    if (!placement) return placement.error();
    auto door = std::make_unique<sim::InProcessDoor>(
        sim::DeviceConfig{.serial = state.serial,
                          .seed = state.seed,
                          .bootCount = 1,
                          .errors = *errors,
                          .camera = cameraUsb == 3 ? sim::CameraKind::Usb3 : sim::CameraKind::Usb2,
                          .rig = {.ledDrift = state.systematic == "none" ? 0 : kLedDrift}});
    door->device().place(std::move(*placement));
    return door;
}

}  // namespace gonio::daemon
