// Arrows run one way. The full order of folders is known here from the start: a folder may include
// itself and what stands before it, under the rules of each layer.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kProcOrder{"proc/core",
                                          "proc/solve",
                                          "proc/models",
                                          "proc/radiance",
                                          "proc/optics",
                                          "proc/calibrate",
                                          "proc/plan",
                                          "proc/table",
                                          "proc/formats",
                                          "proc/fit",
                                          "proc/estimate",
                                          "proc/quality",
                                          "proc/environment",
                                          "proc/render",
                                          "proc/scene",
                                          "proc/export",
                                          "proc/report"};

bool startsWith(const std::string& text, const std::string& head) {
    return text.rfind(head, 0) == 0;
}

/// The folder of the order that a path is in; empty when it is in none.
std::optional<std::size_t> procRank(const std::string& path) {
    for (std::size_t i = 0; i < kProcOrder.size(); ++i) {
        if (startsWith(path, kProcOrder[i] + "/")) return i;
    }
    return std::nullopt;
}

bool inAny(const std::string& path, const std::vector<std::string>& folders) {
    return std::any_of(folders.begin(), folders.end(), [&](const std::string& folder) {
        return startsWith(path, folder + "/");
    });
}

/// May a file of `from` include `target`? Both relative to the root.
bool allowed(const std::string& from, const std::string& target) {
    if (startsWith(from, "tests/")) return true;
    if (startsWith(from, "proc/")) {
        const auto own = procRank(from);
        const auto other = procRank(target);
        return own && other && *other <= *own;
    }
    if (startsWith(from, "driver/protocol/"))
        return inAny(target, {"proc/core", "driver/protocol"});
    if (startsWith(from, "driver/")) return inAny(target, {"proc/core", "driver"});
    if (startsWith(from, "sim/")) {
        return inAny(
            target,
            {"sim", "driver/protocol", "proc/core", "proc/models", "proc/table", "proc/formats"});
    }
    return startsWith(from, "daemon/") && inAny(target, {"proc", "driver", "sim", "daemon"});
}

/// Third-party headers stay behind one wrapper: what may include them, none of it in a header.
/// An empty owner is any source file.
struct Wrapped {
    std::regex header;
    std::string owner;
};

const std::vector<Wrapped> kWrapped{
    {std::regex("spdlog/.*"), "proc/core/log.cpp"},
    {std::regex("ceres/.*"), "proc/solve/"},
    {std::regex("nanoflann\\.hpp"), "proc/table/"},
    {std::regex("(OpenEXR/)?Imf.*|Imath/.*|Imath.*"), "proc/formats/"},
    {std::regex("libusb.*|hidapi.*"), "driver/"},
    {std::regex("png\\.h"), "proc/report/png.cpp"},
    {std::regex("pugixml\\.hpp"), "proc/formats/klems.cpp"},
    {std::regex("sqlite3\\.h|httplib\\.h|systemd/.*"), "daemon/"},
    // json_fwd.hpp declares names only.
    {std::regex("(opencv2|CLI|toml\\+\\+|embree3)/.*|nlohmann/(?!json_fwd\\.hpp).*"), ""},
};

bool breaksWrapper(const std::string& file, const std::string& target) {
    // Dual numbers are part of a template's type: this header is their one door.
    if (file == "proc/solve/jet.h" && target == "ceres/jet.h") return false;
    return std::any_of(kWrapped.begin(), kWrapped.end(), [&](const Wrapped& wrapped) {
        return std::regex_match(target, wrapped.header) &&
               (file.ends_with(".h") || !startsWith(file, wrapped.owner));
    });
}

std::vector<std::string> violations(const std::string& file, std::istream& text) {
    static const std::regex include(R"(^\s*#\s*include\s*(["<])([^">]+)[">].*)");
    std::vector<std::string> found;
    std::string line;
    for (int number = 1; std::getline(text, line); ++number) {
        std::smatch match;
        if (!std::regex_match(line, match, include)) continue;
        const std::string target = match[2];
        const bool ours = match[1] == "\"" || procRank(target) || startsWith(target, "driver/") ||
                          startsWith(target, "sim/") || startsWith(target, "daemon/");
        if ((ours && !allowed(file, target)) || breaksWrapper(file, target)) {
            found.push_back(file + ":" + std::to_string(number) + ": must not include " + target);
        }
    }
    return found;
}

