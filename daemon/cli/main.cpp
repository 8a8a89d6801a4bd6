// The `gonio` program: reads the command line, calls one command, maps its error to an exit code.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <iostream>

#include "daemon/api/socket_path.h"
#include "daemon/cli/commands.h"
#include "daemon/cli/goal_options.h"
#include "daemon/cli/interrupt.h"
#include "daemon/engine/job.h"
#include "daemon/store.h"
#include "proc/core/log.h"
#include "proc/core/number_text.h"
#include "proc/fit/prior_library.h"

namespace gonio::daemon {
namespace {

constexpr int kUsage = 2;
constexpr int kInterrupted = 130;

/// The command that the command line chose.
using Command = std::function<Result<void>()>;

/// Keeps the parsed options alive while the chosen command runs.
struct Program {
    CLI::App app{"gonio: measures how surfaces reflect light", "gonio"};
    CommonOptions common;
    PlaceRequest place;
    ScoreOptions score;
    VerifyOptions verify;
    std::string limit = "1%";
    MeasureOptions measure;
    RecalibrateOptions recalibrate;
    SessionOptions session;
    WatchOptions watch;
    GoalOptions goal;
    InfoOptions info;
    EvalOptions eval;
    AlbedoOptions albedo;
    CompareOptions compare;
    PriorOptions prior;
    ConvertOptions convert;
    MergeCommandOptions merge;
    ExportOptions exported;
    PlotOptions plot;
    ReportOptions report;
    FitOptions fit;
    TradeOptions trade;
    TradeInterpolationOptions interpolation;
    TradeLookupOptions lookup;
    TradeNumericsOptions numerics;
    TradePowersOptions powers;
    Command chosen;
    bool verbose = false;

