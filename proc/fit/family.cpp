#include "proc/fit/family.h"

#include <algorithm>

#include "proc/core/number_text.h"
#include "proc/fit/family_kernel.h"
#include "proc/models/spec_parameters.h"

namespace gonio::proc {
namespace {

std::string bandText(const LedBands& value, BandCount bands) {
    const std::string first = shortest(value[Band::R]);
    if (bands == BandCount::One) return first;
    return first + "/" + shortest(value[Band::G]) + "/" + shortest(value[Band::B]);
}

}  // namespace

Family::Family(std::string name,
               std::vector<FamilyLobe> lobes,
               std::vector<FamilyParameter> parameters)
    : name_(std::move(name)), lobes_(std::move(lobes)), parameters_(std::move(parameters)) {
    sharedCount_ = static_cast<std::size_t>(
        std::count_if(parameters_.begin(), parameters_.end(), [](const FamilyParameter& p) {
            return !p.perBand;
        }));
}

std::string Family::fullName(const FamilyParameter& parameter) const {
    const std::string name(parameter.name);
    if (lobes_.size() == 1) return name;
    const std::string_view lobe = lobes_[parameter.lobe].name;
    const auto same = std::count_if(
        lobes_.begin(), lobes_.end(), [&](const FamilyLobe& one) { return one.name == lobe; });
    const std::string number = same > 1 ? std::to_string(parameter.lobe) : "";
    return std::string(lobe) + number + "." + name;
}

std::string Family::spec(const FamilyPoint& point, BandCount bands) const {
    std::string text;
    for (std::size_t lobe = 0; lobe < lobes_.size(); ++lobe) {
        text += (lobe > 0 ? "+" : "") + std::string(lobes_[lobe].name);
        if (!lobes_[lobe].extra.empty()) text += "," + std::string(lobes_[lobe].extra);
        for (std::size_t i = 0; i < parameters_.size(); ++i) {
            const FamilyParameter& p = parameters_[i];
            if (p.lobe != lobe) continue;
            text += "," + std::string(p.name) + "=" +
                    (p.perBand ? bandText(point.perBand[i - sharedCount_], bands)
                               : shortest(point.shared[i]));
        }
    }
    return text;
}

const std::vector<std::unique_ptr<const Family>>& families() {
    static const FamilyList all = [] {
        FamilyList list;
        addDiffuseFamilies(list);
        addCosineFamilies(list);
        addSlopeFamilies(list);
        addMicrofacetFamilies(list);
        std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) {
            return a->parameterCount(3) < b->parameterCount(3);
        });
        return list;
    }();
    return all;
}

Result<const Family*> familyNamed(std::string_view name) {
    std::string list;
    for (const auto& family : families()) {
        if (family->name() == name) return family.get();
        list += (list.empty() ? "" : ", ") + family->name();
    }
    return Error{ErrorKind::Usage,
                 "fit: unknown family '" + std::string(name) + "'; known are " + list + ", all"};
}

Result<std::vector<const Family*>> familiesNamed(std::string_view list) {
    std::vector<const Family*> chosen;
    if (list == "all") {
        for (const auto& family : families()) chosen.push_back(family.get());
        return chosen;
    }
    for (const std::string_view name : split(list, ',')) {
        const Result<const Family*> family = familyNamed(name);
        if (!family) return family.error();
        if (std::find(chosen.begin(), chosen.end(), *family) == chosen.end()) {
            chosen.push_back(*family);
        }
    }
    return chosen;
}

}  // namespace gonio::proc
