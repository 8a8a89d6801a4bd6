#include "daemon/engine/engine.h"

#include <nlohmann/json.hpp>

#include "daemon/guarded.h"
#include "daemon/problem.h"
#include "proc/core/log.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

constexpr auto kPause = 250ms;                    // between two looks at an idle rig: heartbeat / 8
constexpr std::uint64_t kReservedNumbers = 1000;  // of events: some jobs
constexpr const char* kLastNumber = "event-number";

std::string dump(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Error stopping() { return {ErrorKind::Busy, "the daemon is stopping"}; }
Error busyWith(const JobRecord& job) {
    return {ErrorKind::Busy,
            "the rig is busy with " + titleOf(job) +
                "; wait until it is done, or end it: gonio jobs cancel"};
}

}  // namespace

// ---- asking the owner ----

/// Waits for the owner to do `work`. Busy while a job runs: the owner would not come to it.
template <class T>
Result<T> Engine::ask(std::function<Result<T>()> work) {
    auto answer = std::make_shared<std::promise<Result<T>>>();  // shared: std::function copies
    auto future = answer->get_future();
    {
        const std::scoped_lock lock(mutex_);
        if (ended_) return stopping();
        if (status_.job) return busyWith(status_.job->record);
        mailbox_.push_back([answer, work = std::move(work)](const std::optional<Error>& refusal) {
            answer->set_value(refusal ? Result<T>(*refusal) : guarded("the daemon", work));
        });
    }
    asked_.notify_all();
    return future.get();
}

void Engine::serveNext() {
    Mail next;
    {
        std::unique_lock lock(mutex_);
        asked_.wait_for(lock, kPause, [&] { return !mailbox_.empty(); });
        if (mailbox_.empty()) return;
        next = std::move(mailbox_.front());
        mailbox_.pop_front();
    }
    next({});
}

/// What was asked for and not yet begun: the owner will not come to it for long, or never.
void Engine::refuseAll(const Error& why) {
    std::deque<Mail> left;
    {
        const std::scoped_lock lock(mutex_);
        left.swap(mailbox_);
    }
    for (const Mail& mail : left) mail(why);
}

void Engine::end() {
    {
        const std::scoped_lock lock(mutex_);
        ended_ = true;
    }
    refuseAll(stopping());
}

Result<JobRecord> Engine::submit(const JobRequest& request) {
    if (Result<void> good = check(request); !good) return good.error();
    return ask<JobRecord>([this, request] { return begin(request); });
}

Result<JobRecord> Engine::begin(const JobRequest& request) {
    if (request.kind != JobKind::Recalibrate && status().state != EngineState::Idle) return noRig();
    Result<JobRecord> record = logbook_.beginJob({.kind = std::string(name(request.kind)),
                                                  .name = request.name,
                                                  .startedUtc = world_.utcNow()});
    if (!record) return record;
    pending_ = Pending{request, *record};
    {
        const std::scoped_lock lock(mutex_);
        wish_ = Wish::None;
        status_.job = JobStatus{.record = *record};
    }
    refuseAll(busyWith(*record));
    tellJob(*record);
    return record;
}

Result<void> Engine::cancel(std::int64_t job) {
    {
        const std::scoped_lock lock(mutex_);
        if (!runs(job)) {
            return Error{ErrorKind::Usage, "job " + std::to_string(job) + " is not running"};
        }
        wish_ = Wish::Cancel;
    }
    asked_.notify_all();
    return {};
}

Result<void> Engine::proceed(std::int64_t job, std::uint64_t question) {
    {
        const std::scoped_lock lock(mutex_);
        if (!runs(job) || !status_.job->question) {
            return Error{ErrorKind::Usage, "job " + std::to_string(job) + " waits for nobody"};
        }
        if (const Question& asked = *status_.job->question; asked.number != question) {
            return Error{ErrorKind::Usage,
                         "job " + std::to_string(job) + " no longer asks question " +
                             std::to_string(question) + " but " + std::to_string(asked.number) +
                             ": " + asked.wanted};
        }
        if (wish_ == Wish::None) wish_ = Wish::Proceed;
        status_.job->question.reset();  // who looks now must not take it for the next one
    }
    asked_.notify_all();
    return {};
}

Result<SessionRecord> Engine::openSession(const SessionRecord& session) {
    if (Result<void> good = check(session); !good) return good.error();
    return ask<SessionRecord>([this, wanted = SessionRecord(session)]() mutable {
        wanted.openedUtc = world_.utcNow();
        Result<SessionRecord> opened = logbook_.openSession(std::move(wanted));
        if (!opened) return opened;
        publish([&](EngineStatus& status) { status.session = *opened; });
        tell("session", dump({{"name", opened->name}, {"open", true}}), true);
        return opened;
    });
}

Result<SessionRecord> Engine::closeSession() {
    return ask<SessionRecord>([this] {
        Result<SessionRecord> closed = logbook_.closeSession(world_.utcNow());
        if (!closed) return closed;
        publish([](EngineStatus& status) { status.session.reset(); });
        tell("session", dump({{"name", closed->name}, {"open", false}}), true);
        return closed;
    });
}

Result<void> Engine::place(const PlaceRequest& request) {
    SimPort* sim = port_.simulated();
    if (sim == nullptr) {
        return Error{ErrorKind::Usage, "sim place: the rig is real; place it by hand"};
    }
    return ask<void>([this, sim, request]() -> Result<void> {
        const Result<bool> another = sim->place(request);
        if (!another) return another.error();
        tell("placed", dump({{"what", sim->placed()}}), true);
        publish([&](EngineStatus& status) { status.placed = sim->placed(); });
        if (!*another) return {};
        disconnect();
        advance(EngineEvent::Lost, "another simulated rig was chosen");
        nextTry_ = Nanoseconds(0);
        connect();
        return rig_ ? Result<void>() : noRig();
    });
}

