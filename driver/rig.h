#pragma once
// A rig that takes frames. A frame that it returns is valid in the sense of PROTOCOL.md 3:
// complete, both CRC levels agreeing, of the expected boot and capture, all validity bits set, with
// a LEADER that shows the geometry, LED, levels, exposure and gain that were planned. Frames from
// before the settings took effect are discarded and replaced. Lost chunks are asked for again (at
// most twice per frame), then what is still missing is captured again (at most three times), then
// the capture fails with its evidence. A frame keeps its index through all repairs: a repaired
// capture holds what an undisturbed one would. After an error, and after close(), the LEDs are
// dark. Before configure(): capture() is a Usage error. While nothing is called nobody feeds the
// heartbeat: call keepAlive() when busy elsewhere, or the rig goes dark by itself.
//
// A capture may be armed ahead: it is exposed while the frames of the one before are still sent
// (docs/decisions/0002). Its commands are sent when the last frame before it has been exposed,
// which the stream says: not the host's clock, so that the same requests always make the same
// commands. Frames of the two are told apart by capture_id, and each keeps its repairs.
//
// A rig that is lost comes back when onLost() has said how (comeback.h), in capture(), configure(),
// darken() and keepAlive(); else, when its owner gives up, and after twenty times in one call, the
// call fails and the rig stays lost until the next such call. So it does at once when its stream
// has failed three times in ten seconds: the rig is there, and would fail again. Of the same boot:
// frames that the rig still holds are sent again, the others are exposed again, which is no
// recapture; what was armed ahead is forgotten. Of another boot (it lost its power): the format is
// set again, and capture() is a Device error that says so, once, the one that was interrupted or
// the next: what belongs to one bracket must be taken again. configure() begins anew. Another
// serial number is never taken back.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "driver/assembler.h"
#include "driver/capture_ids.h"
#include "driver/capture_progress.h"
#include "driver/collector.h"
#include "driver/comeback.h"
#include "driver/link.h"
#include "proc/core/frame.h"

namespace gonio::driver {

/// Who the rig is and what it can do.
struct RigInfo {
    std::string serial;
    std::vector<Radians> ledAngles;  ///< from the normal; above 90 degrees: transmission module
    Size sensor;
    int bitDepth = 12;
    std::uint16_t blackLevel = 0;
    std::uint16_t fullScale = 0;
    Microseconds exposureMin{0}, exposureMax{0};
    Nanoseconds framePeriod{0};
    int maxFrames = 1;
    Ident ident;
    Limits limits;
};

struct CaptureRequest {
    std::uint64_t planStep = 0;  ///< capture_id = plan step << 16 | attempt
    std::optional<int> led{};    ///< empty: dark
    LedLevels levels{};          ///< all zero: dark, whatever `led` says
    Microseconds exposure{1000};
    double gainDb = 0;
    int frames = 1;
    bool keepLit = true;  ///< false: dark at the end too
    bool operator==(const CaptureRequest&) const = default;
};

/// What will be asked for next, as far as it is known.
struct ArmAhead {
    std::optional<CaptureRequest> next{};
};

/// Exactly the frames asked for, in order of their index, and what it took to get them. Frames that
/// went to a sink are not among them.
struct Capture {
    std::vector<Frame> frames;
    Anomalies anomalies;
    int discarded = 0;       ///< frames from before the settings took effect
    int resends = 0;         ///< RESEND commands
    int recaptures = 0;      ///< captures taken again after RESEND was not enough
    std::string evidence{};  ///< what was wrong with the first frames that were taken again

    [[nodiscard]] std::size_t size() const { return frames.size(); }
    [[nodiscard]] const Frame& front() const { return frames.front(); }
    [[nodiscard]] const Frame& operator[](std::size_t i) const { return frames[i]; }
    [[nodiscard]] auto begin() const { return frames.begin(); }
    [[nodiscard]] auto end() const { return frames.end(); }
};

class Rig {
public:
    /// `transport` is borrowed until the rig ends, or calls its comeback.
    static Result<Rig> open(Transport& transport, const LinkOptions& options);
    static Result<Rig> open(Transport& transport, std::uint64_t sessionId);
    Rig(Rig&&) noexcept = default;
    Rig& operator=(Rig&&) = delete;
    ~Rig();

    [[nodiscard]] RigInfo identify() const;
    /// The window that is read from now on. Taken exactly, or an error.
    Result<void> configure(const Window& window, PixelFormat format = PixelFormat::Mono12Packed);
    /// `ahead.next` is armed as soon as the frames of `request` have been exposed: the next
    /// capture() of the same request finds it done, or on its way. Any other, and darken(),
    /// configure() and close(), abort it; nothing of it is ever seen. After a request that is not
    /// to be kept lit nothing is armed, nor on a rig that keeps fewer than three frames for RESEND,
    /// nor where there is no memory for the frames of both, nor what the rig refuses: its own
    /// capture() then says why. With a sink that memory must be there before `request` is armed:
    /// one that was armed ahead itself arms nothing that needs more than what came before it.
    /// A `sink` is given each frame as soon as it and those before it are there, in the order of
    /// their index, so that a capture of many frames needs the memory of few. All memory is taken
    /// before anything is armed, for what is armed ahead too; while a sink is busy nothing is read,
    /// and the rig waits with its next exposure (docs/streaming.md).
    Result<Capture> capture(const CaptureRequest& request,
                            const ArmAhead& ahead = {},
                            const FrameSink& sink = {});
    /// All LEDs dark.
    Result<void> darken();
    Result<void> keepAlive();
    Result<Status> status() { return link_->freshStatus(); }
    /// Dark, and given back. Nothing but identify() works afterwards.
    Result<void> close();

