#pragma once
// What a capture allocates by `new` while the rig sends: on the caller's thread, as far as the
// driver has it, and on the stream's own. Reports are not the frames' way and are not counted.

#include <cstddef>
#include <functional>

#include "driver/protocol/reports.h"
#include "driver/protocol/transport.h"

namespace gonio::driver::test {

/// Since the last startWatching(), on threads that are watched: the one that started, unless it is
/// in an Unwatched scope, and any that is called kStreamThread.
[[nodiscard]] std::size_t allocationsSeen();
void startWatching();
void stopWatching();

class Unwatched {
public:
    Unwatched();
    ~Unwatched();
    Unwatched(const Unwatched&) = delete;
    Unwatched& operator=(const Unwatched&) = delete;
};

/// A transport that starts the watching with each ARM that goes through it.
class AllocationWatch : public Transport {
public:
    /// `ourBulk`: reading from the stream is the driver's work too, not the simulator's.
    AllocationWatch(Transport& inner, bool ourBulk) : inner_(inner), ourBulk_(ourBulk) {}

    [[nodiscard]] DeviceStrings strings() const override { return inner_.strings(); }
    [[nodiscard]] const Clock& clock() const override { return inner_.clock(); }
    Result<void> write(const Report& report) override {
        const Unwatched off;
        const auto command = decodeCommand(report);
        if (command && command->op == Op::Arm) startWatching();
        return inner_.write(report);
    }
    Result<void> setFeature(const Report& report) override {
        const Unwatched off;
        return inner_.setFeature(report);
    }
    [[nodiscard]] Result<Report> getFeature(std::uint8_t id) override {
        const Unwatched off;
        return inner_.getFeature(id);
    }
    [[nodiscard]] Result<std::optional<Report>> readInput(Nanoseconds wait) override {
        const Unwatched off;
        return inner_.readInput(wait);
    }
    [[nodiscard]] Result<std::optional<BulkBytes>> readBulk(Nanoseconds wait) override {
        if (ourBulk_) return inner_.readBulk(wait);
        const Unwatched off;
        return inner_.readBulk(wait);
    }
    Result<void> resetStream() override { return inner_.resetStream(); }
    Result<void> reopenReports() override { return inner_.reopenReports(); }
    Result<void> resetPort() override { return inner_.resetPort(); }

private:
    Transport& inner_;
    bool ourBulk_;
};

}  // namespace gonio::driver::test
