// What a row wants and what every row wants, held against what came out.

#include <algorithm>
#include <array>
#include <vector>

#include "tests/faults/measurement.h"

namespace gonio::fault_test {
namespace {

using sim::FaultKind;

/// What the driver counts exactly of what was done to its stream.
struct Law {
    const char* counter;
    std::vector<FaultKind> causes;
};
const std::array kLaws{
    Law{"emptyTransfers", {FaultKind::EmptyPacket}},
    Law{"badLengths", {FaultKind::ShortenChunk, FaultKind::LengthenChunk}},
    Law{"badHeaders", {FaultKind::FlipHeader}},
    Law{"badPayloads", {FaultKind::FlipPayload, FaultKind::BurstPayload}},
    Law{"badFrames", {}},
    Law{"contradictions", {}},
    Law{"lostChunks",
        {FaultKind::LoseChunk,
         FaultKind::FlipHeader,
         FaultKind::Overflow,
         FaultKind::StallBulk,
         FaultKind::BreakTransfer,
         FaultKind::SwapChunks}},
    Law{"disordered", {FaultKind::DuplicateChunk, FaultKind::SwapChunks}},
    Law{"duplicates", {FaultKind::DuplicateChunk}},
    Law{"unknownTypes", {FaultKind::UnknownChunk}},
    Law{"unknownReports", {FaultKind::UnknownReport}},
    Law{"badReports", {FaultKind::SpoilReport}},
    Law{"foreignAcks", {}},
    Law{"missedEvents", {}},
};

/// What a request may take (a second until it gives up) or a read beyond its wait, and a port
/// reset.
constexpr Nanoseconds kCall = std::chrono::milliseconds(1100);

int countOf(const Outcome& outcome, const std::string& name) {
    const auto found = outcome.counts.find(name);
    return found == outcome.counts.end() ? 0 : found->second;
}

bool holds(int seen, const WantedCount& wanted) {
    if (wanted.relation == "=") return seen == wanted.value;
    if (wanted.relation == "<=") return seen <= wanted.value;
    return seen >= wanted.value;
}

template <class T>
bool has(const std::vector<T>& all, const T& one) {
    return std::find(all.begin(), all.end(), one) != all.end();
}

std::string milliseconds(Nanoseconds time) {
    return std::to_string(std::chrono::duration<double, std::milli>(time).count()) + " ms";
}

/// The refusal is for what is malformed, and says so in one line.
void compareMalformed(const Row& row, const Outcome& outcome, std::vector<std::string>& list) {
    if (row.saysWhen.empty()) return;
    if (outcome.malformed.empty()) list.emplace_back("nothing was malformed");
    for (const std::string& name : outcome.malformed) {
        const auto wanted = row.saysWhen.find(name);
        if (wanted == row.saysWhen.end()) {
            list.push_back("what is said when " + name + "?");
        } else if (outcome.said.find(wanted->second) == std::string::npos) {
            list.push_back(name + ": nobody says " + wanted->second);
        }
    }
    if (outcome.said.find('\n') != std::string::npos) list.emplace_back("it says several lines");
}

/// Every frame that was kept is the undisturbed one's equal, and a measurement that says it is
/// complete has all.
void comparePictures(const Outcome& outcome,
                     const Pictures& wanted,
                     std::vector<std::string>& list) {
    for (const auto& [step, images] : outcome.pictures) {
        const auto twin = wanted.find(step);
        if (twin == wanted.end() || twin->second != images)
            list.push_back("step " + std::to_string(step) + " has another picture");
    }
    if (outcome.verdict == "completed" && outcome.pictures.size() != wanted.size())
        list.push_back(std::to_string(outcome.pictures.size()) + " steps are there");
}

void compareCounts(const Row& row, const Outcome& outcome, std::vector<std::string>& list) {
    for (const auto& [name, value] : outcome.counts) {
        if (!isCounter(name) && !name.starts_with("did ")) list.push_back("who is " + name + "?");
    }
    for (const WantedCount& count : row.counts) {
        if (!outcome.counts.contains(count.name)) list.push_back("nobody counts " + count.name);
        const int seen = countOf(outcome, count.name);
        if (!holds(seen, count))
            list.push_back(count.name + " is " + std::to_string(seen) + ", wanted " +
                           count.relation + " " + std::to_string(count.value));
    }
    for (const Law& law : kLaws) {
        int caused = 0;
        for (const FaultKind kind : law.causes)
            caused += countOf(outcome, "did " + std::string(sim::faultName(kind)));
        const int seen = countOf(outcome, law.counter);
        const auto waived = row.waived.find(law.counter);
        const int more = waived == row.waived.end() ? 0 : waived->second;
        if (seen == caused + more) continue;
        list.push_back(std::string(law.counter) + " is " + std::to_string(seen) + ", caused " +
                       std::to_string(caused) +
                       (more != 0 ? ", waived " + std::to_string(more) : ""));
    }
    for (const auto& [name, more] : row.waived) {
        const bool ofLaw =
            std::any_of(kLaws.begin(), kLaws.end(), [&, &name = name](const Law& law) {
                return name == law.counter;
            });
        if (!ofLaw) list.push_back("waived " + name + ", of which there is no law");
    }
}

}  // namespace

std::vector<std::string> complaints(const Row& row,
                                    const Outcome& outcome,
                                    const Pictures& undisturbed) {
    std::vector<std::string> list = outcome.troubles;
    const auto compareTime = [&](const char* what, Nanoseconds limit, Nanoseconds seen) {
        if (limit == Nanoseconds(0)) return;
        if (seen == Nanoseconds(0)) list.push_back(std::string("no time ") + what);
        if (seen > limit * outcome.slack) list.push_back(milliseconds(seen) + " " + what);
    };
    if (outcome.verdict != row.verdict)
        list.push_back("the verdict is " + outcome.verdict + ", wanted " + row.verdict);
    for (const std::string& text : row.says) {
        if (outcome.said.find(text) == std::string::npos) list.push_back("nobody says " + text);
    }
    for (const int code : row.events) {
        if (!has(outcome.events, code)) list.push_back("no event " + std::to_string(code));
    }
    compareMalformed(row, outcome, list);
    compareTime("from the pulled cable to the comeback", row.detected, outcome.detected);
    compareTime("from the plug to the claim", row.reclaimed, outcome.reclaimed);
    compareTime("from silence to reports opened anew", row.noticed, outcome.noticed);
    if (outcome.longestCall > kCall * outcome.slack)
        list.push_back("a call went on " + milliseconds(outcome.longestCall) + " past its wait");
    comparePictures(outcome, undisturbed, list);
    compareCounts(row, outcome, list);
    if (!list.empty() && !outcome.said.empty()) list.push_back("said: " + outcome.said);
    return list;
}

}  // namespace gonio::fault_test
