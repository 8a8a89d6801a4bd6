// The daemon: owns one rig and one store, and serves them at a UNIX socket until SIGTERM, SIGINT or
// SIGHUP, then ends with the LEDs dark.

#include <malloc.h>
#include <systemd/sd-daemon.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <iostream>
#include <memory>
#include <random>
#include <thread>

#include "daemon/api/http_server.h"
#include "daemon/api/options.h"
#include "daemon/api/socket_path.h"
#include "daemon/engine/recorded_port.h"
#include "daemon/engine/replay_port.h"
#include "daemon/engine/usb_port.h"
#include "daemon/utc_now.h"
#include "driver/steady_clock.h"
#include "proc/core/log.h"

namespace gonio::daemon {
namespace {

/// PROTOCOL.md 2: random, its low half not 0.
std::uint64_t randomClaim() {
    std::random_device device;
    const std::uint64_t high = device();
    return high << 32 | std::max(1U, device());
}

/// The end of the program comes as a signal to one thread that waits for it; the others never see
/// one.
sigset_t blockSignals() {
    std::signal(SIGPIPE, SIG_IGN);  // a client that went away is an error of a write
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGHUP);  // its terminal is closed
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    return signals;
}

Result<std::unique_ptr<RigPort>> openPort(const RigChoice& choice,
                                          const std::filesystem::path& store,
                                          const RigProfile& profile,
                                          const std::filesystem::path& faults) {
    if (!faults.empty() && !choice.simulated) {
        return Error{ErrorKind::Usage, "--faults is for the simulated rig only: --rig sim"};
    }
    if (!choice.replay.empty()) {
        auto replay = driver::Replay::open(choice.replay);
        if (!replay) return replay.error();
        return std::unique_ptr<RigPort>(std::make_unique<ReplayPort>(std::move(*replay)));
    }
    if (!choice.simulated) {
        return std::unique_ptr<RigPort>(
            std::make_unique<UsbPort>(driver::UsbSelection{.serial = choice.serial}));
    }
    Result<std::unique_ptr<SimPort>> sim = SimPort::open(store, profile.cameraUsb);
    if (!sim) return sim.error();
    if (!faults.empty()) {
        Result<sim::FaultScript> script = readFaults(faults);
        if (!script) return script.error();
        (*sim)->play(std::move(*script));
    }
    return std::unique_ptr<RigPort>(std::move(*sim));
}

Result<std::unique_ptr<RigPort>> recorded(std::unique_ptr<RigPort> port,
                                          const std::filesystem::path& file) {
    auto recorder = driver::Recorder::open(file);
    if (!recorder) {
        return Error{recorder.error().kind,
                     recorder.error().message + "; choose another file with --record"};
    }
    return std::unique_ptr<RigPort>(
        std::make_unique<RecordedPort>(std::move(port), std::move(*recorder)));
}

/// Pictures come and go by the megabyte: each goes back to the system when it is freed, however
/// large those before it were, and threads that wait for requests keep no heap of their own.
void keepMemorySmall() {
    constexpr int kPictureBytes = 1 << 20;
    constexpr int kHeaps = 2;
    mallopt(M_MMAP_THRESHOLD, kPictureBytes);
    mallopt(M_ARENA_MAX, kHeaps);
}

Result<void> serve(const DaemonOptions& options) {
    const sigset_t signals = blockSignals();
    const auto store = options.store.empty() ? defaultStore() : options.store;
    const auto socket = socketPath(options.socket, store);
    if (Result<void> good = checkSocketPath(socket); !good) return good;
    const Result<SocketAccess> access = parseSocketMode(options.socketMode);
    if (!access) return access.error();
    Result<RigProfile> profile =
        readProfile(options.profile.empty() ? defaultProfile() : options.profile);
    if (!profile) return profile.error();
    const Result<RigChoice> choice = parseRigChoice(options.rig);
    if (!choice) return choice.error();
    if (Result<void> good = checkRecord(*choice, options.record); !good) return good;
    Result<std::unique_ptr<RigPort>> port = openPort(*choice, store, *profile, options.faults);
    if (port && !options.record.empty()) port = recorded(std::move(*port), options.record);
    if (!port) return port.error();
    const driver::SteadyClock clock;
    EngineWorld world{.clock = clock, .utcNow = utcNow, .randomId = randomClaim, .alive = [] {
                          sd_notify(0, "WATCHDOG=1");
                      }};
    if (options.comebackSeconds) world.patience = Seconds(*options.comebackSeconds);
    Result<std::unique_ptr<Engine>> engine =
        Engine::open(store, **port, std::move(*profile), std::move(world));
    if (!engine) return engine.error();
    auto server = HttpServer::open(socket, **engine, *access);
    if (!server) return server.error();
    std::jthread owner([&](const std::stop_token& stop) { (*engine)->run(stop); });
    log::info("serving at " + socket.string());
    sd_notify(0, "READY=1");
    int signal = 0;
    sigwait(&signals, &signal);
    sd_notify(0, "STOPPING=1");
    log::info("ending");
    owner.request_stop();
    owner.join();
    return {};
}

struct Arguments {
    CLI::App app{"goniod: owns a rig and its store, and serves them at a UNIX socket", "goniod"};
    DaemonOptions options;
    std::filesystem::path config;
    bool verbose = false;

    Arguments() {
        app.set_version_flag("--version", GONIO_VERSION);
        app.add_option("--rig", options.rig, "sim, usb, usb:SERIAL or replay:FILE");
        app.add_option("--store", options.store, "folder of calibrations and samples");
        app.add_option("--socket", options.socket, "where to serve; goniod.sock in the store");
        app.add_option("--socket-mode", options.socketMode, "0600, or 0660 for the group too");
        app.add_option("--profile", options.profile, "rig profile (TOML)");
        app.add_option("--comeback-seconds",
                       options.comebackSeconds,
                       "how long a job waits for a rig that was unplugged, or must not light; 600; "
                       "0: it ends at once")
            ->check(CLI::NonNegativeNumber);
        app.add_option("--record", options.record, "record all traffic with the rig in this file");
        app.add_option(
            "--faults", options.faults, "what goes wrong with the simulated rig, and when");
        app.add_option("--config", config, "goniod.toml, for what the options above do not say");
        app.add_flag("-v,--verbose", verbose, "say on stderr what is done");
    }
};

int run(int argc, char** argv) {
    keepMemorySmall();
    Arguments arguments;
    try {
        arguments.app.parse(argc, argv);
    } catch (const CLI::Success& success) {
        return arguments.app.exit(success);
    } catch (const CLI::ParseError& error) {
        std::cerr << "goniod: " << error.what() << "; see goniod --help\n";
        return exitCode(ErrorKind::Usage);
    }
    if (arguments.verbose) log::setLevel(log::Level::Info);
    Result<void> done;
    if (arguments.config.empty()) {
        done = serve(arguments.options);
    } else {
        const Result<DaemonOptions> file = readDaemonOptions(arguments.config);
        done = file ? serve(overlaid(arguments.options, *file)) : file.error();
    }
    if (done) return 0;
    std::cerr << "goniod: " << done.error().message << "\n";
    return exitCode(done.error().kind);
}

}  // namespace
}  // namespace gonio::daemon

int main(int argc, char** argv) {
    try {
        return gonio::daemon::run(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << "goniod: internal error: " << error.what() << "\n";
        return 1;
    }
}
