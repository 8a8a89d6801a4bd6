#include "proc/export/cosine.h"

#include <cmath>
#include <limits>

namespace gonio::proc {
namespace {

class Change {
public:
    explicit Change(bool divides) : divides_(divides) {}

    void apply(double& value, const Direction& wo) {
        const double cosine = std::abs(wo.z());
        if (divides_ && cosine < kCosineFloor) {
            if (!std::isnan(value) && value != 0) ++lost_;
            value = std::numeric_limits<double>::quiet_NaN();
        } else {
            value = divides_ ? value / cosine : value * cosine;
        }
    }
    [[nodiscard]] std::size_t lost() const { return lost_; }

private:
    bool divides_;
    std::size_t lost_ = 0;
};

void apply(Change& change, BrdfRows& rows) {
    const std::size_t channels = rows.channels.size();
    Change ofUncertainties = change;  // what is lost is counted once
    for (std::vector<double>* values : {&rows.f, &rows.uRandom, &rows.uSystematic}) {
        Change& one = values == &rows.f ? change : ofUncertainties;
        for (std::size_t i = 0; i < values->size(); ++i) {
            one.apply((*values)[i], rows.pairs[i / channels].out);
        }
    }
}

void apply(Change& change, SphericalTable& table) {
    for (SphericalBlock& block : table.blocks) {
        for (std::size_t a = 0; a < block.azimuthDeg.size(); ++a) {
            for (std::size_t t = 0; t < block.thetaDeg.size(); ++t) {
                change.apply(block.f[block.index(a, t)], table.pairAt(block, a, t).out);
            }
        }
    }
}

void apply(Change& change, SpecularTable& table) {
    for (TableNode n; n.rotation < table.rotationDeg.size(); ++n.rotation) {
        for (n.incidence = 0; n.incidence < table.incidenceDeg.size(); ++n.incidence) {
            for (n.azimuth = 0; n.azimuth < table.azimuthDeg.size(); ++n.azimuth) {
                for (n.radial = 0; n.radial < table.radialDeg.size(); ++n.radial) {
                    if (!table.canHoldData(n)) continue;
                    const Direction wo = table.pairAt(n).out;
                    for (TablePlane& plane : table.planes) {
                        change.apply(plane.f[table.index(n)], wo);
                    }
                }
            }
        }
    }
}

bool mayHold(const BrdfFile& file) {
    return file.format != Format::Utia && file.format != Format::Mbsdf &&
           (file.as<BrdfRows>() != nullptr || file.as<SphericalTable>() != nullptr ||
            file.as<SpecularTable>() != nullptr);
}

}  // namespace

Result<BrdfFile> withCosineTold(BrdfFile file, bool holds) {
    if (!mayHold(file)) {
        return Error{ErrorKind::Usage,
                     "--cosine: a " + std::string(factsOf(file.format).title) +
                         " says for good what its values are"};
    }
    const bool divided = file.about.at(key::kCosine) == "yes";
    if (divided == holds) return file;
    Change change(holds);
    if (auto* rows = std::get_if<BrdfRows>(&file.content)) apply(change, *rows);
    if (auto* table = std::get_if<SphericalTable>(&file.content)) apply(change, *table);
    if (auto* table = std::get_if<SpecularTable>(&file.content)) apply(change, *table);
    file.about.set(key::kCosine, holds ? "yes" : "no");
    if (change.lost() > 0) {
        file.warnings.push_back(std::to_string(change.lost()) +
                                " values too close to the horizon to be divided by the cosine");
    }
    return file;
}

}  // namespace gonio::proc