Result<std::vector<Finding>> Engine::examine(bool handsOff) {
    const std::string why = handsOff ? "not asked for" : port_.onlyForJobs();
    if (!why.empty()) return examineFromAfar(why);
    auto asked =
        ask<std::vector<Finding>>([this] { return Result<std::vector<Finding>>(examineNow()); });
    if (asked || asked.error().kind != ErrorKind::Busy) return asked;
    return examineFromAfar(asked.error().message);
}

EngineStatus Engine::status() const {
    const std::scoped_lock lock(mutex_);
    return status_;
}

RigNow Engine::rigNow() const {
    const EngineStatus now = status();
    return {.serial = now.serial,
            .profileHash = profile_.hash,
            .celsius = now.rig ? driver::celsius(now.rig->temperature[0]) : std::nullopt,
            .dateUtc = world_.utcNow()};
}

// ---- what the owner tells ----

void Engine::publishCalibrations() {
    std::vector<CalibrationDate> dates;
    for (const std::string_view kind : kCalibrationKinds) {
        const auto newest = store_.newestCalibration(status().serial, std::string(kind));
        if (newest && *newest) dates.push_back({std::string(kind), (*newest)->dateUtc});
    }
    publish([&](EngineStatus& status) { status.calibrations = std::move(dates); });
}

/// Not all events are kept, and no number is given twice: those of the next ones are taken before.
void Engine::reserveNumbers() {
    if (events_.newest() < lastNumber_) return;
    lastNumber_ = events_.newest() + kReservedNumbers;
    const auto set = logbook_.set(kLastNumber, std::to_string(lastNumber_));
    if (!set) log::error(set.error().message);
}

/// A kept event is in the logbook before anyone hears of it.
void Engine::tell(const std::string& type, const std::string& json, bool kept) {
    reserveNumbers();
    EventRecord event{.dateUtc = world_.utcNow(), .type = type, .data = json};
    if (kept) {
        event.id = events_.newest() + 1;  // this thread alone adds
        if (Result<void> done = logbook_.addEvent(event); !done) log::error(done.error().message);
    }
    events_.add(std::move(event));
}

void Engine::tellJob(const JobRecord& job) {
    Json json{{"job", job.id},
              {"kind", job.kind},
              {"name", job.name},
              {"state", std::string(name(job.state))}};
    if (job.error) {
        json["problem"] = std::string(problemName(job.error->kind));
        json["message"] = job.error->message;
    }
    tell("job", dump(json), true);
}

void Engine::tellRecordingEnd() {
    const std::string why = port_.takeRecordingEnd();
    if (!why.empty()) tell("recording", dump({{"state", "ended"}, {"message", why}}), true);
}

void Engine::advance(EngineEvent event, const std::string& detail) {
    const auto to = next(status().state, event);
    if (!to) return;
    publish([&](EngineStatus& status) { status.state = *to; });
    tell("rig",
         dump({{"state", std::string(name(*to))}, {"serial", status().serial}, {"detail", detail}}),
         *to != EngineState::Running && *to != EngineState::Finishing);
}

// ---- life ----

void Engine::run(const std::stop_token& stop) {
    const std::stop_callback wake(stop, [this] { asked_.notify_all(); });
    while (!stop.stop_requested()) {
        world_.alive();
        tend();
        tellRecordingEnd();
        serveNext();
        runPending(stop);
    }
    end();
    disconnect();
    events_.close();
}

Engine::Engine(Store store,
               Logbook logbook,
               driver::FileLock lock,
               RigPort& port,
               RigProfile profile,
               EngineWorld world,
               std::uint64_t newestEvent)
    : store_(std::move(store)),
      logbook_(std::move(logbook)),
      lock_(std::move(lock)),
      port_(port),
      profile_(std::move(profile)),
      world_(std::move(world)),
      events_(newestEvent),
      lastNumber_(newestEvent) {
    status_.portKind = port.kind();
}

Engine::~Engine() { end(); }

Result<std::unique_ptr<Engine>> Engine::open(const std::filesystem::path& root,
                                             RigPort& port,
                                             RigProfile profile,
                                             EngineWorld world) {
    Result<Store> store = Store::open(root);
    if (!store) return store.error();
    Result<driver::FileLock> lock = lockStore(store->root());
    if (!lock) return lock.error();
    if (Result<void> swept = store->sweep(); !swept) return swept.error();
    Result<Logbook> logbook = Logbook::open(store->root());
    if (!logbook) return logbook.error();
    const auto interrupted = logbook->interruptJobs(world.utcNow());
    if (!interrupted) return interrupted.error();
    const auto newest = logbook->newestEvent();
    if (!newest) return newest.error();
    const auto reserved = logbook->setting(kLastNumber);
    if (!reserved) return reserved.error();
    const auto given = static_cast<std::uint64_t>(parseInteger(*reserved).value_or(0));
    const auto session = logbook->currentSession();
    if (!session) return session.error();
    std::unique_ptr<Engine> engine(new Engine(std::move(*store),
                                              std::move(*logbook),
                                              std::move(*lock),
                                              port,
                                              std::move(profile),
                                              std::move(world),
                                              std::max(*newest, given)));
    engine->status_.session = *session;
    for (const JobRecord& job : *interrupted) engine->tellJob(job);
    return engine;
}

}  // namespace gonio::daemon
