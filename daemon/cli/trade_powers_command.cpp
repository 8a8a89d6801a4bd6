#include <filesystem>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "daemon/cli/commands.h"
#include "daemon/cli/output.h"
#include "daemon/cli/progress.h"
#include "driver/steady_clock.h"
#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"
#include "proc/models/paper_figures.h"
#include "proc/models/power_timing.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;
using Rows = std::vector<std::vector<std::string>>;

struct PowerStudy {
    proc::SchlickRegression regression;
    std::vector<proc::PaperFigure> figures;
    std::vector<proc::PowerErrors> errors;
    std::vector<proc::PowerTime> times;
    std::vector<proc::NotBeaten> notBeaten;
    std::string instructionSet;  ///< that the models' loops run
};

std::string text(std::string_view view) { return std::string(view); }

std::string name(proc::Precision precision) {
    return precision == proc::Precision::Float ? "float" : "double";
}

std::string digits(double value, int count) {
    std::ostringstream out;
    out << std::setprecision(count) << value;
    return out.str();
}

PowerStudy study(const CommonOptions& common, const TradePowersOptions& options) {
    Progress progress("trade powers", !common.quiet && !common.json);
    const auto shown = [&](const std::string& what) {
        return [&progress, what](std::size_t done, std::size_t steps) {
            progress.show({.step = static_cast<int>(done),
                           .steps = static_cast<int>(steps),
                           .what = what,
                           .left = Seconds(0)});
        };
    };
    const proc::PowerGrid grid = options.quick ? proc::PowerGrid::quick() : proc::PowerGrid{};
    const proc::TimingEffort effort{.repeats = options.quick ? 5 : 60};
    PowerStudy all;
    all.regression = proc::regressSchlick();
    all.figures = proc::paperFigures(all.regression, grid, shown("the paper's figures"));
    all.errors = proc::powerErrors(grid, shown("errors"));
    const driver::SteadyClock clock;
    const Stopwatch watch(clock);
    all.times = proc::timePowers(watch, effort, shown("times"));
    all.notBeaten = proc::notBeaten(all.errors, all.times);
    all.instructionSet = text(proc::name(proc::powerCodes().back()));
    return all;
}

const proc::PowerErrors* errorsOf(const PowerStudy& all, const proc::PowerTime& time) {
    for (const proc::PowerErrors& one : all.errors) {
        if (proc::name(one.form) == time.form && one.precision == time.precision) return &one;
    }
    return nullptr;
}

std::string csv(const PowerStudy& all) {
    std::string out =
        "form,precision,code,ns,epicentre,absolute_8_1000,absolute_1_1e6,absolute_8_1e6,peak,least,"
        "residue\n";
    for (const proc::PowerTime& time : all.times) {
        out += time.form + "," + name(time.precision) + "," + text(proc::name(time.code)) + "," +
               shortest(time.nanoseconds);
        if (const proc::PowerErrors* e = errorsOf(all, time); e != nullptr) {
            for (const double value : {e->epicentre,
                                       e->absolute,
                                       e->anyPower(),
                                       e->fromEight(),
                                       e->peak,
                                       e->least,
                                       e->residue}) {
                out += "," + shortest(value);
            }
        } else {
            out += ",,,,,,,";
        }
        out += "\n";
    }
    return out;
}

Rows figureRows(const PowerStudy& all) {
    Rows rows{{"the paper's figure", "printed", "here", "reproduces", "remark"}};
    for (const proc::PaperFigure& f : all.figures) {
        rows.push_back(
            {f.what, f.printed, digits(f.here, 4), f.reproduces ? "yes" : "no", f.remark});
    }
    return rows;
}

Rows errorRows(const PowerStudy& all, proc::Precision precision) {
    Rows rows{{name(precision),
               "epicentre %",
               "n 8..1000",
               "n 1..1e6",
               "n 8..1e6",
               "peak",
               "least",
               "residue"}};
    for (const proc::PowerErrors& e : all.errors) {
        if (e.precision != precision) continue;
        rows.push_back({text(proc::name(e.form)),
                        digits(100 * e.epicentre, 2),
                        digits(e.absolute, 3),
                        digits(e.anyPower(), 3),
                        digits(e.fromEight(), 3),
                        digits(e.peak, 4),
                        digits(e.least, 3),
                        digits(e.residue, 2)});
    }
    return rows;
}

/// One row a form, one column a kind of code; the times come by code, then by form.
Rows timeRows(const PowerStudy& all, proc::Precision precision) {
    Rows rows{{name(precision)}};
    for (const proc::PowerCode code : proc::powerCodes()) rows[0].push_back(text(proc::name(code)));
    for (const proc::PowerTime& time : all.times) {
        if (time.precision != precision) continue;
        auto row = std::find_if(
            rows.begin() + 1, rows.end(), [&](const auto& other) { return other[0] == time.form; });
        if (row == rows.end()) {
            rows.push_back({time.form});
            row = rows.end() - 1;
        }
        row->push_back(fixed(time.nanoseconds, 3));
    }
    return rows;
}

