#pragma once
// The simulated rig as a USB device (PROTOCOL.md 1): descriptors, strings, control requests, the
// HID reports and the bulk stream with its packets. It answers requests and knows nothing of what
// carries them: a test bed or a USB/IP server does. Time is the device's own; who carries the
// requests lets it pass. Not for several threads at once.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "sim/device.h"
#include "sim/usb_descriptors.h"

namespace gonio::sim {

/// The eight bytes that begin a control transfer.
struct UsbSetup {
    std::uint8_t requestType = 0;
    std::uint8_t request = 0;
    std::uint16_t value = 0;
    std::uint16_t index = 0;
    std::uint16_t length = 0;
};

/// What a transfer ends with. A rig gives the first three; the bus can give them all.
enum class UsbAnswer {
    Done,
    Nak,  ///< nothing yet: ask again
    Stall,
    Error,     ///< of the bus: EPROTO
    Overflow,  ///< more came than there was room for
    Gone,      ///< ENODEV
    NoMemory   ///< the system has none for the transfer
};

struct UsbReply {
    UsbAnswer answer = UsbAnswer::Done;
    std::vector<std::uint8_t> data;  ///< IN only
};

class UsbDevice {
public:
    static constexpr std::uint8_t kHidInterface = usb::kHidInterface;
    static constexpr std::uint8_t kStreamInterface = usb::kStreamInterface;
    static constexpr std::uint8_t kBulkIn = usb::kBulkIn;

    using ChunkSource = std::function<std::optional<std::vector<std::uint8_t>>()>;

    explicit UsbDevice(DeviceConfig config, UsbIds ids = {});
    UsbDevice(const UsbDevice&) = delete;
    UsbDevice& operator=(const UsbDevice&) = delete;
    /// Chunks come from here and no longer from the device itself.
    void takeChunksFrom(ChunkSource source) { source_ = std::move(source); }
    /// Told when the stream was flushed, whoever did it.
    void onFlush(std::function<void()> flushed) { flushed_ = std::move(flushed); }

    [[nodiscard]] Device& device() { return device_; }
    [[nodiscard]] const Device& device() const { return device_; }
    /// A chunk is on its way, not all of it sent.
    [[nodiscard]] bool midChunk() const { return open_ || sent_ < sending_.size(); }
    [[nodiscard]] const UsbIds& ids() const { return ids_; }
    [[nodiscard]] std::vector<std::uint8_t> deviceDescriptor() const;
    [[nodiscard]] std::vector<std::uint8_t> configDescriptor() const;
    [[nodiscard]] CameraKind kind() const { return kind_; }
    [[nodiscard]] std::size_t bulkPacket() const { return cameraLink(kind_).bulkPacket; }

    /// `out` is the data stage of a request to the device.
    UsbReply control(const UsbSetup& setup, std::span<const std::uint8_t> out = {});
    /// One input report.
    UsbReply interruptIn();
    UsbReply interruptOut(std::span<const std::uint8_t> report);
    /// What a transfer of `length` bytes (a multiple of the packet) gets: it ends when it is full,
    /// or at a short packet. A chunk whose bytes fill whole packets is followed by an empty one.
    UsbReply bulkIn(std::size_t length);

    /// The bulk endpoint stalls until its halt is cleared.
    void haltStream() { halted_ = true; }
    enum class Loss {
        BusReset,
        Power  ///< of the bus: the cable was pulled
    };
    /// What was half sent is lost.
    void reset(Loss loss = Loss::BusReset);

private:
    UsbReply standard(const UsbSetup& setup);
    UsbReply hidClass(const UsbSetup& setup, std::span<const std::uint8_t> out);
    [[nodiscard]] std::optional<std::vector<std::uint8_t>> descriptor(const UsbSetup& setup) const;
    bool takeReport(std::span<const std::uint8_t> report);
    void dropHalfSent();

    ChunkSource source_;
    std::function<void()> flushed_;
    CameraKind kind_;
    Device device_;
    UsbIds ids_;
    std::uint8_t configuration_ = 1;
    bool halted_ = false;
    std::vector<std::uint8_t> sending_;  ///< the chunk on its way
    std::size_t sent_ = 0;               ///< of its bytes
    bool open_ = false;                  ///< its last packet was a full one: an empty one is due
};

}  // namespace gonio::sim
