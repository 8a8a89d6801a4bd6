#pragma once
// The daemon without its door: one thread owns the rig and writes the store, any other asks. The
// owner looks for the rig, claims it, feeds its heartbeat, and runs one job at a time. When it
// ends, the job at hand is ended at its next step and the LEDs are dark.

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "daemon/calibrations.h"
#include "daemon/engine/engine_state.h"
#include "daemon/engine/event_log.h"
#include "daemon/engine/job.h"
#include "daemon/engine/rig_port.h"
#include "daemon/engine/sim_port.h"
#include "daemon/finding.h"
#include "daemon/logbook.h"
#include "daemon/store_lock.h"

namespace gonio::daemon {

/// What a person has to do before a job goes on.
struct Question {
    std::uint64_t number = 0;  ///< of the event that asks it
    std::string wanted;
};

/// The job that runs.
struct JobStatus {
    JobRecord record;
    int step = 0, steps = 0;
    std::string what;  ///< the newest step
    std::optional<Question> question{};
    Seconds elapsed{0};
    std::optional<Seconds> left{};  ///< by the steps that are done
    int interruptions = 0;          ///< survived so far
};

struct CalibrationDate {
    std::string kind;
    std::string dateUtc;
};

/// What is so at this moment.
struct EngineStatus {
    EngineState state = EngineState::Offline;
    std::string portKind;
    std::string serial;    ///< empty: no rig has been seen yet
    std::string obstacle;  ///< why there is no rig, or none that may be lit
    std::string placed;    ///< empty: only a person knows
    std::optional<driver::Status> rig{};
    std::optional<driver::RigInfo> info{};  ///< of the rig that was claimed last
    std::optional<JobStatus> job{};
    std::optional<SessionRecord> session{};
    std::vector<CalibrationDate> calibrations;  ///< newest of each kind, of this rig
};

/// What the engine must not take from the computer by itself.
struct EngineWorld {
    const Clock& clock;
    std::function<std::string()> utcNow;
    std::function<std::uint64_t()> randomId;  ///< of a claim
    /// Called by a sound owner at each step of a job, and several times a second otherwise.
    std::function<void()> alive;
    /// How long a job waits for a rig that was lost, or that must not light; 0: it ends at once.
    Seconds patience = std::chrono::minutes(10);
};

class Engine {
public:
    /// Takes the store's lock: Busy when another daemon has it. What was running when the last one
    /// ended is Interrupted from now on. The port is borrowed.
    [[nodiscard]] static Result<std::unique_ptr<Engine>> open(const std::filesystem::path& store,
                                                              RigPort& port,
                                                              RigProfile profile,
                                                              EngineWorld world);
    ~Engine();

    /// The owner's life: until `stop`. Ends with the LEDs dark and the rig given back.
    void run(const std::stop_token& stop);

    // From any thread. Busy while a job runs, or when the engine has ended.
    [[nodiscard]] EngineStatus status() const;
    /// What a calibration has to be good for.
    [[nodiscard]] RigNow rigNow() const;
    [[nodiscard]] const std::filesystem::path& storeRoot() const { return store_.root(); }
    [[nodiscard]] const RigProfile& profile() const { return profile_; }
    [[nodiscard]] EventLog& events() { return events_; }
    [[nodiscard]] Result<std::vector<RigListing>> rigs() { return port_.list(); }
    /// The doctor's findings of the rig that the engine has; the first is always `claim`. A rig
    /// that is idle is asked, and takes two dark frames; while a job runs, and with `handsOff`,
    /// what is known of it is said.
    [[nodiscard]] Result<std::vector<Finding>> examine(bool handsOff);
    /// Begins it: once this has returned the job is in the logbook. NoRig when it needs a rig and
    /// there is none.
    Result<JobRecord> submit(const JobRequest& request);
    /// Ends the running job at its next step; a Usage error when it is not the running one.
    Result<void> cancel(std::int64_t job);
    /// What this question of the job's wanted is done; a Usage error when it is not the one that is
    /// asked now.
    Result<void> proceed(std::int64_t job, std::uint64_t question);
    Result<SessionRecord> openSession(const SessionRecord& session);
    Result<SessionRecord> closeSession();
    /// Usage error with a real rig.
    Result<void> place(const PlaceRequest& request);

private:
    class Monitor;
    struct Pending {
        JobRequest request;
        JobRecord record;
    };
    /// Work for the owner, or why it is not done.
    using Mail = std::function<void(const std::optional<Error>& refusal)>;
    enum class Wish {
        None,
        Proceed,
        Cancel
    };

