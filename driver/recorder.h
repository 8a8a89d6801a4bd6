#pragma once
// Writes all that passes between a host and its rig into a file (recording.h), opening after
// opening. A run is worth more than its record: when the file cannot be written any more, the
// record ends with its last whole call, one warning is given, and the rig goes on.

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "driver/file_lock.h"
#include "driver/recording.h"

namespace gonio::driver {

class Recorder {
public:
    /// A recording that is there already is continued, without a last record that a power cut has
    /// torn (a warning); an empty file is begun. A File error for any other file, which stays, and
    /// Busy for one that another recorder writes.
    [[nodiscard]] static Result<std::unique_ptr<Recorder>> open(const std::filesystem::path& file);

    /// One that failed as the one before it did is not told again.
    void add(const RecordedCall& call);
    /// It is written no more.
    [[nodiscard]] bool ended() const { return !file_.is_open(); }
    /// Why, where it has ended before its time.
    [[nodiscard]] const std::string& ending() const { return ending_; }

private:
    Recorder(std::filesystem::path path, FileLock lock)
        : path_(std::move(path)), lock_(std::move(lock)) {}
    [[nodiscard]] bool write();

    std::filesystem::path path_;
    FileLock lock_;
    std::ofstream file_;
    std::uint64_t bytes_ = 0;  ///< up to the last whole record
    std::vector<std::uint8_t> buffer_;
    std::string refusal_;  ///< of the last opening
    std::string ending_;
};

/// All that passes through it is recorded. Both are borrowed.
class RecordingTransport final : public Transport {
public:
    RecordingTransport(Transport& inner, Recorder& recorder);
    ~RecordingTransport() override;
    RecordingTransport(const RecordingTransport&) = delete;
    RecordingTransport& operator=(const RecordingTransport&) = delete;

    [[nodiscard]] DeviceStrings strings() const override { return inner_.strings(); }
    [[nodiscard]] const Clock& clock() const override { return inner_.clock(); }
    Result<void> write(const Report& report) override;
    Result<void> setFeature(const Report& report) override;
    [[nodiscard]] Result<Report> getFeature(std::uint8_t id) override;
    [[nodiscard]] Result<std::optional<Report>> readInput(Nanoseconds wait) override;
    [[nodiscard]] Result<std::optional<BulkBytes>> readBulk(Nanoseconds wait) override;
    Result<void> reopenReports() override;
    Result<void> resetPort() override;

private:
    template <class Ask>
    auto recorded(RecordedCall::Kind kind, BulkBytes sent, Ask ask);
    void note(const Report& report);
    template <class Bytes>
    void note(const std::optional<Bytes>& come);

    Transport& inner_;
    Recorder& recorder_;
    RecordedCall call_;  ///< its memory is used again
};

/// An opening that failed.
void recordRefusal(Recorder& recorder, const Error& error, Nanoseconds at);

}  // namespace gonio::driver
