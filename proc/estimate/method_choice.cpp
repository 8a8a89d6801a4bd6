#include "proc/estimate/method_choice.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>

namespace gonio::proc {
namespace {

using Method = std::shared_ptr<const IncidenceMethod>;

/// What a candidate is made from.
struct View {
    const BrdfData& data;
    const std::vector<bool>& groups;
    std::optional<std::size_t> without;  ///< the incidence that is left out
    bool whole;                          ///< no row of the others is left out
    const Carriers& carriers;
    const SamplePrior* prior;
};

struct Candidate {
    std::string name;
    std::function<Method(const View&)> make;  ///< null where it cannot be made
};

Candidate ofSheets(const SheetMethodOptions& options) {
    return {options.name, [options](const View& view) -> Method {
                return sheetMethod(view.data, view.groups, options);
            }};
}

void addFixed(std::vector<Candidate>& list) {
    list.push_back(ofSheets({.name = "specular-linear"}));
    list.push_back(ofSheets({.name = "specular-log", .quantity = SheetQuantity::LogF}));
    list.push_back(ofSheets({.name = "direction-cosine",
                             .frame = IncidenceFrame::DirectionCosine,
                             .quantity = SheetQuantity::LogF}));
    list.push_back(ofSheets({.name = "half-vector",
                             .frame = IncidenceFrame::HalfVector,
                             .quantity = SheetQuantity::LogFCosines}));
    list.push_back(ofSheets({.name = "catmull-rom",
                             .quantity = SheetQuantity::LogF,
                             .curve = IncidenceCurve::CatmullRom}));
}

Candidate carried(const std::string& family) {
    const std::string name = "carried:" + family;
    return {name, [name, family](const View& view) -> Method {
                const auto found = view.carriers.find(family);
                if (found == view.carriers.end()) return nullptr;
                return sheetMethod(view.data,
                                   view.groups,
                                   {.name = name,
                                    .frame = IncidenceFrame::HalfVector,
                                    .quantity = SheetQuantity::RatioToModel,
                                    .carrier = found->second});
            }};
}

void addOfFamily(std::vector<Candidate>& list, const std::string& family) {
    list.push_back({"model:" + family, [family](const View& view) -> Method {
                        const auto found = view.carriers.find(family);
                        if (found == view.carriers.end()) return nullptr;
                        return modelMethod(found->second);
                    }});
    list.push_back(carried(family));
}

const std::vector<Candidate>& candidates() {
    static const std::vector<Candidate> all = [] {
        std::vector<Candidate> list;
        addFixed(list);
        for (const std::string& family : carrierFamilies()) addOfFamily(list, family);
        list.push_back({"prior", [](const View& view) -> Method {
                            if (view.prior == nullptr || !view.prior->passes()) return nullptr;
                            return view.whole ? view.prior->method(view.without) : nullptr;
                        }});
        return list;
    }();
    return all;
}

/// Everything that is left out in turn, with the carriers of what is left.
class Trials {
public:
    Trials(const BrdfData& data,
           const ErrorScale& scale,
           const Carriers& all,
           const MethodChoiceOptions& options)
        : scale_(scale) {
        const std::size_t n = data.incidences.size();
        if (n < 3 || !options.learn) return;
        for (std::size_t g = 1; g + 1 < n; ++g) {
            add(between_, Trial::withoutIncidence(data, g, options.trial), all, options);
        }
        add(last_, Trial::withoutIncidence(data, n - 1, options.trial), all, options);
        auto edge = Trial::withoutEdge(data, options.trial);
        if (edge) add(edge_, std::move(*edge), all, options);
    }

    struct Errors {
        std::vector<ProbeError> between, last, edge;
        bool made = false;
        bool anchored = true;
    };
    [[nodiscard]] Errors errorsOf(const Candidate& candidate, const SamplePrior* prior) const {
        Errors errors;
        errors.made = !between_.empty();
        addErrors(errors.between, between_, candidate, prior, scale_, errors);
        if (errors.made) addErrors(errors.last, last_, candidate, prior, scale_, errors);
        bool made = errors.made;
        if (errors.made) addErrors(errors.edge, edge_, candidate, prior, scale_, errors);
        errors.made = made;  // a prior cannot be asked at the edge
        return errors;
    }

private:
    struct One {
        Trial trial;
        Carriers carriers;
    };

    static void add(std::vector<One>& list,
                    Trial trial,
                    const Carriers& all,
                    const MethodChoiceOptions& options) {
        CarrierFitOptions fit = options.fit;
        fit.startedAt = &all;
        Carriers carriers;
        if (!fit.families.empty()) carriers = fitCarriers(trial.seen(), trial.groups(), fit);
        list.push_back({std::move(trial), std::move(carriers)});
    }

    static void addErrors(std::vector<ProbeError>& to,
                          const std::vector<One>& trials,
                          const Candidate& candidate,
                          const SamplePrior* prior,
                          const ErrorScale& scale,
                          Errors& errors) {
        for (const One& one : trials) {
            const Method method = candidate.make({.data = one.trial.seen(),
                                                  .groups = one.trial.groups(),
                                                  .without = one.trial.without(),
                                                  .whole = one.trial.without().has_value(),
                                                  .carriers = one.carriers,
                                                  .prior = prior});
            errors.made = errors.made && method != nullptr;
            if (!method) return;
            errors.anchored = method->anchored();
            const std::vector<ProbeError> own = one.trial.errorsOf(*method, scale);
            const auto open = [](const ProbeError& error) { return std::isnan(error.off); };
            // What leaves a question open cannot be compared.
            errors.made = errors.made && std::none_of(own.begin(), own.end(), open);
            if (!errors.made) return;
            to.insert(to.end(), own.begin(), own.end());
        }
    }

