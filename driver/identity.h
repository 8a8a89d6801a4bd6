#pragma once
// Who a rig is: its protocol, IDENT and LIMITS, read and believed, or refused before anything is
// computed or allocated from them. A rig of another major version is refused and both versions are
// said; a newer minor is taken as it is. Numbers that no rig can mean are refused by their name.

#include <string>

#include "driver/protocol/reports.h"
#include "driver/protocol/transport.h"
#include "proc/core/result.h"

namespace gonio::driver {

struct Identity {
    DeviceStrings strings;
    Ident ident;
    Limits limits;
};

[[nodiscard]] Result<Identity> readIdentity(Transport& transport);

/// 1..32 printable characters, or an error that says so.
[[nodiscard]] Result<void> checkSerial(const DeviceStrings& strings);
/// "rig SIM-0042", as messages name it.
[[nodiscard]] std::string rigName(const DeviceStrings& strings);

/// A feature report, decoded.
template <class T>
[[nodiscard]] Result<T> readFeature(Transport& transport,
                                    ReportId id,
                                    Result<T> (*decode)(const Report&)) {
    const Result<Report> report = transport.getFeature(static_cast<std::uint8_t>(id));
    if (!report) return report.error();
    return decode(*report);
}

}  // namespace gonio::driver
