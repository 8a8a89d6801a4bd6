// The `gonio` program: reads the command line, calls one command, maps its error to an exit code.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <iostream>

#include "daemon/cli/commands.h"
#include "proc/core/log.h"

namespace gonio::daemon {
namespace {

constexpr int kUsage = 2;

/// The command that the command line chose.
using Command = std::function<Result<void>()>;

/// Keeps the parsed options alive while the chosen command runs.
struct Program {
    CLI::App app{"gonio: measures how surfaces reflect light", "gonio"};
    CommonOptions common;
    PlaceOptions place;
    ScoreOptions score;
    CalibrateOptions calibrate;
    MeasureOptions measure;
    std::string effort = "standard";
    std::string infoFile;
    EvalOptions eval;
    ConvertOptions convert;
    PlotOptions plot;
    Command chosen;
    bool verbose = false;

    Program();
    CLI::App* command(CLI::App& parent,
                      const std::string& name,
                      const std::string& help,
                      Command run);
    void addSim();
    void addRig();
    void addFiles();
};

CLI::App* Program::command(CLI::App& parent,
                           const std::string& name,
                           const std::string& help,
                           Command run) {
    CLI::App* sub = parent.add_subcommand(name, help);
    sub->fallthrough();
    sub->callback([this, run = std::move(run)] { chosen = run; });
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
    sub->add_option(
           "what", place.what, "black, white, mirror, nothing, a file, model:SPEC or sample:NAME")
        ->required();
    sub->add_option("--tilt-x", place.tiltXDegrees, "wedge of the mirror about x, degrees");
    sub->add_option("--tilt-y,--tilt", place.tiltYDegrees, "wedge of the mirror about y, degrees");
    sub->add_option("--seed", place.seed, "seed of the rig's noise, 0 or above (kept)")
        ->check(CLI::NonNegativeNumber);
    sub->add_option(
        "--serial", place.serial, "serial number: lens and pixels are drawn from it (kept)");
    sub->add_option("--systematic",
                    place.systematic,
                    "errors of the references: none, random, or stratum:K with K in 0..19 (kept)");

    sub = command(*sim, "score", "hold measured samples against the simulated rig's truth", [this] {
        return simScore(common, score);
    });
    sub->add_option("files", score.files, ".gonio files of the simulated rig")->required();
    sub->add_option("-o,--output", score.output, "write the table as JSON here");
}

void Program::addRig() {
    CLI::App* parent = app.add_subcommand("calibrate", "take a reference: mirror, black or white");
    parent->require_subcommand(1);
    parent->fallthrough();
    parent->add_option("--profile", calibrate.profile, "rig profile (TOML)");
    const auto add = [&](const std::string& name, const std::string& help, Reference reference) {
        command(*parent, name, help, [this, reference] {
            calibrate.reference = reference;
            return daemon::calibrate(common, calibrate);
        });
    };
    add("mirror", "the lens map, from a mirror on five wedges", Reference::Mirror);
    add("black", "dark frames and the black reference", Reference::Black);
    add("white", "the white reference", Reference::White);

    CLI::App* sub =
        command(app, "measure", "measure what lies under the rig", [this]() -> Result<void> {
            const Result<Effort> effortValue = parseEffort(effort);
            if (!effortValue) return effortValue.error();
            measure.effort = *effortValue;
            return daemon::measure(common, measure);
        });
    sub->add_option("name", measure.name, "the sample's name")->required();
    sub->add_option("--effort", effort, "draft, standard or reference");
    sub->add_option("--notes", measure.notes, "operator's notes, kept with the sample");
    sub->add_option("-o,--output", measure.output, "also write the .gonio here");
    sub->add_option("--profile", measure.profile, "rig profile (TOML)");
}

void Program::addFiles() {
    CLI::App* sub =
        command(app, "info", "print what a file holds", [this] { return info(common, infoFile); });
    sub->add_option("file", infoFile, "a file, sample:NAME or model:SPEC")->required();

    sub = command(app, "eval", "evaluate at the directions of a CSV file", [this] {
        return daemon::eval(common, eval);
    });
    sub->add_option("file", eval.file, "a file, sample:NAME or model:SPEC")->required();
    sub->add_option("--points",
                    eval.points,
                    "CSV with theta_i,phi_i,theta_o,phi_o (degrees) or wi_x,...,wo_z")
        ->required();
    sub->add_option("-o,--output", eval.output, "write here instead of stdout");

    sub = command(app, "convert", "write a file in another format", [this] {
        return daemon::convert(common, convert);
    });
    sub->add_option("input", convert.input, "a file, sample:NAME or model:SPEC")->required();
    sub->add_option("output", convert.output, "the file to write (.bsdf, .csv, .gonio)")
        ->required();
    sub->add_option("--to", convert.to, "zemax, csv or gonio, where the extension does not tell");

    sub = command(app, "plot", "hemisphere maps and in-plane slices as SVG", [this] {
        return daemon::plot(common, plot);
    });
    sub->add_option("file", plot.file, "a file, sample:NAME or model:SPEC")->required();
    sub->add_option("-o,--output", plot.output, "folder for the pictures");
}

Program::Program() {
    app.require_subcommand(1);
    app.set_version_flag("--version", GONIO_VERSION);
    app.add_flag("--json", common.json, "print JSON for machines");
    app.add_flag("-q,--quiet", common.quiet, "no progress bar");
    app.add_flag("-v,--verbose", verbose, "say on stderr what is done");
    app.add_option("--store", common.store, "folder of calibrations and samples");
    addSim();
    addRig();
    addFiles();
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
    if (done && std::cout) return 0;
    if (done) {
        std::cerr << "gonio: write to stdout: failed; is the disk full?\n";
        return exitCode(ErrorKind::File);
    }
    std::cerr << "gonio: " << done.error().message << "\n";
    return exitCode(done.error().kind);
}

}  // namespace
}  // namespace gonio::daemon

int main(int argc, char** argv) {
    try {
        return gonio::daemon::run(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << "gonio: internal error: " << error.what() << "\n";
        return 1;
    }
}
