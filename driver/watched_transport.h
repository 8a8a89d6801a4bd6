#pragma once
// The transport of a claimed rig, watched: is the rig still there (PROTOCOL.md 4)? A call that
// fails, and input reports that stay away for more than three periods of STATUS, make the link
// suspect; one probe (IDENT, a control transfer) decides. The rig answers as the boot it was: the
// failure stands for itself, and silent reports are opened anew, twice at most in a row. Else the
// rig is lost: its port is reset once, the transport is not touched any more, every call repeats
// the loss, and the clock stands still. attach() takes up another transport; the clock goes on and
// never back. Before watch() nothing is judged.

#include <cstdint>
#include <optional>

#include "driver/protocol/transport.h"

namespace gonio::driver {

class WatchedTransport : public Transport, private Clock {
public:
    /// `transport` is borrowed until it is lost.
    explicit WatchedTransport(Transport& transport) : target_(&transport) {}
    void attach(Transport& transport);
    /// From now on the rig answers as this boot, or is lost.
    void watch(std::uint32_t bootId);
    enum class Port {
        Reset,  ///< the rig hangs
        Leave
    };
    /// The link is suspect, as `seen` shows: a probe decides. Why the rig is lost; empty: it is
    /// there.
    std::optional<Error> suspect(const Error& seen);
    /// Lost, for a reason that the caller knows.
    Error lose(const Error& why, Port port);
    /// Lost: a STATUS shows another boot.
    Error loseToReboot(std::uint32_t bootId);
    [[nodiscard]] const std::optional<Error>& lost() const { return lost_; }
    /// How often the reports were opened anew.
    [[nodiscard]] std::uint32_t reopens() const { return reopens_; }

    [[nodiscard]] DeviceStrings strings() const override;
    [[nodiscard]] const Clock& clock() const override { return *this; }
    Result<void> write(const Report& report) override;
    Result<void> setFeature(const Report& report) override;
    [[nodiscard]] Result<Report> getFeature(std::uint8_t id) override;
    [[nodiscard]] Result<std::optional<Report>> readInput(Nanoseconds wait) override;
    /// Ends early, with nothing, when the reports must be looked at again.
    [[nodiscard]] Result<std::optional<BulkBytes>> readBulk(Nanoseconds wait) override;
    Result<void> reopenReports() override;
    Result<void> resetPort() override;

private:
    [[nodiscard]] Nanoseconds now() const override;
    /// What `call` answers; a failure is judged first.
    template <class Call>
    auto watched(Call call) -> decltype(call());
    struct Probe {
        bool answers = false;
        std::optional<std::uint32_t> bootId{};
    };
    [[nodiscard]] Probe probe();
    Result<void> reviveReports();

    Transport* target_;  ///< null: lost
    std::optional<std::uint32_t> bootId_;
    std::optional<Error> lost_;
    Nanoseconds offset_{0};  ///< added to the target's clock
    Nanoseconds stopped_{0};
    Nanoseconds heard_{0};  ///< when the last input report came, or could come again
    int silences_ = 0;      ///< reopened since a report came
    std::uint32_t reopens_ = 0;
};

}  // namespace gonio::driver
