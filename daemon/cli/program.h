#pragma once
// The command line of `gonio`: which commands there are, and the options of each.

#include <functional>
#include <memory>
#include <string>

#include "daemon/cli/commands.h"
#include "daemon/cli/goal_options.h"

namespace CLI {
class App;
}

namespace gonio::daemon {

/// The command that the command line chose.
using Command = std::function<Result<void>()>;

/// Keeps the parsed options alive while the chosen command runs.
struct Program {
    std::unique_ptr<CLI::App> app;
    CommonOptions common;
    PlaceRequest place;
    SimServeOptions simServe;
    ScoreOptions score;
    VerifyOptions verify;
    std::string limit = "1%";
    MeasureOptions measure;
    DoctorOptions doctor;
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
    AtlasOptions atlas;
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
    ~Program();
    CLI::App* command(CLI::App& parent,
                      const std::string& name,
                      const std::string& help,
                      Command run);
    void addSim();
    void addSimServe(CLI::App& sim);
    void addCalibration();
    void addGoal(CLI::App* sub);
    void addMeasuring();
    void addDaemon();
    void addSession();
    void addFiles();
    void addFit();
    void addEvidence();
};

}  // namespace gonio::daemon