    Engine(Store store,
           Logbook logbook,
           driver::FileLock lock,
           RigPort& port,
           RigProfile profile,
           EngineWorld world,
           std::uint64_t newestEvent);

    template <class T>
    Result<T> ask(std::function<Result<T>()> work);
    void serveNext();
    void refuseAll(const Error& why);
    void end();
    /// Precondition: mutex_ is held.
    [[nodiscard]] bool runs(std::int64_t job) const {
        return status_.job && status_.job->record.id == job;
    }
    Result<JobRecord> begin(const JobRequest& request);

    void connect();
    Result<void> claim();
    void tend();
    void lost(const Error& why);
    void disconnect();
    void hinder(const std::optional<Error>& obstacle, const std::string& whom = {});
    void publishRig();
    // A job that goes on (engine_recovery.cpp).
    [[nodiscard]] Result<driver::Transport*> comeBack(const Error& lost);
    [[nodiscard]] Result<driver::Transport*> lookAgain();
    [[nodiscard]] std::optional<Error> recordingEnded(const Error& lost) const;
    void resume();
    [[nodiscard]] bool patientSince(Nanoseconds begin) const {
        return Seconds(world_.clock.now() - begin) < world_.patience;
    }
    [[nodiscard]] Result<void> awaitLight(const Error& why);
    [[nodiscard]] Result<bool> mayLight();
    void pause();
    // Of the doctor (engine_doctor.cpp).
    [[nodiscard]] std::vector<Finding> examineNow();
    [[nodiscard]] std::vector<Finding> examineFromAfar(const std::string& why) const;
    [[nodiscard]] Error noRig() const;
    void runPending(const std::stop_token& stop);
    [[nodiscard]] Result<std::string> runOn(const JobRequest& request, Monitor& monitor);
    [[nodiscard]] Result<std::string> runAtDesk(const JobRequest& request, Monitor& monitor);
    void settle(JobRecord& job, const Result<std::string>& outcome, const Monitor& monitor);
    void lookAfterRig(JobRecord& job);
    [[nodiscard]] Result<std::uint64_t> reserveSteps();

    void advance(EngineEvent event, const std::string& detail = {});
    void reserveNumbers();
    void tell(const std::string& type, const std::string& json, bool kept);
    void tellJob(const JobRecord& job);
    void tellRecordingEnd();
    template <class Change>
    void publish(Change change) {
        const std::scoped_lock lock(mutex_);
        change(status_);
    }
    void publishCalibrations();

    Store store_;
    Logbook logbook_;
    driver::FileLock lock_;
    RigPort& port_;
    RigProfile profile_;
    EngineWorld world_;
    EventLog events_;

    // The owner's alone.
    std::uint64_t lastNumber_;  ///< of an event, of those that are reserved
    std::optional<driver::Rig> rig_;
    std::optional<Pending> pending_;
    Nanoseconds nextTry_{0};
    std::optional<Error> obstacle_;      ///< why there is no rig, or none that may be lit
    Monitor* monitor_ = nullptr;         ///< of the job that is on the rig
    std::optional<Nanoseconds> lostAt_;  ///< of that job's rig, until it has come back

    mutable std::mutex mutex_;  ///< of what is below
    std::condition_variable asked_;
    std::deque<Mail> mailbox_;
    EngineStatus status_;
    bool ended_ = false;
    Wish wish_ = Wish::None;
};

}  // namespace gonio::daemon
