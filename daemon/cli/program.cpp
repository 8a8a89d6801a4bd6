// Commands that need a rig, a daemon or a store: the others are in program_files.cpp.

#include "daemon/cli/program.h"

#include <CLI/CLI.hpp>

#include "daemon/engine/job.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {

Program::Program()
    : app(std::make_unique<CLI::App>("gonio: measures how surfaces reflect light", "gonio")) {
    app->require_subcommand(1);
    app->set_version_flag("--version", GONIO_VERSION);
    app->add_flag("--json", common.json, "print JSON for machines");
    app->add_flag(
        "-q,--quiet", common.quiet, "no progress bar and no report: errors and JSON only");
    app->add_flag("-v,--verbose", verbose, "say on stderr what is done");
    app->add_flag("-y,--yes", common.yes, "what a person is asked to do is done");
    app->add_option("--store", common.store, "folder of calibrations and samples");
    app->add_option("--socket", common.socket, "where the daemon serves; default: in the store");
    addDaemon();
    addSession();
    addCalibration();
    addMeasuring();
    addSim();
    addFiles();
    addFit();
    addEvidence();
}

Program::~Program() = default;

CLI::App* Program::command(CLI::App& parent,
                           const std::string& name,
                           const std::string& help,
                           Command run) {
    CLI::App* sub = parent.add_subcommand(name, help);
    sub->fallthrough();
    // A parent's own command is meant only where none of its subcommands is.
    sub->callback([this, sub, run = std::move(run)] {
        if (sub->get_subcommands().empty()) chosen = run;
    });
    return sub;
}

void Program::addSim() {
    CLI::App* sim = app->add_subcommand("sim", "the simulated rig's own door");
    sim->require_subcommand(1);
    sim->fallthrough();
    CLI::App* sub =
        command(*sim, "place", "put a reference or a sample under the simulated rig", [this] {
            return simPlace(common, place);
        });
    sub->add_option("what",
                    place.what,
                    "black, white, zero, mirror, nothing, a file, model:SPEC or sample:NAME")
        ->required();
    sub->add_option(
        "--tilt-x", place.tiltXDegrees, "wedge of the mirror or the sample: about x, degrees");
    sub->add_option("--tilt-y,--tilt",
                    place.tiltYDegrees,
                    "wedge of the mirror or the sample: about y, degrees");
    sub->add_option("--seed", place.seed, "seed of the rig's noise, 0 or above (kept)")
        ->check(CLI::NonNegativeNumber);
    sub->add_option(
        "--serial", place.serial, "serial number: lens and pixels are drawn from it (kept)");
    sub->add_option("--systematic",
                    place.systematic,
                    "errors of the references: none, random, or stratum:K with K in 0..19 (kept)");
    sub->add_option("--rig-errors",
                    place.rigErrors,
                    "what else is wrong with the rig (kept): none, typical, or names with sizes, "
                    "glare=0.002,offset_us,step=0.05@300; all in docs/simulator.md");
    sub->add_option("--waviness",
                    place.wavinessDegrees,
                    "how far the sample's normal differs between the LEDs' spots, rms, degrees");
    sub->add_option("--translucent",
                    place.translucency,
                    "share of red light that the sample lets through to its backing and back");
    sub->add_option("--backing", place.backing, "what lies below it: black or white");
    sub->add_option("--soft", place.softness, "excess of a pressed sample's lobe, which relaxes");
    sub->add_option("--ambient", place.ambient, "light that leaks in, as of this f cos(theta)");
    sub->add_option(
        "--turned", place.turnedDegrees, "the white or the sample, about its normal, degrees");

    sub = command(*sim, "score", "hold measured samples against the simulated rig's truth", [this] {
        return simScore(common, score);
    });
    sub->add_option("files", score.files, ".gonio files of the simulated rig")->required();
    sub->add_option("-o,--output", score.output, "write the table as JSON here");

    addSimServe(*sim);
}