    ErrorScale scale_;
    std::vector<One> between_, last_, edge_;
};

template <class Wanted>
double rootOf(const std::vector<ProbeError>& errors, const Wanted& wanted) {
    double sum = 0;
    double count = 0;
    for (const ProbeError& error : errors) {
        if (!wanted(error)) continue;
        sum += error.squared();
        ++count;
    }
    return count > 0 ? std::sqrt(std::max(0.0, sum) / count) : 0;
}

MethodScore scoreOf(const std::string& name, const Trials::Errors& errors) {
    const auto even = [](const ProbeError& error) { return error.even; };
    const auto lobe = [](const ProbeError& error) { return error.lobe; };
    MethodScore score{.name = name,
                      .hemisphere = rootOf(errors.between, even),
                      .lobe = rootOf(errors.between, lobe),
                      .beyond = {},
                      .anchored = errors.anchored};
    if (errors.last.empty()) return score;
    const double last = rootOf(errors.last, even);
    // Where the edge cannot be asked, as if it were as wrong.
    score.beyond = std::hypot(last, errors.edge.empty() ? last : rootOf(errors.edge, even));
    return score;
}

ErrorModel modelOf(const ErrorScale& scale, const Trials::Errors& errors) {
    ErrorModel model(scale, errors.anchored, errors.between);
    model.learnBeyondIncidence(errors.last);
    model.learnEdge(errors.edge);
    return model;
}

/// Indices of the scores, the least wrong first.
template <class WrongBy>
std::vector<std::size_t> ranked(const std::vector<MethodScore>& scores, const WrongBy& wrongBy) {
    std::vector<std::size_t> order(scores.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return wrongBy(scores[a]) < wrongBy(scores[b]);
    });
    return order;
}

/// Those that the methods which are asked need.
std::vector<std::string> familiesOf(const MethodChoiceOptions& options) {
    if (options.only.empty()) {
        return options.fit.families.empty() ? carrierFamilies() : options.fit.families;
    }
    const std::size_t colon = options.only.find(':');
    if (colon == std::string::npos) return {};
    return {options.only.substr(colon + 1)};
}

}  // namespace

std::vector<std::string> methodNames() {
    std::vector<std::string> names;
    for (const Candidate& candidate : candidates()) names.push_back(candidate.name);
    return names;
}

Result<Method> methodNamed(const std::string& name,
                           const BrdfData& data,
                           const Carriers& carriers,
                           const SamplePrior* prior) {
    const std::vector<bool> all(data.incidences.size(), true);
    for (const Candidate& candidate : candidates()) {
        if (candidate.name != name) continue;
        Method method = candidate.make({.data = data,
                                        .groups = all,
                                        .without = {},
                                        .whole = true,
                                        .carriers = carriers,
                                        .prior = prior});
        if (method) return method;
        return Error{ErrorKind::Usage,
                     "estimator '" + name + "' cannot be made of this sample: " +
                         (name == "prior" ? "it is unlike the prior's library"
                                          : "its model could not be fitted")};
    }
    std::string known;
    for (const std::string& one : methodNames()) known += (known.empty() ? "" : ", ") + one;
    return Error{ErrorKind::Usage, "unknown estimator '" + name + "'; known: " + known};
}

MethodChoice chooseMethod(const BrdfData& data,
                          const SamplePrior* prior,
                          const MethodChoiceOptions& options) {
    const std::vector<bool> all(data.incidences.size(), true);
    MethodChoice choice;
    MethodChoiceOptions how = options;
    how.fit.families = familiesOf(options);
    if (!how.fit.families.empty()) choice.carriers = fitCarriers(data, all, how.fit);
    const ErrorScale scale(data);
    const Trials trials(data, scale, choice.carriers, how);
    std::vector<Trials::Errors> errors;
    for (const Candidate& candidate : candidates()) {
        if (!options.only.empty() && candidate.name != options.only) continue;
        Trials::Errors own = trials.errorsOf(candidate, prior);
        if (!own.made) continue;
        choice.scores.push_back(scoreOf(candidate.name, own));
        errors.push_back(std::move(own));
    }
    const auto made = [&](const std::string& name) {
        auto method = methodNamed(name, data, choice.carriers, prior);
        return method ? *method : nullptr;
    };
    // What was fitted to a part of the data need not have been to all of it.
    const auto leastWrong = [&](const auto& wrongBy) {
        for (const std::size_t i : ranked(choice.scores, wrongBy)) {
            if (!std::isfinite(wrongBy(choice.scores[i]))) break;
            ChosenMethod one{made(choice.scores[i].name), modelOf(scale, errors[i]), true};
            if (one.method) return one;
        }
        return ChosenMethod{};
    };
    choice.between = leastWrong([](const MethodScore& score) { return score.between(); });
    constexpr double kNever = std::numeric_limits<double>::infinity();
    choice.anchored = leastWrong(
        [](const MethodScore& score) { return score.anchored ? score.between() : kNever; });
    choice.beyond =
        leastWrong([&](const MethodScore& score) { return score.beyond.value_or(kNever); });
    if (!choice.beyond.method) choice.beyond = choice.between;
    if (!choice.between.method) {
        const auto best = bestByChiSquare(data, choice.carriers);
        const std::string standard = best ? "carried:" + *best : "specular-log";
        choice.between.method = made(options.only.empty() ? standard : options.only);
        choice.beyond = choice.between;
    }
    std::stable_sort(
        choice.scores.begin(), choice.scores.end(), [](const MethodScore& a, const MethodScore& b) {
            return a.between() < b.between();
        });
    return choice;
}

}  // namespace gonio::proc
