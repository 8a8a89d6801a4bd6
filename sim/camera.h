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
#include "sim/sensor.h"
#include "sim/stage.h"

namespace gonio::sim {

/// What is of the moment of an exposure.
struct Moment {
    LedBands output = LedBands::all(1);  ///< of the lit LED, relative to nominal
    Nanoseconds sincePlaced{0};          ///< on the photometric clock
};

class Camera {
public:
    Camera(const std::string& serial, const Flaws& flaws);

    void place(Placement placement);
    /// Lasts by the rig's exposure offset longer than what is granted.
    [[nodiscard]] Image<std::uint16_t> expose(const Settings& settings,
                                              const Moment& moment,
                                              const Format& format,
                                              const NoiseKey& key);

private:
    void look(const View& view);
    [[nodiscard]] const LedLight& light(int led);
    [[nodiscard]] LedLight lightWithGlare(int led);
    [[nodiscard]] bool leaks() const { return placement_.errors.ambient > 0; }
    [[nodiscard]] Image<float> sumOfLight(const Settings& settings, const Moment& moment);

    Flaws flaws_;
    Optics optics_;
    Sensor sensor_;
    Placement placement_;
    std::optional<FieldOfView> field_;  // of the view that was last looked at
    std::optional<FieldOfView> whole_;  // of the whole sensor, where glare comes from
    std::map<int, LedLight> lights_;    // per LED, of the placement and of field_
};

}  // namespace gonio::sim
