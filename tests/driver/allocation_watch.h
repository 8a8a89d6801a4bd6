#pragma once
// What captures cost by `new`, and in bytes copied, while the rig sends: on the caller's thread, as
// far as the driver has it, and on the driver's own threads. A capture counts from its ARM to its
// last frame; while any does, all is counted.

#include <cstddef>
#include <optional>

#include "driver/protocol/reports.h"
#include "driver/protocol/transport.h"

namespace gonio::driver::test {

/// On threads that are watched: the one that sent the first ARM, unless it is in an Unwatched
/// scope, and the driver's own (kStreamThread, kReportThread).
struct Spent {
    std::size_t allocations = 0;
    /// By memcpy and memmove; a test that asks for it is linked as watches_copies() in
    /// tests/CMakeLists.txt does.
    std::size_t bytesCopied = 0;
};
/// Since it was asked last, while captures were on their way.
[[nodiscard]] Spent takeSpent();
/// A capture has been armed; its last frame is there.
void captureArmed();
void captureTaken();

class Unwatched {
public:
    Unwatched();
    ~Unwatched();
    Unwatched(const Unwatched&) = delete;
    Unwatched& operator=(const Unwatched&) = delete;
};

/// A transport that tells of each ARM that goes through it.
class ArmWatch : public Transport {
public:
    /// What is behind it: the driver's own work, or the simulator's, which is not watched.
    enum class Behind {
        Driver,
        Simulator
    };
    ArmWatch(Transport& inner, Behind behind) : inner_(inner), behind_(behind) {}

    [[nodiscard]] int arms() const { return arms_; }

    [[nodiscard]] DeviceStrings strings() const override { return inner_.strings(); }
    [[nodiscard]] const Clock& clock() const override { return inner_.clock(); }
    Result<void> write(const Report& report) override {
        const auto command = decodeCommand(report);
        if (command && command->op == Op::Arm) {
            ++arms_;
            captureArmed();
        }
        return through([&] { return inner_.write(report); });
    }
    Result<void> setFeature(const Report& report) override {
        return through([&] { return inner_.setFeature(report); });
    }
    [[nodiscard]] Result<Report> getFeature(std::uint8_t id) override {
        return through([&] { return inner_.getFeature(id); });
    }
    [[nodiscard]] Result<std::optional<Report>> readInput(Nanoseconds wait) override {
        return through([&] { return inner_.readInput(wait); });
    }
    [[nodiscard]] Result<std::optional<BulkBytes>> readBulk(Nanoseconds wait) override {
        return through([&] { return inner_.readBulk(wait); });
    }
    Result<void> reopenReports() override { return inner_.reopenReports(); }
    Result<void> resetPort() override { return inner_.resetPort(); }

private:
    template <class Call>
    auto through(Call call) -> decltype(call()) {
        std::optional<Unwatched> off;
        if (behind_ == Behind::Simulator) off.emplace();
        return call();
    }

    Transport& inner_;
    Behind behind_;
    int arms_ = 0;
};

}  // namespace gonio::driver::test
