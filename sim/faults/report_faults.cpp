#include "sim/faults/report_faults.h"

#include <algorithm>

#include "driver/protocol/crc.h"
#include "driver/protocol/wire.h"

namespace gonio::sim {
namespace {

using driver::Report;

driver::ReportId idOf(const Report& report) { return static_cast<driver::ReportId>(report[0]); }

Report unknownReport() {
    constexpr std::uint8_t kUnknown = 0x7E;
    constexpr std::size_t kCrcAt = driver::kReportBytes - 2;
    Report report{kUnknown};
    const auto crc = driver::crc16(std::span(report).first(kCrcAt));
    driver::put<std::uint16_t>(report, kCrcAt, crc);
    return report;
}

bool takeOne(int& counter) {
    if (counter == 0) return false;
    --counter;
    return true;
}

}  // namespace

bool ReportFaults::put(const DueFault& fault, Nanoseconds now) {
    switch (fault.kind) {
        case FaultKind::LoseAck: ++acksToLose_; return true;
        case FaultKind::DelayAck: delays_.push_back(fault.time); return true;
        case FaultKind::DropReport: toDrop_ += fault.count; return true;
        case FaultKind::SpoilReport: ++toSpoil_; return true;
        case FaultKind::UnknownReport: extra_.push_back(unknownReport()); return true;
        case FaultKind::StallReports:
            stalled_ = true;
            stalledUntil_ = std::max(stalledUntil_, now + fault.lasting);
            unheardSince_ = now;
            tally_.add(fault.kind);
            return true;
        case FaultKind::SilenceReports:
            silentUntil_ =
                std::max(silentUntil_,
                         fault.lasting > Nanoseconds(0) ? now + fault.lasting : Nanoseconds::max());
            unheardSince_ = now;
            tally_.add(fault.kind);
            return true;
        default: return false;
    }
}

void ReportFaults::opened(Nanoseconds now) {
    if (silentUntil_ == Nanoseconds::max()) silentUntil_ = Nanoseconds(0);
    if (unheardSince_) noticed_ = std::max(noticed_, now - *unheardSince_);
    unheardSince_.reset();
}

void ReportFaults::plugged() {
    if (silentUntil_ == Nanoseconds::max()) silentUntil_ = Nanoseconds(0);
    stalled_ = false;
    unheardSince_.reset();
}

void ReportFaults::clear() {
    held_.clear();
    extra_.clear();
    delays_.clear();
    acksToLose_ = toDrop_ = toSpoil_ = 0;
}

void ReportFaults::haltCleared(Nanoseconds now) {
    if (!stalled_) return;
    ++haltsCleared_;
    if (now < stalledUntil_) return;
    stalled_ = false;
    unheardSince_.reset();
}

void ReportFaults::lose(const Report& report) {
    statusesLost_ += idOf(report) == driver::ReportId::Status ? 1 : 0;
}

std::optional<Report> ReportFaults::next(Device& device) {
    const Nanoseconds now = device.now();
    while (now < silentUntil_) {
        const auto unheard = device.takeInput();
        if (!unheard) return std::nullopt;
        lose(*unheard);
    }
    if (!held_.empty() && held_.begin()->first <= now) {
        const Report report = held_.begin()->second;
        held_.erase(held_.begin());
        return report;
    }
    if (!extra_.empty()) {
        const Report report = extra_.front();
        extra_.pop_front();
        tally_.add(FaultKind::UnknownReport);
        return report;
    }
    while (auto report = device.takeInput()) {
        const bool ack = idOf(*report) == driver::ReportId::Ack;
        if (ack && takeOne(acksToLose_)) {
            tally_.add(FaultKind::LoseAck);
        } else if (ack && !delays_.empty()) {
            held_.emplace(now + delays_.front(), *report);
            delays_.pop_front();
            tally_.add(FaultKind::DelayAck);
        } else if (takeOne(toDrop_)) {
            lose(*report);
            tally_.add(FaultKind::DropReport);
        } else {
            if (takeOne(toSpoil_)) {
                (*report)[driver::kReportBytes / 2] ^= 1;
                tally_.add(FaultKind::SpoilReport);
            }
            return report;
        }
    }
    return std::nullopt;
}

Nanoseconds ReportFaults::nextEvent(Nanoseconds now) const {
    const auto next = held_.upper_bound(now);
    return next == held_.end() ? Nanoseconds::max() : next->first;
}

}  // namespace gonio::sim
