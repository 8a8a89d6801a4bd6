// sim serve: simulated rigs as USB devices, for another computer or another program of this one.

#include <algorithm>
#include <csignal>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "daemon/cli/commands.h"
#include "daemon/cli/output.h"
#include "daemon/engine/sim_port.h"
#include "daemon/sim_bench.h"
#include "sim/faults/fault_script.h"
#include "sim/usbip_server.h"
#include "sim/vhci_cable.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;
using Rigs = std::vector<std::unique_ptr<sim::LiveRig>>;

/// SIGINT and SIGTERM wait for whoever asks, in all threads that begin after this.
class EndSignals {
public:
    EndSignals() {
        sigemptyset(&set_);
        sigaddset(&set_, SIGINT);
        sigaddset(&set_, SIGTERM);
        pthread_sigmask(SIG_BLOCK, &set_, nullptr);
    }
    void await() const {
        int signal = 0;
        sigwait(&set_, &signal);
    }

private:
    sigset_t set_{};
};

Result<void> check(const SimServeOptions& options) {
    if (options.usbip == options.attach) {
        return Error{ErrorKind::Usage,
                     "sim serve: say --usbip to serve over TCP, or --attach for this computer's "
                     "own USB"};
    }
    std::vector<std::string> serials = options.serials;
    std::sort(serials.begin(), serials.end());
    const auto twice = std::adjacent_find(serials.begin(), serials.end());
    if (twice != serials.end()) {
        return Error{ErrorKind::Usage,
                     "sim serve: --serial " + *twice + " twice: each rig has its own"};
    }
    for (const std::string& serial : serials) {
        if (const auto good = checkSerial(serial); !good)
            return good.error().in("sim serve: --serial '" + serial + "'");
    }
    return {};
}

std::string serialOf(sim::LiveRig& rig) {
    return rig.with([](sim::FaultyUsb& usb) { return usb.device().serial(); });
}

/// Empty: nothing goes wrong.
Result<std::optional<sim::FaultScript>> scriptOf(const SimServeOptions& options) {
    if (options.faults.empty()) return std::optional<sim::FaultScript>();
    auto script = readFaults(options.faults);
    if (!script) return script.error();
    return std::optional(std::move(*script));
}

/// In the order of their serial numbers.
Result<Rigs> makeRigs(const CommonOptions& common, const SimServeOptions& options) {
    auto store = Store::open(common.store);
    if (!store) return store.error();
    Rigs rigs;
    std::vector<std::string> serials = options.serials;
    std::sort(serials.begin(), serials.end());
    for (const std::string& serial : serials) {
        const SimState state{.serial = serial,
                             .seed = options.seed,
                             .systematic = options.systematic,
                             .placed = options.placed,
                             .rigErrors = options.rigErrors};
        const auto config = simDevice(state, options.camera == "usb3" ? 3 : 2);
        if (!config) return config.error();
        auto placement = makePlacement(state, *store);
        if (!placement) return placement.error();
        rigs.push_back(std::make_unique<sim::LiveRig>(*config));
        rigs.back()->with([&](sim::FaultyUsb& usb) { usb.device().place(std::move(*placement)); });
    }
    return rigs;
}

/// On all rigs, from this moment.
void play(const std::optional<sim::FaultScript>& script, const Rigs& rigs) {
    if (!script) return;
    for (const auto& rig : rigs) rig->with([&](sim::FaultyUsb& usb) { usb.play(*script); });
}

std::string attachLine(const SimServeOptions& options, int port, const std::string& busId) {
    const bool everywhere = options.bind == "0.0.0.0" || options.bind == "::";
    return "usbip " + (port == 3240 ? "" : "--tcp-port " + std::to_string(port) + " ") +
           "attach -r " + (everywhere ? "THIS_COMPUTER" : options.bind) + " -b " + busId;
}

/// What is served, on stdout at once: programs wait for it.
void announce(const CommonOptions& common, const Json& document) {
    if (common.json) {
        printJson(document);
    } else if (!common.quiet) {
        for (const Json& rig : document["rigs"])
            std::cout << rig["serial"].get<std::string>() << ": " << rig["how"].get<std::string>()
                      << "\n";
    }
    std::cout.flush();
}

Result<void> serveOverTcp(const CommonOptions& common,
                          const SimServeOptions& options,
                          const Rigs& rigs,
                          const std::optional<sim::FaultScript>& script,
                          const EndSignals& signals) {
    std::vector<sim::LiveRig*> borrowed;
    for (const auto& rig : rigs) borrowed.push_back(rig.get());
    const auto note = [&](const std::string& line) {
        if (!common.quiet) std::cerr << "gonio: " << line << "\n";
    };
    const auto server =
        sim::UsbipServer::open(borrowed, {.host = options.bind, .port = options.port}, note);
    if (!server) return server.error();
    Json list = Json::array();
    for (const auto& rig : (*server)->all()) {
        list.push_back({{"serial", rig.serial},
                        {"bus_id", rig.busId},
                        {"how", attachLine(options, (*server)->port(), rig.busId)}});
    }
    announce(common,
             {{"schema", "gonio/sim-serve/1"},
              {"host", options.bind},
              {"port", (*server)->port()},
              {"rigs", list}});
    play(script, rigs);
    signals.await();
    return {};
}

Result<void> serveToKernel(const CommonOptions& common,
                           const Rigs& rigs,
                           const std::optional<sim::FaultScript>& script,
                           const EndSignals& signals) {
    std::vector<std::unique_ptr<sim::VhciCable>> cables;
    Json list = Json::array();
    for (const auto& rig : rigs) {
        auto cable = sim::VhciCable::attach(*rig, static_cast<unsigned>(cables.size()) + 1);
        if (!cable) return cable.error();
        cables.push_back(std::move(*cable));
        list.push_back({{"serial", serialOf(*rig)}, {"bus_id", nullptr}, {"how", "attached"}});
    }
    announce(
        common,
        {{"schema", "gonio/sim-serve/1"}, {"host", nullptr}, {"port", nullptr}, {"rigs", list}});
    play(script, rigs);
    signals.await();
    return {};
}

}  // namespace

Result<void> simServe(const CommonOptions& common, const SimServeOptions& options) {
    if (auto good = check(options); !good) return good;
    const EndSignals signals;
    const auto script = scriptOf(options);
    if (!script) return script.error();
    const auto rigs = makeRigs(common, options);
    if (!rigs) return rigs.error();
    return options.usbip ? serveOverTcp(common, options, *rigs, *script, signals)
                         : serveToKernel(common, *rigs, *script, signals);
}

}  // namespace gonio::daemon