void Program::addSimServe(CLI::App& sim) {
    CLI::App* sub =
        command(sim, "serve", "simulated rigs as USB devices, until Ctrl-C or SIGTERM", [this] {
            return daemon::simServe(common, simServe);
        });
    sub->add_flag("--usbip", simServe.usbip, "over TCP, for `usbip attach` of any Linux");
    sub->add_flag("--attach",
                  simServe.attach,
                  "to this computer's own USB, as root and with the module vhci-hcd");
    sub->add_option("--port", simServe.port, "default: 3240; 0: a free one, which is said");
    sub->add_option("--bind",
                    simServe.bind,
                    "default: 127.0.0.1; whoever reaches another address has the rigs, without a "
                    "password");
    sub->add_option("--serial", simServe.serials, "default: SIM-0001; each one is a rig");
    sub->add_option("--place",
                    simServe.placed,
                    "what lies under each: black, white, zero, mirror, nothing (default), a file, "
                    "model:SPEC or sample:NAME");
    sub->add_option("--camera", simServe.camera, "usb2 (default) or usb3")
        ->check(CLI::IsMember({"usb2", "usb3"}));
    sub->add_option("--seed", simServe.seed, "seed of the rigs' noise, 0 or above; default: 1")
        ->check(CLI::NonNegativeNumber);
    sub->add_option("--systematic",
                    simServe.systematic,
                    "errors of the references: none, random (default), or stratum:K");
    sub->add_option("--rig-errors", simServe.rigErrors, "as of sim place");
    sub->add_option(
        "--faults",
        simServe.faults,
        "a script of what goes wrong with each of them, and when: docs/fault-scripts.md");
}

void Program::addCalibration() {
    CLI::App* parent = app->add_subcommand(
        "calibrate", "take a reference: mirror, black, white, zero; or measure the rig itself");
    parent->require_subcommand(1);
    parent->fallthrough();
    const auto add = [&](const std::string& name, const std::string& help, Reference reference) {
        command(*parent, name, help, [this, reference] { return calibrate(common, reference); });
    };
    add("mirror", "the lens map, from a mirror on nine wedges", Reference::Mirror);
    add("black", "dark frames and the black reference", Reference::Black);
    add("white", "the white reference", Reference::White);
    add("zero", "the zero reference, a light trap (optional)", Reference::Zero);
    add("flat", "the flat field, from the white reference (optional)", Reference::Flat);
    add("sensor",
        "gain, read noise and linearity, from the white reference (optional); before black",
        Reference::Sensor);
    add("leds", "the LEDs' warm-up, from the white reference (optional)", Reference::Leds);
    add("dark", "the dark library at the sensor's temperature (optional)", Reference::Dark);

    CLI::App* sub = command(
        *app, "verify-white", "how far the white reference has changed", [this]() -> Result<void> {
            const std::optional<double> share = parsePercent(limit);
            if (!share) {
                return Error{ErrorKind::Usage, "--limit '" + limit + "': wanted such as 1%"};
            }
            verify.limit = *share;
            return verifyWhite(common, verify);
        });
    sub->add_option("--limit", limit, "largest change that passes, such as 1%");
    sub->add_flag(
        "--turned", verify.turned, "the tile was turned about its normal: is it like itself, too?");
}

void Program::addGoal(CLI::App* sub) {
    sub->add_option("--effort", goal.effort, "draft, standard (unless said) or reference");
    sub->add_option("--target-uncertainty",
                    goal.targetUncertainty,
                    "random, relative, 1 sigma, of each cell, such as 1%");
    sub->add_option("--time-budget", goal.timeBudget, "on the rig, all told, such as 5s");
}