    /// Empty: a rig that is lost stays so.
    void onLost(Comeback comeback) { onLost_ = std::move(comeback); }
    /// Called each time the rig has come back, before the call that was interrupted goes on.
    void onBack(std::function<void()> back) { onBack_ = std::move(back); }
    /// That the rig has come back of another boot since the last call, or since configure(); no
    /// capture() tells it any more. Whoever redoes brackets asks this.
    [[nodiscard]] std::optional<Error> takeReboot() { return std::exchange(rebooted_, {}); }
    /// Changes when the rig comes back from a loss of its power.
    [[nodiscard]] std::uint32_t bootId() const { return link_->ident().bootId; }
    /// Those since the last call, oldest first.
    [[nodiscard]] std::vector<Interruption> takeInterruptions();

    /// Since the rig was opened.
    [[nodiscard]] const Anomalies& anomalies() const { return assembler_.anomalies(); }
    [[nodiscard]] RigLink& link() { return *link_; }

private:
    struct Geometry {
        Window window;
        PixelFormat format = PixelFormat::Mono12Packed;
        std::uint32_t frameBytes = 0;
    };
    /// On its way in the rig, and expected by the assembler after the present capture.
    struct OnItsWay {
        CaptureRequest request;
        ArmedCapture armed;
    };

    explicit Rig(std::unique_ptr<RigLink> link) : link_(std::move(link)) {}
    Result<void> start();
    [[nodiscard]] Result<void> check(const CaptureRequest& request) const;
    [[nodiscard]] Result<void> check(const ArmAhead& ahead) const;
    Result<void> admit(const CaptureRequest& request, const ArmAhead& ahead);
    /// What a capture is asked for, through all its attempts.
    struct Making {
        const CaptureRequest& request;
        const ArmAhead& ahead;
        const FrameSink& sink;
    };
    Result<void> fill(const Making& making);
    Result<void> collect(const ArmedCapture& armed, const Making& making);
    Result<void> askForHeld(const ArmedCapture& armed);
    // Of a rig that was lost (rig_comeback.cpp).
    template <class Work>
    auto surviving(Work work) -> decltype(work());
    template <class Work>
    auto inOneBoot(Work work) -> decltype(work());
    void beginCall();
    [[nodiscard]] std::optional<Error> tellReboot();
    Result<void> comeBack(const Error& lost);
    [[nodiscard]] Error lostTooOften(const Error& lost) const;
    Result<void> takeUp(Transport& transport, Interruption& gap);
    Result<void> attempt(const Making& making);
    Result<ArmedCapture> takeUpOrArm(const CaptureRequest& request, int frames);
    Result<void> armAhead(const CaptureRequest& request);
    enum class Turn {
        Present,
        Next
    };
    Result<ArmedCapture> arm(const CaptureRequest& request, int frames, Turn turn);
    Result<FramePlan> apply(const CaptureRequest& request);
    Result<void> setFormat(const Geometry& geometry);
    Result<void> putOut();
    Result<void> quiesce();
    Result<void> abort();
    Result<void> flush();
    [[nodiscard]] Error failed(const Error& error, const Anomalies& before) const;
    // Of memory (rig_memory.cpp).
    [[nodiscard]] int framesHeld() const;
    [[nodiscard]] ExpectedCapture sized(int frames) const;
    [[nodiscard]] bool mayArmAhead(const Making& making) const;
    /// Of a capture and the next.
    struct MemoryNeed {
        ExpectedCapture largest;
        std::size_t wire = 0, pixels = 0;  ///< buffers
    };
    [[nodiscard]] MemoryNeed needed(const CaptureRequest& request,
                                    const ArmAhead& ahead,
                                    bool sink) const;
    void provideMemory(const CaptureRequest& request, const ArmAhead& ahead, bool sink);

    std::unique_ptr<RigLink> link_;  ///< empty after a move
    Assembler assembler_;
    PixelMemory pixels_;
    CaptureProgress progress_;  ///< of the present call of capture()
    std::optional<Geometry> geometry_;
    std::optional<OnItsWay> ahead_;
    CaptureIds ids_;
    Comeback onLost_;
    std::function<void()> onBack_;
    std::uint32_t boot_ = 0;         ///< of the claim that was taken up last
    std::optional<Error> rebooted_;  ///< not taken yet
    bool rebootTold_ = false;        ///< by a capture
    bool faultTold_ = false;         ///< the fault of the stream that the rig is lost by
    int comebacks_ = 0;              ///< ever
    int mostComebacks_ = 0;          ///< of those, in this call
    std::vector<Interruption> interruptions_;
};

/// Does `work` again each time the rig comes back from a loss in it.
template <class Work>
auto Rig::surviving(Work work) -> decltype(work()) {
    while (true) {
        auto done = work();
        if (done || !onLost_ || !link_ || !link_->lost()) return done;
        if (auto back = comeBack(*link_->lost()); !back) return back.error();
    }
}

/// As above, and another boot is an error: first of all, before a loss is mended.
template <class Work>
auto Rig::inOneBoot(Work work) -> decltype(work()) {
    if (auto told = tellReboot()) return *told;
    return surviving([&]() -> decltype(work()) {
        if (auto told = tellReboot()) return *told;
        return work();
    });
}

}  // namespace gonio::driver
