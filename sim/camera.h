#pragma once
// The camera over the stage: what an exposure of these settings shows of what is placed, with LEDs
// whose output is so much of nominal. The light of an LED on a placement is worked out once for
// each view, at the first exposure that needs it.

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "sim/exposing.h"
#include "sim/optics.h"
#include "sim/reference_errors.h"
#include "sim/sensor.h"
#include "sim/stage.h"

namespace gonio::sim {

class Camera {
public:
    Camera(const std::string& serial, ReferenceErrors errors, double sensorCelsius);

    void place(Placement placement);
    [[nodiscard]] Image<std::uint16_t> expose(const Settings& settings,
                                              const LedBands& output,
                                              const Format& format,
                                              const NoiseKey& key);

private:
    [[nodiscard]] const RateImages& rates(int led, const View& view);

    ReferenceErrors errors_;
    Optics optics_;
    Sensor sensor_;
    Placement placement_;
    std::optional<FieldOfView> field_;  // of the view that was last looked at
    std::map<int, RateImages> rates_;   // per LED, of the placement and of field_
};

}  // namespace gonio::sim