void Program::addMeasuring() {
    CLI::App* sub =
        command(*app, "measure", "measure what lies under the rig", [this]() -> Result<void> {
            const Result<CaptureGoal> wanted = goal.parse();
            if (!wanted) return wanted.error();
            measure.goal = *wanted;
            if (Result<void> good = checkSampleName(measure.name); !good) return good;
            const auto rotation = parseRotation(measure.rotationDegrees);
            if (!rotation) return rotation.error().in("measure");
            return daemon::measure(common, measure);
        });
    sub->add_option("name", measure.name, "the sample's name")->required();
    addGoal(sub);
    sub->add_option("--notes", measure.notes, "operator's notes, kept with the sample");
    sub->add_flag("--force",
                  measure.force,
                  "with calibrations that are no longer good, and whatever its verdicts say, too");
    sub->add_option("--backing", measure.backing, "black or white: what lies under the sample");
    sub->add_option("--against",
                    measure.against,
                    "the same sample, measured on the other backing: tells translucency");
    sub->add_option(
        "--monte-carlo",
        measure.monteCarlo,
        "draws for the uncertainty of each cell; unless said, only where first order is wrong");
    sub->add_option("--rotation",
                    measure.rotationDegrees,
                    "how far the sample is turned about its normal, counter-clockwise seen from "
                    "above, degrees (kept with the sample)");
    sub->add_option("-o,--output", measure.output, "also write the .gonio here");

    sub = command(*app,
                  "plan",
                  "what measuring the sample under the rig would take and achieve",
                  [this]() -> Result<void> {
                      const Result<CaptureGoal> wanted = goal.parse();
                      if (!wanted) return wanted.error();
                      return daemon::plan(common, *wanted);
                  });
    addGoal(sub);

    sub = command(*app, "recalibrate", "work a stored sample out again", [this] {
        return daemon::recalibrate(common, recalibrate);
    });
    sub->add_option("name", recalibrate.name, "the sample's name")->required();
    sub->add_option("--calibration",
                    recalibrate.calibration,
                    "10+11+12, or one number in the place of its kind; default: the newest");
    sub->add_option("--monte-carlo",
                    recalibrate.monteCarlo,
                    "draws for the uncertainty of each cell; unless said, as it was measured");
    sub->add_option("-o,--output", recalibrate.output, "also write the .gonio here");
}

void Program::addDaemon() {
    command(*app, "status", "the rig, the job that runs, the session, the calibrations", [this] {
        return status(common);
    });
    command(*app, "rigs", "the rigs that the daemon could use", [this] { return rigs(common); });
    command(*app, "samples", "the samples of the store", [this] { return samples(common); });
    command(*app, "calibrations", "those of the store, and why one is not good now", [this] {
        return calibrations(common);
    });
    CLI::App* examine =
        command(*app, "doctor", "what stands between this computer and a measurement", [this] {
            return daemon::doctor(common, doctor);
        });
    examine->add_flag("--hands-off",
                      doctor.handsOff,
                      "claim no rig: without clock, temperatures, dark frames and counters");
    examine->add_option(
        "--profile",
        doctor.profile,
        "what a rig's noise is held against; default: minidiff-usb2 or minidiff-usb3, "
        "by its camera");
    CLI::App* parent = command(
        *app, "jobs", "the newest jobs and how they ended", [this] { return jobs(common); });
    command(*parent, "cancel", "end the job that runs", [this] { return cancelJob(common); });
    command(*parent, "proceed", "what the job has asked for is done", [this] {
        return proceedJob(common);
    });
    CLI::App* sub = command(*app, "watch", "print what happens, until Ctrl-C", [this] {
        return daemon::watch(common, watch);
    });
    sub->add_option("--after", watch.after, "number of the event to begin after; default: now");
}

void Program::addSession() {
    CLI::App* parent =
        app->add_subcommand("session", "a laboratory session, kept with its samples");
    parent->require_subcommand(1);
    parent->fallthrough();
    CLI::App* sub =
        command(*parent, "new", "open one", [this] { return newSession(common, session); });
    sub->add_option("name", session.name, "its name; default: its date");
    sub->add_option("--operator", session.operatorName, "who measures");
    sub->add_option("--notes", session.notes, "anything");
    command(*parent, "list", "all of them", [this] { return listSessions(common); });
    command(
        *parent, "close", "close the one that is open", [this] { return closeSession(common); });
}

}  // namespace gonio::daemon
