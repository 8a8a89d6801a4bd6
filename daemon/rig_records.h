#pragma once
// The files of what was found out about a rig: flat field (EXR), LED monitor and sensor (JSON),
// dark library (EXR). `name` stands in errors; what cannot be read is a File error that says what
// to run.

#include <memory>
#include <string>
#include <string_view>

#include "daemon/rig_sweeps.h"
#include "proc/radiance/dark.h"
#include "proc/radiance/flat_field.h"
#include "proc/radiance/led_monitor.h"

namespace gonio::daemon {

[[nodiscard]] Result<std::string> encodeFlat(const proc::FlatField& flat);
[[nodiscard]] Result<std::shared_ptr<const proc::FlatField>> decodeFlat(std::string_view bytes,
                                                                        const std::string& name);

[[nodiscard]] std::string encodeLeds(const proc::LedMonitor& leds);
[[nodiscard]] Result<proc::LedMonitor> decodeLeds(std::string_view text, const std::string& name);

[[nodiscard]] std::string encodeSensor(const SensorRecord& sensor);
/// Without its sweep.
[[nodiscard]] Result<SensorRecord> decodeSensor(std::string_view text, const std::string& name);

/// One part for each exposure.
[[nodiscard]] Result<std::string> encodeDarks(std::span<const proc::DarkFrame> darks);
[[nodiscard]] Result<std::vector<proc::DarkFrame>> decodeDarks(std::string_view bytes,
                                                               const std::string& name);

}  // namespace gonio::daemon
