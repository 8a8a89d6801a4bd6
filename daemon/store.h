#pragma once
// Where calibrations and samples are kept: one directory of plain files.
//
//   sim.json             the simulated rig: serial, seed, what lies under it, next plan step
//   rigs/SERIAL/         lens.json, dark.graw, black.gonio, white.gonio and their raw captures
//   samples/NAME.gonio   and NAME.graw

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "proc/core/result.h"

namespace gonio::daemon {

class Store {
public:
    /// --store DIR, else $GONIO_STORE, else $XDG_DATA_HOME/gonio, else ~/.local/share/gonio.
    /// Made when it is not there.
    [[nodiscard]] static Result<Store> open(const std::filesystem::path& chosen);

    [[nodiscard]] const std::filesystem::path& root() const { return root_; }
    [[nodiscard]] std::filesystem::path simState() const { return root_ / "sim.json"; }
    [[nodiscard]] std::filesystem::path rig(const std::string& serial) const;
    /// Usage error unless NAME is 1..64 of letters, digits, '.', '_', '-' and starts with none of
    /// the last three.
    [[nodiscard]] Result<std::filesystem::path> sample(std::string_view name,
                                                       std::string_view extension) const;
    [[nodiscard]] std::vector<std::string> sampleNames() const;
    /// Makes room for a sample that is measured again: what is there of NAME is kept as NAME.1, or
    /// the first number that is free. That name; empty when there was nothing.
    [[nodiscard]] Result<std::string> setAside(const std::string& name) const;

private:
    explicit Store(std::filesystem::path root) : root_(std::move(root)) {}
    std::filesystem::path root_;
};

}  // namespace gonio::daemon
