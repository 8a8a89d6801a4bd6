#pragma once
// A cable between a driver and any transport, which breaks at a given call, and how a rig on it
// comes back. A cable that is broken stays so, and counts who still pulls at it.

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driver/comeback.h"
#include "driver/protocol/transport.h"

namespace gonio::driver::test {

class LooseCable : public Transport {
public:
    LooseCable(Transport& rig, std::function<void()> broken)
        : rig_(rig), broken_(std::move(broken)) {}

    long calls = 0;
    bool brokeAtWrite = false;  ///< so that the rig has not heard the command
    long breaksAt = std::numeric_limits<long>::max();  ///< this call fails, and all after it
    bool over = false;                                 ///< nobody may touch it any more
    long touches = 0;                                  ///< although it is over
    int resets = 0, reopens = 0;
    std::string serial;          ///< another one than the rig's
    std::optional<Error> fault;  ///< of every call from now on

    [[nodiscard]] DeviceStrings strings() const override {
        DeviceStrings strings = rig_.strings();
        if (!serial.empty()) strings.serial = serial;
        return strings;
    }
    [[nodiscard]] const Clock& clock() const override { return rig_.clock(); }
    Result<void> write(const Report& report) override {
        brokeAtWrite = calls == breaksAt;
        return through([&] { return rig_.write(report); });
    }
    Result<void> setFeature(const Report& report) override {
        return through([&] { return rig_.setFeature(report); });
    }
    [[nodiscard]] Result<Report> getFeature(std::uint8_t id) override {
        return through([&] { return rig_.getFeature(id); });
    }
    [[nodiscard]] Result<std::optional<Report>> readInput(Nanoseconds wait) override {
        return through([&] { return rig_.readInput(wait); });
    }
    [[nodiscard]] Result<std::optional<BulkBytes>> readBulk(Nanoseconds wait) override {
        return through([&] { return rig_.readBulk(wait); });
    }
    Result<void> reopenReports() override {
        ++reopens;
        return through([&] { return rig_.reopenReports(); });
    }
    Result<void> resetPort() override {
        ++resets;
        return through([&] { return rig_.resetPort(); });
    }

private:
    template <class Call>
    auto through(Call call) -> decltype(call()) {
        touches += over ? 1 : 0;
        if (calls++ == breaksAt) broken_();
        if (fault) return *fault;
        if (calls > breaksAt) return Error{ErrorKind::Device, "the cable is broken"};
        return call();
    }

    Transport& rig_;
    std::function<void()> broken_;
};

/// A rig and the cables that it hung on, the newest last.
class Replugged {
public:
    Replugged(Transport& rig, std::function<void()> broken)
        : rig_(rig), broken_(std::move(broken)) {
        plugIn();
    }
    LooseCable& plugIn() {
        cables.push_back(std::make_unique<LooseCable>(rig_, broken_));
        return *cables.back();
    }
    [[nodiscard]] LooseCable& cable() { return *cables.back(); }
    /// Another cable each time.
    Comeback comeback() {
        return [this](const Error& lost) -> Result<Transport*> {
            losses.push_back(lost);
            cable().over = true;
            LooseCable& fresh = plugIn();
            if (onPlug) onPlug(fresh);
            return &fresh;
        };
    }
    [[nodiscard]] long touches() const {
        long all = 0;
        for (const auto& one : cables) all += one->touches;
        return all;
    }

    std::vector<std::unique_ptr<LooseCable>> cables;
    std::vector<Error> losses;
    std::function<void(LooseCable&)> onPlug;

private:
    Transport& rig_;
    std::function<void()> broken_;
};

}  // namespace gonio::driver::test