TEST(IncludeOrder, HoldsInTheWholeTree) {
    const fs::path root = GONIO_SOURCE_DIR;
    int files = 0;
    for (const char* top : {"proc", "driver", "sim", "daemon"}) {
        if (!fs::exists(root / top)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
            const std::string extension = entry.path().extension().string();
            if (extension != ".h" && extension != ".cpp") continue;
            ++files;
            std::ifstream text(entry.path());
            for (const std::string& v :
                 violations(fs::relative(entry.path(), root).string(), text)) {
                ADD_FAILURE() << v;
            }
        }
    }
    EXPECT_GT(files, 20);
}

/// Eigen/Core declares these and leaves them out: without precompiled headers, which have them all,
/// a file compiles without this include, and does not link.
bool lacksGeometry(const std::string& text) {
    static const std::regex uses(R"(\.cross\(|\bunitOrthogonal\(|\.inverse\(\)|\.determinant\(\))");
    static const std::regex has(R"(#include <Eigen/(Geometry|Dense|LU|SVD|Eigenvalues)>)");
    return std::regex_search(text, uses) && !std::regex_search(text, has);
}

TEST(EigenGeometry, IsIncludedWhereItIsUsed) {
    const fs::path root = GONIO_SOURCE_DIR;
    int files = 0;
    for (const char* top : {"proc", "driver", "sim", "daemon", "tests"}) {
        for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
            if (entry.path().extension() != ".cpp" && entry.path().extension() != ".h") continue;
            std::stringstream text;
            text << std::ifstream(entry.path()).rdbuf();
            EXPECT_FALSE(lacksGeometry(text.str())) << entry.path();
            ++files;
        }
    }
    EXPECT_GT(files, 20);
    EXPECT_TRUE(lacksGeometry("#include <Eigen/Core>\nauto n = a.cross(b);"));
    EXPECT_FALSE(lacksGeometry("#include <Eigen/Geometry>\nauto n = a.cross(b);"));
}

TEST(IncludeOrder, SeesEachKindOfBackEdge) {
    const auto bad = [](const std::string& file, const std::string& line) {
        std::istringstream text(line + "\n");
        return !violations(file, text).empty();
    };
    EXPECT_TRUE(bad("proc/core/a.h", "#include \"proc/models/ggx.h\""));
    EXPECT_TRUE(bad("proc/optics/a.cpp", "#include \"proc/report/svg.h\""));
    EXPECT_TRUE(bad("proc/fit/a.cpp", "#include \"driver/rig.h\""));
    EXPECT_TRUE(bad("driver/rig.cpp", "#include \"proc/radiance/merge.h\""));
    EXPECT_TRUE(bad("driver/rig.cpp", "#include \"sim/device.h\""));
    EXPECT_TRUE(bad("sim/device.cpp", "#include \"driver/rig.h\""));
    EXPECT_TRUE(bad("sim/device.cpp", "#include \"proc/optics/lens_map.h\""));
    EXPECT_TRUE(bad("proc/formats/a.h", "  #  include <nlohmann/json.hpp>"));
    EXPECT_TRUE(bad("daemon/a.h", "#include <CLI/CLI.hpp>"));
    EXPECT_TRUE(bad("proc/report/svg.cpp", "#include <png.h>"));
    EXPECT_TRUE(bad("sim/device.cpp", "#include <driver/rig.h>"));
    EXPECT_TRUE(bad("proc/fit/a.cpp", "#include <ceres/ceres.h>"));
    EXPECT_TRUE(bad("proc/solve/a.h", "#include <ceres/ceres.h>"));
    EXPECT_TRUE(bad("proc/models/a.cpp", "#include \"lambert.h\""));
    EXPECT_TRUE(bad("proc/unheard/a.cpp", "#include \"proc/core/bands.h\""));
    EXPECT_TRUE(bad("proc/fit/a.h", "#include <ceres/jet.h>"));
    EXPECT_TRUE(bad("proc/solve/jet.h", "#include <ceres/ceres.h>"));
    EXPECT_FALSE(bad("proc/solve/jet.h", "#include <ceres/jet.h>"));
    EXPECT_FALSE(bad("proc/solve/a.cpp", "#include <ceres/ceres.h>"));
    EXPECT_FALSE(bad("proc/formats/exr_parts.cpp", "#include <OpenEXR/ImfHeader.h>"));
    EXPECT_FALSE(bad("daemon/a.cpp", "#include <CLI/CLI.hpp>"));
    EXPECT_FALSE(bad("proc/report/a.cpp", "#include \"proc/core/bands.h\""));
    EXPECT_FALSE(bad("sim/a.cpp", "#include \"driver/protocol/crc.h\""));
    EXPECT_FALSE(bad("tests/sim/a.cpp", "#include \"driver/rig.h\""));
}

}  // namespace