    Program();
    CLI::App* command(CLI::App& parent,
                      const std::string& name,
                      const std::string& help,
                      Command run);
    void addSim();
    void addCalibration();
    void addGoal(CLI::App* sub);
    void addMeasuring();
    void addDaemon();
    void addSession();
    void addFiles();
    void addFit();
    void addEvidence();
};

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
    CLI::App* sim = app.add_subcommand("sim", "the simulated rig's own door");
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
}

void Program::addCalibration() {
    CLI::App* parent = app.add_subcommand(
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
        app, "verify-white", "how far the white reference has changed", [this]() -> Result<void> {
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
        command(app, "measure", "measure what lies under the rig", [this]() -> Result<void> {
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

    sub = command(app,
                  "plan",
                  "what measuring the sample under the rig would take and achieve",
                  [this]() -> Result<void> {
                      const Result<CaptureGoal> wanted = goal.parse();
                      if (!wanted) return wanted.error();
                      return daemon::plan(common, *wanted);
                  });
    addGoal(sub);

    sub = command(app, "recalibrate", "work a stored sample out again", [this] {
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
    command(app, "status", "the rig, the job that runs, the session, the calibrations", [this] {
        return status(common);
    });
    command(app, "rigs", "the rigs that the daemon could use", [this] { return rigs(common); });
    command(app, "samples", "the samples of the store", [this] { return samples(common); });
    command(app, "calibrations", "those of the store, and why one is not good now", [this] {
        return calibrations(common);
    });
    command(app, "doctor", "what stands between this computer and a measurement", [this] {
        return doctor(common);
    });
    CLI::App* parent =
        command(app, "jobs", "the newest jobs and how they ended", [this] { return jobs(common); });
    command(*parent, "cancel", "end the job that runs", [this] { return cancelJob(common); });
    command(*parent, "proceed", "what the job has asked for is done", [this] {
        return proceedJob(common);
    });
    CLI::App* sub = command(app, "watch", "print what happens, until Ctrl-C", [this] {
        return daemon::watch(common, watch);
    });
    sub->add_option("--after", watch.after, "number of the event to begin after; default: now");
}

void Program::addSession() {
    CLI::App* parent = app.add_subcommand("session", "a laboratory session, kept with its samples");
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

void Program::addFiles() {
    CLI::App* sub = command(
        app, "info", "print what a file holds", [this] { return daemon::info(common, info); });
    sub->add_option("file", info.file, "a file, sample:NAME or model:SPEC")->required();
    sub->add_option("--estimator",
                    info.estimator,
                    "what answers between and beyond its angles, too: auto, or a method by name");

    sub = command(app, "eval", "evaluate at the directions of a CSV file", [this] {
        return daemon::eval(common, eval);
    });
    sub->add_option("file", eval.file, "a file, sample:NAME or model:SPEC")->required();
    sub->add_option("--points",
                    eval.points,
                    "CSV with theta_i,phi_i,theta_o,phi_o (degrees) or wi_x,...,wo_z")
        ->required();
    sub->add_option("-o,--output", eval.output, "write here instead of stdout");
    sub->add_option("--precision", eval.precision, "float or double, of a model's evaluation");
    sub->add_option("--effort",
                    eval.effort,
                    "draft, standard or reference, of a model's evaluation and of an estimator");
    sub->add_option(
        "--estimator",
        eval.estimator,
        "between and beyond the measured angles: auto, none, or a method by name, such as "
        "specular-log or grid-linear:bezier");
    sub->add_option("--prior", eval.prior, "a library of `prior build`; default: the standard one");

    sub = command(app, "albedo", "how much of the light a surface sends back", [this] {
        return daemon::albedo(common, albedo);
    });
    sub->add_option("file", albedo.file, "a file, sample:NAME or model:SPEC")->required();
    sub->add_option(
        "--incidences", albedo.incidences, "degrees with commas; default: those of the file");
    sub->add_option("--estimator",
                    albedo.estimator,
                    "over the whole hemisphere, by auto or a method; none: what was measured");
    sub->add_option(
        "--effort",
        albedo.effort,
        "draft, standard or reference: to 0.001, 0.0001 or 0.00001, and of an estimator");

    sub = command(app, "compare", "whether two surfaces agree within their uncertainties", [this] {
        return daemon::compare(common, compare);
    });
    sub->add_option("a", compare.a, "a file, sample:NAME or model:SPEC")->required();
    sub->add_option("b", compare.b, "likewise")->required();
    sub->add_option("--incidences", compare.incidences, "degrees with commas; default: those of a");
    sub->add_option("--estimator",
                    compare.estimator,
                    "auto, none, or a method by name, of both; default: none, of a .csv auto");

    CLI::App* parent = app.add_subcommand("prior", "the statistical prior of the estimators");
    parent->require_subcommand(1);
    parent->fallthrough();
    sub = command(*parent, "build", "write its materials, a model's spec per line", [this] {
        return buildPrior(common, prior);
    });
    sub->add_option("--count", prior.count, "materials drawn from documented families")
        ->check(CLI::Range(proc::PriorLibrary::kFewest, std::size_t{20000}));
    sub->add_option("--seed", prior.seed, "of the draws");
    sub->add_option("--fits", prior.fits, "files of published fits to add");
    sub->add_option("-o,--output", prior.output, "the file to write")->required();

    sub = command(app, "convert", "write a file in another format", [this] {
        return daemon::convert(common, convert);
    });
    sub->add_option("input", convert.input, "a file, sample:NAME or model:SPEC")->required();
    sub->add_option("output", convert.output, "the file to write (.bsdf, .csv, .gonio)")
        ->required();
    sub->add_option("--to", convert.to, "zemax, csv or gonio, where the extension does not tell");
    sub->add_option("--estimator",
                    convert.estimator,
                    "what answers a table's nodes: none (what was measured), auto, or by name");

    sub = command(app, "merge", "make one file of rotations, repeats or bands of a sample", [this] {
        return daemon::merge(common, merge);
    });
    sub->add_option("files", merge.files, "two or more .gonio, or three files of one band each")
        ->required();
    sub->add_option("-o,--output", merge.output, "the file to write (.gonio, .csv)")->required();
    sub->add_flag("--plane", merge.plane, "average the two sides of the plane of incidence");
    sub->add_flag("--isotropic", merge.isotropic, "average over the rotations");
    sub->add_flag("--reciprocal", merge.reciprocal, "average pairs that were seen both ways");
    sub->add_flag("--any-calibration",
                  merge.anyCalibration,
                  "what was measured on other rigs or by other references, too");

    sub = command(app, "export", "write a file in all formats, or some", [this] {
        return exportTo(common, exported);
    });
    sub->add_option("file", exported.file, "a file, sample:NAME or model:SPEC")->required();
    sub->add_option("-o,--output", exported.output, "folder")->required();
    sub->add_option("--formats", exported.formats, "of gonio, zemax, csv, with commas");
    sub->add_option("--estimator",
                    exported.estimator,
                    "what answers a table's nodes: none (what was measured), auto, or by name");

    sub = command(app, "plot", "hemisphere maps and in-plane slices as SVG", [this] {
        return daemon::plot(common, plot);
    });
    sub->add_option("file", plot.file, "a file, sample:NAME or model:SPEC")->required();
    sub->add_option("-o,--output", plot.output, "folder for the pictures");

    sub = command(app, "report", "all that is known of a sample as one HTML file", [this] {
        return daemon::report(common, report);
    });
    sub->add_option("file", report.file, "a .gonio file or sample:NAME")->required();
    sub->add_option("-o,--output", report.output, "the file to write; default: NAME.html here");
    sub->add_option("--models",
                    report.models,
                    "families to fit, with commas; usual (six of them), all or none");
    sub->add_option("--estimator",
                    report.estimator,
                    "between and beyond the measured angles: auto, none, or a method by name");
}

void Program::addFit() {
    CLI::App* sub = command(
        app, "fit", "fit analytic models, rank them, and choose the simplest that holds", [this] {
            return daemon::fit(common, fit);
        });
    sub->add_option("file", fit.file, "a .gonio, Zemax or CSV file, or sample:NAME")->required();
    sub->add_option("--models", fit.models, "names of families with commas, or all");
    sub->add_option("--weights",
                    fit.weights,
                    "uncertainty (each value by its u), cosine (for the energy), both or none");
    sub->add_option("--robust", fit.robust, "none, huber or cauchy, with :SCALE in uncertainties");
    sub->add_option("--assume", fit.assumed, "relative uncertainty where the file gives none");
    sub->add_option("--floor", fit.floor, "relative uncertainty added to each value's own");
    sub->add_option("-o,--output", fit.output, "folder for report and residual maps");
}

void Program::addEvidence() {
    CLI::App* parent = app.add_subcommand("trade", "the trade of speed for accuracy, measured");
    parent->require_subcommand(1);
    parent->fallthrough();
    CLI::App* sub =
        command(*parent,
                "acquisition",
                "seconds against uncertainty of the best plans, as CSV, Markdown and SVG",
                [this] { return tradeAcquisition(common, trade); });
    sub->add_flag("--quick", trade.quick, "two materials and three wanted uncertainties");
    sub->add_option("--levels", trade.levels, "numbers of LED levels, of 1, 2 and 3; default: all")
        ->check(CLI::Range(1, 3));
    sub->add_option("-o,--output", trade.output, "folder for the files");

    sub = command(*parent,
                  "numerics",
                  "errors of the models in float and double against reference values",
                  [this] { return tradeNumerics(common, numerics); });
    sub->add_option("--reference", numerics.reference, "folder of tables, such as tests/reference")
        ->required();
    sub->add_option("-o,--output", numerics.output, "write the tables here as Markdown");

    sub = command(*parent,
                  "powers",
                  "errors and times of the forms of cos^n, and of the paper that proposed one",
                  [this] { return tradePowers(common, powers); });
    sub->add_flag("--quick", powers.quick, "fewer powers, angles and repeats");
    sub->add_option("-o,--output", powers.output, "folder for the tables, CSV and Markdown");

    sub = command(*parent,
                  "lookup",
                  "errors, bytes and times of baked tables, beside a MERL table's",
                  [this] { return tradeLookup(common, lookup); });
    sub->add_flag("--quick", lookup.quick, "two materials, three resolutions");
    sub->add_option("-o,--output", lookup.output, "folder for the table");

    sub = command(*parent,
                  "neighbours",
                  "what nearest neighbours among scattered samples cost, by their number",
                  [this] { return tradeNeighbours(common, lookup); });
    sub->add_flag("--quick", lookup.quick, "up to 100,000 samples");
    sub->add_option("-o,--output", lookup.output, "folder for the table and a plot");

    sub = command(*parent,
                  "interpolation",
                  "every estimator on surfaces of known truth, between and beyond the angles",
                  [this] { return tradeInterpolation(common, interpolation); });
    sub->add_flag("--quick", interpolation.quick, "four materials, fewer directions");
    sub->add_option("--noise", interpolation.noise, "relative noise of each cell, such as 1%");
    sub->add_option("-o,--output", interpolation.output, "folder for the tables and pictures");
}

Program::Program() {
    app.require_subcommand(1);
    app.set_version_flag("--version", GONIO_VERSION);
    app.add_flag("--json", common.json, "print JSON for machines");
    app.add_flag("-q,--quiet", common.quiet, "no progress bar and no report: errors and JSON only");
    app.add_flag("-v,--verbose", verbose, "say on stderr what is done");
    app.add_flag("-y,--yes", common.yes, "what a person is asked to do is done");
    app.add_option("--store", common.store, "folder of calibrations and samples");
    app.add_option("--socket", common.socket, "where the daemon serves; default: in the store");
    addDaemon();
    addSession();
    addCalibration();
    addMeasuring();
    addSim();
    addFiles();
    addFit();
    addEvidence();
}

/// What is wrong with the command line, in one line: a word that is no command is named, where the
/// library only says that a command is missing.
std::string complaint(const CLI::App& app, const CLI::ParseError& error) {
    const std::vector<std::string> unknown = app.remaining(true);
    std::string what = error.what();
    if (error.get_name() == "RequiredError" && !unknown.empty()) {
        what = "unknown command or option '" + unknown.front() + "'";
    }
    std::replace(what.begin(), what.end(), '\n', ' ');
    return what + "; see gonio --help";
}

int run(int argc, char** argv) {
    Program program;
    try {
        program.app.parse(argc, argv);
    } catch (const CLI::Success& success) {  // --help, --version
        return program.app.exit(success);
    } catch (const CLI::ParseError& error) {
        std::cerr << "gonio: " << complaint(program.app, error) << "\n";
        return kUsage;
    }
    if (program.verbose) log::setLevel(log::Level::Info);
    const Result<void> done = program.chosen();
    std::cout.flush();
    if (done && std::cout) return interrupted() ? kInterrupted : 0;
    if (done) {
        std::cerr << "gonio: write to stdout: failed; is the disk full?\n";
        return exitCode(ErrorKind::File);
    }
    std::cerr << "gonio: " << done.error().message << "\n";
    return interrupted() ? kInterrupted : exitCode(done.error().kind);
}

}  // namespace

std::filesystem::path CommonOptions::socketPath() const {
    return daemon::socketPath(socket, store.empty() ? defaultStore() : store);
}

}  // namespace gonio::daemon

int main(int argc, char** argv) {
    try {
        return gonio::daemon::run(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << "gonio: internal error: " << error.what() << "\n";
        return 1;
    }
}
