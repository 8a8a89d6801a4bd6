#pragma once
// A sum of lobes: f is the sum of the parts' f.

#include <memory>
#include <vector>

#include "proc/core/scatterer.h"

namespace gonio::proc {

class Sum : public Scatterer {
public:
    /// At least one part.
    explicit Sum(std::vector<std::unique_ptr<const Scatterer>> parts) : parts_(std::move(parts)) {}
    /// None where any part answers none; its flags are joined.
    [[nodiscard]] Answer answer(const LightView& pair) const override;

private:
    std::vector<std::unique_ptr<const Scatterer>> parts_;
};

}  // namespace gonio::proc
