// Commands on files, and those that measure this software itself.

#include "daemon/cli/program.h"

#include <CLI/CLI.hpp>
#include "proc/fit/prior_library.h"

namespace gonio::daemon {

void Program::addFiles() {
    CLI::App* sub = command(
        *app, "info", "print what a file holds", [this] { return daemon::info(common, info); });
    sub->add_option("file", info.file, "a file, sample:NAME or model:SPEC")->required();
    sub->add_option("--from", info.from, "the format, where the content does not tell");
    sub->add_option("--estimator",
                    info.estimator,
                    "what answers between and beyond its angles, too: auto, or a method by name");

    sub = command(*app, "eval", "evaluate at the directions of a CSV file", [this] {
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

    sub = command(*app, "albedo", "how much of the light a surface sends back", [this] {
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

    sub = command(*app, "compare", "whether two surfaces agree within their uncertainties", [this] {
        return daemon::compare(common, compare);
    });
    sub->add_option("a", compare.a, "a file, sample:NAME or model:SPEC")->required();
    sub->add_option("b", compare.b, "likewise")->required();
    sub->add_option("--incidences", compare.incidences, "degrees with commas; default: those of a");
    sub->add_option("--estimator",
                    compare.estimator,
                    "auto, none, or a method by name, of both; default: none, of a .csv auto");

    CLI::App* parent = app->add_subcommand("prior", "the statistical prior of the estimators");
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

    sub = command(*app, "convert", "write a file in another format", [this] {
        return daemon::convert(common, convert);
    });
    sub->add_option("input", convert.input, "a file, sample:NAME or model:SPEC")->required();
    sub->add_option("output", convert.output, "the file to write")->required();
    sub->add_option("--from", convert.from, "the input's format, where its content does not tell");
    sub->add_option("--to", convert.to, "the output's format, where its extension does not tell");
    sub->add_option("--bands",
                    convert.bands,
                    "of r,g,b those to keep, or the one that a file of one value is; 2 takes the "
                    "second channel alone (g=2: it is green); srgb makes linear sRGB of X, Y, Z");
    sub->add_option("--grid",
                    convert.grid,
                    "incidences and step of a table in degrees: 0,20,40 or 0:10:80/2 or /0.5");
    sub->add_option("--cosine",
                    convert.cosine,
                    "yes or no: whether the input's values hold the cosine of the view");
    sub->add_option(
        "--estimator",
        convert.estimator,
        "what answers a table's directions: none (what was measured), auto, or by name");
    sub->add_flag("--half", convert.half, "16-bit floats, where the format has them");
    sub->add_option("--black", convert.black, "RT-300S readings of the empty stage, taken off");
    sub->add_option("--repeat", convert.repeats, "more RT-300S readings of the same sample");
    sub->add_flag(
        "--plane", convert.plane, "of readings: average the sides of the plane of incidence");
    sub->add_flag("--zero-at-shadow",
                  convert.zeroAtShadow,
                  "of readings: take off what is left in the shadow of the light's arm, too");

    sub = command(*app, "atlas", "several samples as one EXR picture for shaders", [this] {
        return daemon::atlas(common, atlas);
    });
    sub->add_option("files", atlas.files, "files, sample:NAME or model:SPEC")->required();
    sub->add_option("-o,--output", atlas.output, "the .exr file to write")->required();
    sub->add_option("--grid", atlas.grid, "incidences and pixels in degrees, as of convert");
    sub->add_option("--estimator",
                    atlas.estimator,
                    "what answers between the measured directions: none, auto, or by name");
    sub->add_flag("--half", atlas.half, "16-bit floats");

    sub =
        command(*app, "merge", "make one file of rotations, repeats or bands of a sample", [this] {
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

    sub = command(*app, "export", "write a file in all formats, or some", [this] {
        return exportTo(common, exported);
    });
    sub->add_option("file", exported.file, "a file, sample:NAME or model:SPEC")->required();
    sub->add_option("-o,--output", exported.output, "folder")->required();
    sub->add_option("--formats", exported.formats, "names of formats with commas, as of --to");
    sub->add_option("--estimator",
                    exported.estimator,
                    "what answers a table's nodes: none (what was measured), auto, or by name");

    sub = command(*app, "plot", "hemisphere maps and in-plane slices as SVG", [this] {
        return daemon::plot(common, plot);
    });
    sub->add_option("file", plot.file, "a file, sample:NAME or model:SPEC")->required();
    sub->add_option("-o,--output", plot.output, "folder for the pictures");

    sub = command(*app, "report", "all that is known of a sample as one HTML file", [this] {
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
        *app, "fit", "fit analytic models, rank them, and choose the simplest that holds", [this] {
            return daemon::fit(common, fit);
        });
    sub->add_option("file", fit.file, "a file of measured values, or sample:NAME")->required();
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
    CLI::App* parent = app->add_subcommand("trade", "the trade of speed for accuracy, measured");
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

}  // namespace gonio::daemon
