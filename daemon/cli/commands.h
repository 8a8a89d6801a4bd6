#pragma once
// The commands of the `gonio` program, one function each. Data go to stdout, or where an option
// says; progress and logs go to stderr. An Error's kind becomes the exit code.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/capture_goal.h"
#include "daemon/engine/sim_port.h"
#include "proc/core/result.h"

namespace gonio::daemon {

struct CommonOptions {
    bool json = false;
    bool quiet = false;
    bool yes = false;              ///< what a person is asked to do is done
    std::filesystem::path store;   ///< empty: the default place
    std::filesystem::path socket;  ///< empty: of the store

    /// Where the daemon is.
    [[nodiscard]] std::filesystem::path socketPath() const;
};

Result<void> simPlace(const CommonOptions& common, PlaceRequest place);

struct SimServeOptions {
    bool usbip = false;   ///< over TCP
    bool attach = false;  ///< to this computer's own kernel
    std::string bind = "127.0.0.1";
    int port = 3240;
    std::vector<std::string> serials{"SIM-0001"};
    std::string placed = "nothing";
    std::uint64_t seed = 1;
    std::string systematic = "random";
    std::string rigErrors = "none";
    std::string camera = "usb2";
    std::filesystem::path faults;  ///< a script of what goes wrong; empty: nothing
};
/// Simulated rigs as USB devices, until SIGINT or SIGTERM.
Result<void> simServe(const CommonOptions& common, const SimServeOptions& options);

struct ScoreOptions {
    std::vector<std::filesystem::path> files;
    std::filesystem::path output;  ///< summary.json; empty: none
};
/// Holds measured samples of the simulated rig against its truth.
Result<void> simScore(const CommonOptions& common, const ScoreOptions& options);

enum class Reference {
    Mirror,
    Black,
    White,
    Zero,
    Flat,
    Sensor,
    Leds,
    Dark
};
Result<void> calibrate(const CommonOptions& common, Reference reference);

struct VerifyOptions {
    double limit = 0.01;  ///< largest relative change that passes
    bool turned = false;  ///< the tile was turned about its normal
};
Result<void> verifyWhite(const CommonOptions& common, const VerifyOptions& options);

struct MeasureOptions {
    std::string name;
    CaptureGoal goal;
    std::string notes;
    bool force = false;   ///< with calibrations that are no longer good and refused verdicts, too
    std::string backing;  ///< black or white; empty: not said
    std::string against;  ///< the same sample on the other backing; empty: none
    int monteCarlo = 0;   ///< draws per cell; 0: where first order is wrong
    double rotationDegrees = 0;    ///< of the sample on the stage
    std::filesystem::path output;  ///< a copy of the .gonio; empty: the store only
};
Result<void> measure(const CommonOptions& common, const MeasureOptions& options);

/// What measuring the sample under the rig would take and achieve; takes its pilots only.
Result<void> plan(const CommonOptions& common, const CaptureGoal& goal);

struct RecalibrateOptions {
    std::string name;
    std::string calibration;       ///< 10+11+12, or one number; empty: the newest
    int monteCarlo = 0;            ///< draws per cell; 0: as it was measured
    std::filesystem::path output;  ///< a copy of the .gonio; empty: the store only
};
Result<void> recalibrate(const CommonOptions& common, const RecalibrateOptions& options);
Result<void> calibrations(const CommonOptions& common);

Result<void> status(const CommonOptions& common);
Result<void> rigs(const CommonOptions& common);
Result<void> samples(const CommonOptions& common);
Result<void> jobs(const CommonOptions& common);
/// Ends the job that runs.
Result<void> cancelJob(const CommonOptions& common);
/// What the job that runs has asked a person to do is done.
Result<void> proceedJob(const CommonOptions& common);

struct SessionOptions {
    std::string name;  ///< empty: its date
    std::string operatorName;
    std::string notes;
};
Result<void> newSession(const CommonOptions& common, const SessionOptions& options);
Result<void> closeSession(const CommonOptions& common);
Result<void> listSessions(const CommonOptions& common);

struct WatchOptions {
    std::optional<std::uint64_t> after;  ///< number of an event; empty: from now on
};
/// Prints events as they happen, until Ctrl-C.
Result<void> watch(const CommonOptions& common, const WatchOptions& options);

struct DoctorOptions {
    bool handsOff = false;          ///< no rig is claimed: seen from outside only
    std::filesystem::path profile;  ///< what a rig's noise is held against; empty: by its camera
};
/// What stands between this computer and a measurement; a rig that is free takes dark frames.
Result<void> doctor(const CommonOptions& common, const DoctorOptions& options);

struct InfoOptions {
    std::string file;
    std::string from;                ///< a format's name; empty: by the content
    std::string estimator = "none";  ///< else what it makes of the file, too
};
Result<void> info(const CommonOptions& common, const InfoOptions& options);

struct EvalOptions {
    std::string file;
    std::filesystem::path points;
    std::filesystem::path output;  ///< empty: stdout
    std::string precision = "double";
    std::string effort = "reference";  ///< of a model's evaluation, and of an estimator
    std::string estimator = "auto";    ///< daemon/estimators.h
    std::filesystem::path prior;       ///< a library; empty: the standard one
};
Result<void> eval(const CommonOptions& common, const EvalOptions& options);

struct AlbedoOptions {
    std::string file;
    std::string incidences;          ///< degrees with commas; empty: those of the file
    std::string estimator = "auto";  ///< none: of a sample the sum over its cells
    std::string effort = "standard";
};
/// Directional-hemispherical and mean albedo, with their uncertainties and what is missing.
Result<void> albedo(const CommonOptions& common, const AlbedoOptions& options);

struct CompareOptions {
    std::string a;
    std::string b;
    std::string incidences;  ///< degrees with commas; empty: those of a
    std::string estimator;   ///< of both; empty: none, of scattered values auto
};
/// Whether two surfaces agree within their uncertainties: relative, log and cosine-weighted
/// differences, by region.
Result<void> compare(const CommonOptions& common, const CompareOptions& options);

struct PriorOptions {
    std::size_t count = 2000;
    std::uint64_t seed = 1;
    std::vector<std::filesystem::path> fits;  ///< files of published fits
    std::filesystem::path output;
};
/// Writes the materials of a statistical prior, a model's spec per line.
Result<void> buildPrior(const CommonOptions& common, const PriorOptions& options);

struct ConvertOptions {
    std::string input;
    std::filesystem::path output;
    std::string from;    ///< a format's name; empty: by the content
    std::string to;      ///< a format's name; empty: by the output's extension
    std::string bands;   ///< of r, g, b with commas, or srgb; empty: all
    std::string grid;    ///< incidences and step of a table; empty: the usual ones
    std::string cosine;  ///< yes, no: whether the values hold it; empty: as the file says
    std::string estimator = "none";              ///< else it answers a table's directions
    bool half = false;                           ///< 16-bit floats where the format has them
    std::filesystem::path black;                 ///< RT-300S readings of the empty stage
    std::vector<std::filesystem::path> repeats;  ///< more readings of the same sample
    bool plane = false;         ///< readings of both sides of the plane of incidence are averaged
    bool zeroAtShadow = false;  ///< what is left in the arm's shadow is taken off, too
};
Result<void> convert(const CommonOptions& common, const ConvertOptions& options);

struct AtlasOptions {
    std::vector<std::string> files;
    std::filesystem::path output;
    std::string grid;                ///< as of convert
    std::string estimator = "none";  ///< as of convert
    bool half = false;               ///< 16-bit floats
};
/// Several samples as one picture, tile by tile, for shaders.
Result<void> atlas(const CommonOptions& common, const AtlasOptions& options);

struct MergeCommandOptions {
    std::vector<std::string> files;
    std::filesystem::path output;  ///< .gonio or .csv
    bool plane = false;
    bool isotropic = false;
    bool reciprocal = false;
    bool anyCalibration = false;
};
/// Rotations, repeats or bands of one sample as one file (daemon/merging.h).
Result<void> merge(const CommonOptions& common, const MergeCommandOptions& options);

struct ExportOptions {
    std::string file;
    std::filesystem::path output;
    std::string formats;  ///< with commas; empty: of gonio, zemax and csv what it can become
    std::string estimator = "none";  ///< else it answers a table's nodes
};
Result<void> exportTo(const CommonOptions& common, const ExportOptions& options);

struct PlotOptions {
    std::string file;
    std::filesystem::path output;  ///< a folder; empty: the working folder
};
Result<void> plot(const CommonOptions& common, const PlotOptions& options);

struct ReportOptions {
    std::string file;
    std::filesystem::path output;    ///< empty: NAME.html in the working folder
    std::string models = "usual";    ///< families with commas, usual, all or none
    std::string estimator = "auto";  ///< none: nothing is said of what was not measured
};
/// All that is known of a measured sample as one HTML file.
Result<void> report(const CommonOptions& common, const ReportOptions& options);

struct FitOptions {
    std::string file;            ///< .gonio, Zemax, CSV of scattered values, or sample:NAME
    std::string models = "all";  ///< families, with commas
    std::string weights = "uncertainty";  ///< or cosine, both, none
    std::string robust = "none";          ///< or huber, cauchy; with :SCALE
    std::string assumed = "5%";           ///< relative uncertainty where the file gives none
    std::string floor;  ///< relative uncertainty added to what the file gives; empty: none
    std::filesystem::path output;  ///< a folder for the report; empty: none
};
/// Fits families of analytic models, ranks them and names the simplest that the noise cannot
/// reject; "none fits" is an answer like any other.
Result<void> fit(const CommonOptions& common, const FitOptions& options);

struct TradeOptions {
    bool quick = false;            ///< fewer materials and wanted uncertainties
    std::vector<int> levels;       ///< numbers of LED levels, 1..3; empty: all
    std::filesystem::path output;  ///< a folder; empty: the working folder
};
/// What best plans take and achieve, by rig, LED levels, material and wanted uncertainty.
Result<void> tradeAcquisition(const CommonOptions& common, const TradeOptions& options);

struct TradeNumericsOptions {
    std::filesystem::path reference;  ///< a folder of tables
    std::filesystem::path output;     ///< a Markdown file; empty: none
};
/// The models' errors in float and double against reference values, by table, column and alpha.
Result<void> tradeNumerics(const CommonOptions& common, const TradeNumericsOptions& options);

struct TradeInterpolationOptions {
    bool quick = false;            ///< four materials, fewer directions
    std::string noise = "0";       ///< relative, of each cell: "1%"
    std::filesystem::path output;  ///< a folder for tables and pictures; empty: none
};
/// Every estimator on surfaces of known truth, between and beyond the measured angles.
Result<void> tradeInterpolation(const CommonOptions& common,
                                const TradeInterpolationOptions& options);

struct TradeLookupOptions {
    bool quick = false;
    std::filesystem::path output;  ///< a folder; empty: no files
};
/// What baked tables err, take and weigh.
Result<void> tradeLookup(const CommonOptions& common, const TradeLookupOptions& options);
/// What nearest neighbours among scattered BRDF samples cost, by their number.
Result<void> tradeNeighbours(const CommonOptions& common, const TradeLookupOptions& options);

struct TradePowersOptions {
    bool quick = false;            ///< fewer powers, angles and repeats
    std::filesystem::path output;  ///< a folder; empty: no files
};
/// Errors and times of every form of cos^n, and the figures of the paper that proposed one.
Result<void> tradePowers(const CommonOptions& common, const TradePowersOptions& options);

}  // namespace gonio::daemon
