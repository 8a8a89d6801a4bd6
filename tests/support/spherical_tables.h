#pragma once
// Spherical tables of a function of two directions, for look-ups and for the formats that hold such
// tables.

#include <cmath>
#include <cstddef>
#include <vector>

#include "proc/table/spherical_table.h"

namespace gonio::test {

/// first, first + step, ... up to last.
inline std::vector<double> steps(double first, double last, double step) {
    std::vector<double> axis;
    for (int i = 0; first + i * step <= last + 1e-9; ++i) axis.push_back(first + i * step);
    return axis;
}

struct SphericalShape {
    std::vector<proc::Channel> channels{proc::Channel{}};
    double mirrorAzimuthDeg = 180;
    bool planeSymmetrical = false;
    std::vector<double> lightAzimuthDeg{0}, incidenceDeg{0, 20, 40, 60};
    std::vector<double> azimuthDeg = steps(0, 360, 10), thetaDeg = steps(0, 90, 5);
    bool transmission = false;  ///< thetaDeg then runs from 90 to 180
};

/// f = value(pair, channel) at every node; wo at the horizon counts as above it.
template <class Value>
proc::SphericalTable sphericalTable(const SphericalShape& shape, const Value& value) {
    proc::SphericalTable table{.channels = shape.channels,
                               .mirrorAzimuthDeg = shape.mirrorAzimuthDeg,
                               .planeSymmetrical = shape.planeSymmetrical,
                               .blocks = {}};
    for (std::size_t channel = 0; channel < shape.channels.size(); ++channel) {
        for (const double light : shape.lightAzimuthDeg) {
            for (const double incidence : shape.incidenceDeg) {
                proc::SphericalBlock block{.channel = channel,
                                           .lightAzimuthDeg = light,
                                           .incidenceDeg = incidence,
                                           .transmission = shape.transmission,
                                           .azimuthDeg = shape.azimuthDeg,
                                           .thetaDeg = shape.thetaDeg,
                                           .f = {}};
                for (std::size_t a = 0; a < block.azimuthDeg.size(); ++a) {
                    for (std::size_t t = 0; t < block.thetaDeg.size(); ++t) {
                        block.f.push_back(value(table.pairAt(block, a, t), channel));
                    }
                }
                table.blocks.push_back(std::move(block));
            }
        }
    }
    return table;
}

/// A lobe of half-width `width` about the mirror direction of wi: f of 1 at its peak.
inline double mirrorLobe(const LightView& pair, double widthDeg) {
    const double off = angleBetween({.in = mirrorOf(pair.in), .out = pair.out}).degrees();
    return std::exp(-off * off / (widthDeg * widthDeg));
}

/// Larger to the left of the plane of incidence (wi x n) than to the right, and asymmetric forward
/// and back: what a mirrored, turned or reversed azimuth changes.
inline double handedValue(const LightView& pair) {
    const double side = pair.in.x() * pair.out.y() - pair.in.y() * pair.out.x();
    const double forward = -(pair.in.x() * pair.out.x() + pair.in.y() * pair.out.y());
    return 1 + 0.5 * side + 0.25 * forward + 0.1 * pair.out.z();
}

}  // namespace gonio::test
