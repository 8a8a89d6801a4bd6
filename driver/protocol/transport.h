#pragma once
// The seam between the driver and whatever carries its bytes: the in-process simulated rig, or the
// real USB libraries. One Transport is one opened rig, both interfaces together. It moves bytes and
// waits; it knows no meaning. Every wait has a deadline on the transport's own clock.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "proc/core/result.h"
#include "proc/core/stopwatch.h"

namespace gonio::driver {

inline constexpr std::size_t kReportBytes = 64;

/// One HID report; byte 0 is the report id.
using Report = std::array<std::uint8_t, kReportBytes>;

/// What the descriptors say of an opened rig (PROTOCOL.md 1).
struct DeviceStrings {
    std::uint16_t vendor = 0;
    std::uint16_t product = 0;
    std::string serial;
    std::string protocol;  ///< string descriptor 240, e.g. "GRP/1.0"
};

/// Of one bulk transfer: one chunk, or whatever came. Borrowed until the next call of readBulk or
/// resetPort, and no longer than the transport lives.
using BulkBytes = std::span<const std::uint8_t>;

class Transport {
public:
    virtual ~Transport() = default;

    [[nodiscard]] virtual DeviceStrings strings() const = 0;
    /// The clock on which waits are counted; virtual for a simulated rig.
    [[nodiscard]] virtual const Clock& clock() const = 0;

    /// HID output report (COMMAND).
    virtual Result<void> write(const Report& report) = 0;
    virtual Result<void> setFeature(const Report& report) = 0;
    [[nodiscard]] virtual Result<Report> getFeature(std::uint8_t id) = 0;

    /// The next HID input report, or nothing when `wait` has passed.
    [[nodiscard]] virtual Result<std::optional<Report>> readInput(Nanoseconds wait) = 0;
    /// The next bulk transfer, or nothing when `wait` has passed.
    [[nodiscard]] virtual Result<std::optional<BulkBytes>> readBulk(Nanoseconds wait) = 0;
    /// Closes the report side and opens it anew: for reports that have fallen silent.
    virtual Result<void> reopenReports() = 0;
    /// Resets the rig's port. The rig loses its link by it: dark, flushed, the session lapsed.
    virtual Result<void> resetPort() = 0;
};

}  // namespace gonio::driver
