#pragma once
// A small TensorTable whose every number is chosen by hand: even normals, values that tell theta_i
// and channel.

#include "proc/table/tensor_table.h"

namespace gonio::test {

/// Isotropic, theta_i 0, 0.5, 1 radians; value 1 + theta_i + channel everywhere.
inline proc::TensorTable smallTensor() {
    const auto even = [](std::size_t slices, float value) {
        return proc::GridStack{
            .width = 3, .height = 2, .values = std::vector<float>(slices * 6, value)};
    };
    proc::TensorTable table;
    table.thetaIn = {0, 0.5F, 1};
    table.phiIn = {0};
    table.ndf = even(1, 2);
    table.sigma = even(1, 0.25F);
    table.vndf = even(3, 1);
    table.luminance = even(3, 1);
    table.channels = {{"R", {}}, {"G", {}}, {"B", {}}};
    table.values = {.width = 2, .height = 2, .values = {}};
    for (const float theta : table.thetaIn) {
        for (int channel = 0; channel < 3; ++channel) {
            for (int i = 0; i < 4; ++i) {
                table.values.values.push_back(1 + theta + static_cast<float>(channel));
            }
        }
    }
    return table;
}

}  // namespace gonio::test
