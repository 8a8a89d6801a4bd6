#pragma once
// Light that leaks in between sample and rig, from a dark frame over the sample: the mean of the
// pixels inside the lens's field, which it reaches, minus that of those outside, which no light
// reaches. Hot pixels count: they are as many on both sides, and what leaks in can make all of the
// field look like them. Dark frames take it off every measurement, so that a steady little does no
// harm; what changes while a sample is captured stays in f.
//
// It is held against what f = 1e-3 sends there. With g = (S_w - S_b) / (f_w - f_b) the signal per f
// of a cell (two_point.h), a pixel at theta_o shows g f cos(theta_o) dOmega/dA, so that the field's
// pixels together show the sum over cells of g f cos(theta_o) Omega.

#include <optional>

#include "proc/calibrate/two_point.h"
#include "proc/optics/lens_map.h"
#include "proc/quality/limits.h"
#include "proc/radiance/dark.h"

namespace gonio::proc {

struct AmbientLight {
    double perSecond = 0;  ///< electrons per second in all of the field; noise can make it negative
    double u = 0;          ///< its standard uncertainty: noise of pixels and columns
};
/// Empty where the window shows no field, or nothing but the field. The 3 degrees around `field`
/// count as neither.
[[nodiscard]] std::optional<AmbientLight> ambientLight(const DarkFrame& dark,
                                                       const LensMap& lens,
                                                       Radians field,
                                                       const SensorNoise& noise);

/// Electrons per second and unit of f in all of the field, under one LED and band; `wi` as in
/// calibrate(). Empty where nothing of it was measured.
[[nodiscard]] std::optional<double> fieldSignal(const References& references,
                                                const Direction& wi,
                                                Band band);

/// `ambient`: `perF` is the field signal of the dimmest state.
[[nodiscard]] Verdict ambientVerdict(const std::optional<AmbientLight>& light,
                                     const std::optional<double>& perF,
                                     const QualityLimits& limits = {});

}  // namespace gonio::proc
