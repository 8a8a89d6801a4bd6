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
    for (const WantedCount& count : row.counts) {
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
        if (seen != caused && !has(row.waived, std::string(law.counter)))
            list.push_back(std::string(law.counter) + " is " + std::to_string(seen) + ", caused " +
                           std::to_string(caused));
    }
}

}  // namespace

std::vector<std::string> complaints(const Row& row,
                                    const Outcome& outcome,
                                    const Pictures& undisturbed) {
    std::vector<std::string> list = outcome.troubles;
    if (outcome.verdict != row.verdict)
        list.push_back("the verdict is " + outcome.verdict + ", wanted " + row.verdict);
    for (const std::string& text : row.says) {
        if (outcome.said.find(text) == std::string::npos) list.push_back("nobody says " + text);
    }
    for (const int code : row.events) {
        if (!has(outcome.events, code)) list.push_back("no event " + std::to_string(code));
    }
    if (row.detected > Nanoseconds(0) && outcome.detected > row.detected)
        list.push_back("the loss was seen after " +
                       std::to_string(outcome.detected.count() / 1'000'000) + " ms");
    comparePictures(outcome, undisturbed, list);
    compareCounts(row, outcome, list);
    if (!list.empty() && !outcome.said.empty()) list.push_back("said: " + outcome.said);
    return list;
}

}  // namespace gonio::fault_test
