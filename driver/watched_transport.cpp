#include "driver/watched_transport.h"

#include <algorithm>
#include <string>

#include "driver/identity.h"

namespace gonio::driver {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kSilence = 300ms;  // 3 periods of STATUS; PROTOCOL.md 4
constexpr Nanoseconds kLook = 100ms;     // so often are reports looked at while chunks are awaited
constexpr int kReopens = 2;              // in a row

}  // namespace

void WatchedTransport::attach(Transport& transport) {
    const Nanoseconds before = now();
    target_ = &transport;
    lost_.reset();
    bootId_.reset();
    offset_ = std::max(Nanoseconds{0}, before - transport.clock().now());
}

void WatchedTransport::watch(std::uint32_t bootId) {
    bootId_ = bootId;
    heard_ = now();
    silences_ = 0;
}

Error WatchedTransport::lose(const Error& why, Port port) {
    if (lost_) return *lost_;
    if (port == Port::Reset) (void)target_->resetPort();
    stopped_ = now();
    target_ = nullptr;
    lost_ = why;
    return why;
}

Nanoseconds WatchedTransport::now() const {
    return target_ ? target_->clock().now() + offset_ : stopped_;
}

DeviceStrings WatchedTransport::strings() const {
    return target_ ? target_->strings() : DeviceStrings{};
}

WatchedTransport::Probe WatchedTransport::probe() {
    const auto report = target_->getFeature(static_cast<std::uint8_t>(ReportId::Ident));
    if (!report) return {};
    const Result<Ident> ident = decodeIdent(*report);
    if (!ident) return {.answers = true};  // damaged, but an answer
    return {.answers = true, .bootId = ident->bootId};
}

std::optional<Error> WatchedTransport::suspect(const Error& seen) {
    if (lost_) return lost_;
    const Probe probed = probe();
    if (!probed.answers) return lose(seen, Port::Reset);
    if (!probed.bootId || probed.bootId == bootId_) return std::nullopt;
    return loseToReboot(*probed.bootId);
}

Error WatchedTransport::loseToReboot(std::uint32_t bootId) {
    const std::string was = bootId_ ? std::to_string(*bootId_) : "another";
    return lose({ErrorKind::Device,
                 rigName(strings()) + " has rebooted: boot id " + std::to_string(bootId) +
                     ", was " + was + "; redo the bracket"},
                Port::Leave);
}

template <class Call>
auto WatchedTransport::watched(Call call) -> decltype(call()) {
    if (lost_) return *lost_;
    auto done = call();
    if (done || !bootId_) return done;
    const Error seen = done.error();
    return suspect(seen).value_or(seen);
}

/// A rig that answers while its reports stay away: they are opened anew.
Result<void> WatchedTransport::reviveReports() {
    const std::string rig = rigName(target_->strings());
    if (const auto why = suspect(
            {ErrorKind::Device, rig + ": no reports for 300 ms; check its cable and power"}))
        return *why;
    if (silences_ == kReopens) {
        const Error why{ErrorKind::Device, rig + " answers, but its reports stay silent"};
        return lose(why, Port::Reset);
    }
    ++silences_;
    ++reopens_;
    if (auto reopened = target_->reopenReports(); !reopened)
        return lose(reopened.error(), Port::Reset);
    heard_ = now();
    return {};
}

Result<std::optional<Report>> WatchedTransport::readInput(Nanoseconds wait) {
    const Nanoseconds deadline = now() + wait;
    while (true) {
        const Nanoseconds untilSilence = bootId_ ? heard_ + kSilence - now() : wait;
        const Nanoseconds step = std::max(Nanoseconds{0}, std::min(untilSilence, deadline - now()));
        auto report = watched([&] { return target_->readInput(step); });
        if (!report || !bootId_) return report;
        if (*report) {
            heard_ = now();
            silences_ = 0;
            return report;
        }
        if (now() - heard_ >= kSilence) {
            if (auto back = reviveReports(); !back) return back.error();
        }
        if (now() >= deadline) return report;
    }
}

Result<std::optional<BulkBytes>> WatchedTransport::readBulk(Nanoseconds wait) {
    return watched([&] { return target_->readBulk(std::min(wait, kLook)); });
}

Result<void> WatchedTransport::write(const Report& report) {
    return watched([&] { return target_->write(report); });
}

Result<void> WatchedTransport::setFeature(const Report& report) {
    return watched([&] { return target_->setFeature(report); });
}

Result<Report> WatchedTransport::getFeature(std::uint8_t id) {
    return watched([&] { return target_->getFeature(id); });
}

Result<void> WatchedTransport::reopenReports() {
    return watched([&] { return target_->reopenReports(); });
}

Result<void> WatchedTransport::resetPort() {
    return watched([&] { return target_->resetPort(); });
}

}  // namespace gonio::driver
