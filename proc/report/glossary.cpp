#include "proc/report/glossary.h"

namespace gonio::proc {

Facts glossary() {
    return {
        {"f, BRDF",
         "bidirectional reflectance distribution function: radiance sent to one direction over "
         "irradiance from another, in 1/sr. A perfect white diffuser has 1/pi = 0.318 / sr."},
        {"theta_i, theta_o", "angle of light and of view from the sample's normal, in degrees"},
        {"phi",
         "azimuth about the normal; the light stands at 0, its mirror direction at 180 "
         "degrees"},
        {"cell", "about one square degree of view; its f is the mean over its solid angle"},
        {"u", "standard uncertainty (k = 1), random and systematic parts combined in squares"},
        {"U, and what stands behind a plus-minus sign",
         "expanded uncertainty, U = 2 u (k = 2): an interval of about 95 % where the distribution "
         "is near a normal one. Values are rounded to what U allows."},
        {"random, systematic",
         "what averages out over cells, and what does not: the references, the LEDs, the lens "
         "map, the tilt"},
        {"reflectance",
         "directional-hemispherical: the integral of f cos(theta_o) over the "
         "hemisphere, without a unit, at most 1 for a passive surface"},
        {"chi-square",
         "mean of squared differences over squared uncertainties; 1 where the "
         "uncertainties explain them"},
        {"measured, reciprocity, interpolated, prior, model, extrapolated",
         "where an answer comes from: a cell; a cell with light and view exchanged; between "
         "incidences; a statistical prior; a fitted model; the nearest value"},
        {"saturated, below_noise, blocked, not_planned",
         "a cell that was too bright for every exposure; whose f is below twice its random "
         "uncertainty; that the optics hide; that was not asked for"},
        {"glare_corrected, tilt_corrected, drift_corrected",
         "a cell that was put right for stray light in the lens, for the sample's tilt, for the "
         "LEDs' drift"},
        {"missing", "without a value, which is never 0"},
    };
}

}  // namespace gonio::proc