Rows notBeatenRows(const PowerStudy& all) {
    Rows rows{{"not beaten", "code", "precision", "ns", "ours", "ns"}};
    for (const proc::NotBeaten& n : all.notBeaten) {
        rows.push_back({text(proc::name(n.form)),
                        text(proc::name(n.code)),
                        name(n.precision),
                        fixed(n.nanoseconds, 3),
                        text(proc::name(n.ours)),
                        fixed(n.oursNanoseconds, 3)});
    }
    return rows;
}

struct Section {
    std::string title;
    Rows rows;
};

std::vector<Section> sections(const PowerStudy& all) {
    using enum proc::Precision;
    std::vector<Section> out;
    const proc::SchlickRegression& r = all.regression;
    out.push_back({"The paper's figures; the regression over " + std::to_string(r.rows) +
                       " rows leaves an rms of " + digits(r.rms, 3),
                   figureRows(all)});
    for (const proc::Precision precision : {Double, Float}) {
        out.push_back({"Largest errors against cos^n, " + name(precision) +
                           ": relative in the epicentre, then absolute; value at the peak, least "
                           "value, error where cos^n < 1e-6",
                       errorRows(all, precision)});
    }
    for (const proc::Precision precision : {Float, Double}) {
        out.push_back({"Nanoseconds an evaluation, " + name(precision) +
                           "; the models' loops run as " + all.instructionSet,
                       timeRows(all, precision)});
    }
    out.push_back(
        {"Where none of ours errs no more (n 8..1000) in no more time: the published form "
         "and the fastest of ours that errs no more",
         notBeatenRows(all)});
    return out;
}

std::string markdown(const std::vector<Section>& all) {
    std::string out;
    for (const Section& section : all) {
        out += section.title + ".\n\n" + markdownTable(section.rows) + "\n";
    }
    return out;
}

Json toJson(const PowerStudy& all, const Json& files) {
    const proc::SchlickRegression& r = all.regression;
    Json json{{"schema", "gonio/trade-powers/1"},
              {"instruction_set", all.instructionSet},
              {"regression",
               {{"a", r.a}, {"b", r.b}, {"c", r.c}, {"d", r.d}, {"rms", r.rms}, {"rows", r.rows}}},
              {"paper", Json::array()},
              {"errors", Json::array()},
              {"times", Json::array()},
              {"not_beaten", Json::array()},
              {"files", files}};
    for (const proc::PaperFigure& f : all.figures) {
        json["paper"].push_back({{"what", f.what},
                                 {"printed", f.printed},
                                 {"here", f.here},
                                 {"reproduces", f.reproduces},
                                 {"remark", f.remark}});
    }
    for (const proc::PowerErrors& e : all.errors) {
        json["errors"].push_back({{"form", proc::name(e.form)},
                                  {"precision", name(e.precision)},
                                  {"epicentre", e.epicentre},
                                  {"absolute_8_1000", e.absolute},
                                  {"absolute_1_1e6", e.anyPower()},
                                  {"absolute_8_1e6", e.fromEight()},
                                  {"peak", e.peak},
                                  {"least", e.least},
                                  {"residue", e.residue}});
    }
    for (const proc::PowerTime& t : all.times) {
        json["times"].push_back({{"form", t.form},
                                 {"precision", name(t.precision)},
                                 {"code", proc::name(t.code)},
                                 {"ns", t.nanoseconds}});
    }
    for (const proc::NotBeaten& n : all.notBeaten) {
        json["not_beaten"].push_back({{"form", proc::name(n.form)},
                                      {"precision", name(n.precision)},
                                      {"code", proc::name(n.code)},
                                      {"ns", n.nanoseconds},
                                      {"ours", proc::name(n.ours)},
                                      {"ours_ns", n.oursNanoseconds}});
    }
    return json;
}

}  // namespace

Result<void> tradePowers(const CommonOptions& common, const TradePowersOptions& options) {
    if (auto done = makeOutputFolder(options.output); !done) return done.error().in("trade powers");
    const PowerStudy all = study(common, options);
    const std::vector<Section> tables = sections(all);
    Json files = Json::array();
    if (!options.output.empty()) {
        const auto write = [&](const std::string& file, const std::string& bytes) {
            files.push_back((options.output / file).string());
            return proc::writeFile(options.output / file, bytes);
        };
        if (auto done = write("trade-powers.csv", csv(all)); !done) return done;
        if (auto done = write("trade-powers.md", markdown(tables)); !done) return done;
    }
    if (common.json) {
        printJson(toJson(all, files));
    } else if (!common.quiet) {
        for (const Section& section : tables) {
            std::cout << section.title << "\n\n";
            printTable(section.rows);
            std::cout << "\n";
        }
        for (const Json& file : files) std::cout << file.get<std::string>() << "\n";
    }
    return {};
}

}  // namespace gonio::daemon
