#pragma once
// The report side of an opened rig, through hidraw. One thread owns the device and does all that
// touches it, one request at a time; input reports wait in a queue, of which the newest are kept.
// A request that the rig does not answer in a second is a failure, as is a read that fails, and a
// failure is final: the thread may be stuck in the kernel then, and is left behind with what it
// holds. Nothing is allocated for a request, nor for a report that comes.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "driver/protocol/transport.h"

namespace gonio::driver {

/// The name of the thread that owns the reports, as `top -H` and a debugger show it.
inline constexpr const char* kReportThread = "gonio-reports";

struct HidNode {
    std::string path;  ///< "/dev/hidraw0": of this moment, never to be kept
    std::uint16_t vendor = 0;
    std::uint16_t product = 0;
    std::string serial;
};

/// The hidraw node of a rig's HID interface; empty when there is none.
[[nodiscard]] std::optional<HidNode> findHid(const DeviceStrings& rig, int interfaceNumber);
/// Why the node cannot be opened, and the cure; empty: it can.
[[nodiscard]] std::string hidObstacle(const HidNode& node);

class HidChannel : public std::enable_shared_from_this<HidChannel> {
public:
    [[nodiscard]] static Result<std::shared_ptr<HidChannel>> open(const HidNode& node);
    HidChannel(const HidChannel&) = delete;
    HidChannel& operator=(const HidChannel&) = delete;
    ~HidChannel() = default;

    Result<void> write(const Report& report);
    Result<void> setFeature(const Report& report);
    [[nodiscard]] Result<Report> getFeature(std::uint8_t id);
    [[nodiscard]] Result<std::optional<Report>> readInput(Nanoseconds wait);

    void askToStop();
    void awaitStop(std::chrono::steady_clock::time_point deadline);
    [[nodiscard]] std::optional<Error> failure() const;

private:
    enum class Kind {
        Open,
        Write,
        SetFeature,
        GetFeature
    };
    struct Job {
        Kind kind = Kind::Open;
        Report report{};
        bool asked = false, done = false;
        std::string problem;  ///< empty: it went well
    };
    class Owner;  // of the hid_device

    explicit HidChannel(HidNode node);
    [[nodiscard]] Result<Report> ask(Kind kind, const Report& report);
    void serve();
    void perform(Owner& owner, Job& job) const;
    void fail(const std::string& what);

    HidNode node_;
    std::thread thread_;

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    Job job_;  ///< of a caller that has given up, nobody wants to know: it is a failure
    std::vector<Report> inputs_;  ///< oldest first
    bool stopping_ = false, finished_ = false;
    std::optional<Error> failure_;
};

}  // namespace gonio::driver
