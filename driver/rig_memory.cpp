// What memory a rig's captures need, and that it is there before they are armed.

#include <algorithm>

#include "driver/rig.h"

namespace gonio::driver {
namespace {

// Frames that frame RAM must hold to overlap captures: the last one, that it can be sent again, the
// next one, and the one that is exposed meanwhile.
constexpr int kFramesToOverlap = 3;

}  // namespace

/// A capture of so many frames of the present window, not numbered yet.
ExpectedCapture Rig::sized(int frames) const {
    return {.bootId = link_->ident().bootId,
            .captureId = 0,
            .frames = frames,
            .frameBytes = geometry_->frameBytes,
            .maxChunkPayload = link_->ident().maxChunkPayload,
            .held = framesHeld()};
}

/// So many may come while a frame is asked for twice: RESEND queues behind what waits in the rig,
/// which is at most what its RAM holds.
int Rig::framesHeld() const { return 2 * link_->ident().frameRam + 2; }

/// There is memory for the frames of both together. With a sink it waits already: none is made
/// while frames are on their way.
bool Rig::mayArmAhead(const Making& making) const {
    if (!making.ahead.next || !making.request.keepLit) return false;
    if (link_->ident().frameRam < kFramesToOverlap) return false;
    const int frames = making.request.frames, next = making.ahead.next->frames;
    const auto held = static_cast<std::size_t>(std::min(frames, framesHeld())) +
                      static_cast<std::size_t>(std::min(next, framesHeld()));
    if (held > CaptureFrames::kMaxOpenBytes / geometry_->frameBytes) return false;
    if (!making.sink) return true;
    const MemoryNeed need = needed(making.request, making.ahead, true);
    return assembler_.hasRoomForNext(need.largest, need.wire) &&
           pixels_.most(geometry_->window.sent()) >= need.pixels && progress_.hasRoom(next);
}

/// Without a sink all frames are kept. What would need too much is refused when it is expected.
Rig::MemoryNeed Rig::needed(const CaptureRequest& request, const ArmAhead& ahead, bool sink) const {
    const int frames = request.frames, next = ahead.next ? ahead.next->frames : 0;
    const auto held = [&](int n) { return static_cast<std::size_t>(std::min(n, framesHeld())); };
    const auto kept = [&](int n) { return sink ? held(n) : static_cast<std::size_t>(n); };
    const std::size_t limit = CaptureFrames::kMaxOpenBytes;
    const std::size_t pixelBytes = geometry_->window.sent().pixels() * sizeof(std::uint16_t);
    // Frames of the present capture are read as they become whole: beside all of the next, two are
    // on their way. What a sink leaves of the present is the next's.
    const std::size_t wire = std::max(held(frames), held(next)) + 2;
    const std::size_t pixels =
        sink ? std::max(kept(frames), kept(next)) : kept(frames) + kept(next);
    return {.largest = sized(std::max(frames, next)),
            .wire = std::min(wire, limit / geometry_->frameBytes),
            .pixels = std::min(pixels, limit / pixelBytes)};
}

/// Of a capture that is on its way already, what a sink has kept is replaced, and no more is made;
/// without a sink there must be as many new frames as are asked for.
void Rig::provideMemory(const CaptureRequest& request, const ArmAhead& ahead, bool sink) {
    const MemoryNeed need = needed(request, ahead, sink);
    const Size size = geometry_->window.sent();
    if (ahead_ && sink) return pixels_.provide(size, std::min(need.pixels, pixels_.most(size)));
    if (!ahead_) {
        assembler_.makeRoom(need.largest);
        progress_.makeRoom(need.largest.frames);
    }
    assembler_.provide(geometry_->frameBytes, need.wire);
    pixels_.provide(size, need.pixels);
}

}  // namespace gonio::driver
