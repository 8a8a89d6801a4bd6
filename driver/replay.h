#pragma once
// Plays a recording (recording.h) back, as the rig that it was made of. What the host asks must be
// what it asked then: the first difference is a Device error that names the record, what was wanted
// and what was seen, and so is every call after it. What the rig sent waits until the host reads
// it. The clock is that of the recording, and stands where the host's next request is due; a wait
// for what never came lets it run on. After the last opening: NoRig. After a difference no opening
// is given any more.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <istream>
#include <memory>
#include <optional>
#include <vector>

#include "driver/recording.h"

namespace gonio::driver {

class Replay {
public:
    /// The whole recording is read once; a File error for one that is cut off or damaged.
    [[nodiscard]] static Result<std::unique_ptr<Replay>> open(const std::filesystem::path& file);
    /// The same from anywhere: `source` opens it anew.
    [[nodiscard]] static Result<std::unique_ptr<Replay>> open(
        const std::function<std::unique_ptr<std::istream>()>& source, std::uint64_t bytes);

    /// The next opening, as it went: a transport, or why there was none. One at a time; it must not
    /// outlive this.
    [[nodiscard]] Result<std::unique_ptr<Transport>> openRig();
    /// The session that the host claimed then, in the opening that openRig() gave last.
    [[nodiscard]] std::optional<std::uint64_t> session() const;
    /// The plan step of the ARM that comes next, in this opening or a later one; empty: none does.
    [[nodiscard]] std::optional<std::uint64_t> nextPlanStep() const;
    /// Why nothing will come any more: the first difference, or that the recording is over. Empty:
    /// there is more.
    [[nodiscard]] std::optional<Error> end() const;
    /// Of the first rig; empty when none was ever there.
    [[nodiscard]] const std::string& serial() const { return serial_; }

private:
    class PlayedTransport;
    explicit Replay(RecordingReader reader) : reader_(std::move(reader)) {}
    Result<void> readThrough(RecordingReader reader);
    [[nodiscard]] const RecordedCall* ahead() const { return ahead_ ? &*ahead_ : nullptr; }
    Result<void> advance();
    void notePlanStep(const RecordedCall& call, std::uint64_t number);

    RecordingReader reader_;
    std::optional<RecordedCall> ahead_;
    std::uint64_t number_ = 0;                            ///< of `ahead_`
    std::vector<std::optional<std::uint64_t>> sessions_;  ///< by opening that succeeded
    struct ArmedStep {
        std::uint64_t number = 0, planStep = 0;
    };
    std::vector<ArmedStep> arms_;  ///< by record
    std::optional<Error> diverged_;
    std::size_t opened_ = 0;
    std::string serial_;
};

}  // namespace gonio::driver
