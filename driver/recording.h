#pragma once
// The file of all that passed between a host and its rig (docs/recording.md): a header, then one
// record per call of a transport, each with its length before it and its CRC-32C after it. What
// goes in: bytes of any origin. What comes out: calls, or a File error with the offset of the first
// byte that cannot be. Nothing larger than what is left of the file is ever allocated.

#include <array>
#include <cstdint>
#include <istream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "driver/protocol/transport.h"

namespace gonio::driver {

/// A call of a transport, as it was answered.
struct RecordedCall {
    enum class Kind : std::uint8_t {
        Open = 1,
        Close,
        Write,
        SetFeature,
        GetFeature,
        ReadInput,
        ReadBulk,
        ReopenReports = 9,
        ResetPort
    };
    enum class Outcome : std::uint8_t {
        Done,
        Nothing,  ///< the wait has passed
        Failed
    };
    Kind kind = Kind::Open;
    Outcome outcome = Outcome::Done;
    Nanoseconds begin{0}, end{0};    ///< on the transport's clock
    std::vector<std::uint8_t> sent;  ///< the report, or the id of one
    std::vector<std::uint8_t> got;   ///< the report, the transfer or the rig's strings
    Error error{};                   ///< Failed

    /// The host asked the rig for something; else it took what had come.
    [[nodiscard]] bool ofHost() const;
    bool operator==(const RecordedCall& other) const;
};

/// "write ARM, sequence 12" or "set feature 02", for a person.
[[nodiscard]] std::string describe(RecordedCall::Kind kind, std::span<const std::uint8_t> sent);
/// What was recorded and what was asked instead, with the bytes from the first that differs.
[[nodiscard]] std::string difference(const RecordedCall& wanted,
                                     RecordedCall::Kind kind,
                                     std::span<const std::uint8_t> sent);

[[nodiscard]] std::vector<std::uint8_t> encodeStrings(const DeviceStrings& strings);
[[nodiscard]] std::optional<DeviceStrings> decodeStrings(std::span<const std::uint8_t> bytes);

inline constexpr std::size_t kRecordingHeaderBytes = 16;
inline constexpr std::size_t kLongestRecord = std::size_t{64} << 20;  ///< no transfer is as long
[[nodiscard]] std::array<std::uint8_t, kRecordingHeaderBytes> recordingHeader();
/// Puts a whole record at the end of `bytes`.
void appendRecord(std::vector<std::uint8_t>& bytes, const RecordedCall& call);

class RecordingReader {
public:
    /// A File error for what is no recording. `bytes` is the size of the file.
    [[nodiscard]] static Result<RecordingReader> open(std::unique_ptr<std::istream> file,
                                                      std::uint64_t bytes);
    /// Nothing at the end.
    [[nodiscard]] Result<std::optional<RecordedCall>> next();
    /// Of the record that next() reads, from 1.
    [[nodiscard]] std::uint64_t number() const { return number_; }
    /// Where the record begins that next() read, or could not read.
    [[nodiscard]] std::uint64_t begin() const { return begin_; }

private:
    RecordingReader(std::unique_ptr<std::istream> file, std::uint64_t bytes)
        : file_(std::move(file)), bytes_(bytes) {}
    [[nodiscard]] bool read(std::span<std::uint8_t> into);
    [[nodiscard]] Error damaged(std::uint64_t at, const std::string& what) const;

    std::unique_ptr<std::istream> file_;
    std::uint64_t bytes_ = 0, at_ = 0, begin_ = 0, number_ = 1;
    std::vector<std::uint8_t> body_;
};

}  // namespace gonio::driver
