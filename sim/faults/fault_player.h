#pragma once
// Which faults of a script are due. It is told what happens on the bus, in order, and answers with
// what goes wrong now; what is random is a function of the seed, the rule and how often the rule
// has been asked, and of nothing else.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/faults/fault_script.h"

namespace gonio::sim {

/// A fault with its random parts drawn.
struct DueFault {
    FaultKind kind = FaultKind::Count;
    int count = 1;
    Nanoseconds time{0};
    Nanoseconds lasting{0};  ///< 0: it does not end by itself
    bool isEnd = false;      ///< of one that lasted for a while
    std::string name;
    std::uint64_t key = 0;  ///< for what else is random in it
};

class FaultPlayer {
public:
    FaultPlayer() = default;
    FaultPlayer(FaultScript script, Nanoseconds start);

    /// When the next fault is due by time alone.
    [[nodiscard]] Nanoseconds next() const;
    /// The first of those that are due by now; empty: there is none.
    [[nodiscard]] std::optional<DueFault> timed(Nanoseconds now);
    /// Puts a fault off.
    void later(Nanoseconds when, DueFault fault) { agenda_.emplace(when, Entry{std::move(fault)}); }
    /// Takes over the ends that are still due in another's agenda.
    void takeEnds(const FaultPlayer& other);

    /// A chunk is sent: the so-manieth of its frame, frames counted from 1.
    struct Place {
        int frame = 0, chunk = 0;
    };
    [[nodiscard]] std::vector<DueFault> chunkSent(const Place& place);
    [[nodiscard]] std::vector<DueFault> frameSent();
    [[nodiscard]] std::vector<DueFault> exposureBegins();
    [[nodiscard]] std::vector<DueFault> onCommand(driver::Op op);
    [[nodiscard]] std::vector<DueFault> afterCommand(driver::Op op);

private:
    struct Entry {
        DueFault fault{};
        std::size_t rule = kNoRule;  ///< of its period
    };
    static constexpr std::size_t kNoRule = ~std::size_t{0};
    /// What is known of a rule while it plays.
    struct State {
        double wanted = 0;   ///< the number drawn: which chunk, frame or command
        double ofFrame = 0;  ///< likewise
        int seen = 0;        ///< commands of its op, or how often its chance was drawn
        int fired = 0;
    };
    [[nodiscard]] double draw(std::size_t rule, std::uint64_t occurrence, std::uint64_t what) const;
    [[nodiscard]] DueFault fired(std::size_t rule);
    void nextPeriod(std::size_t rule, Nanoseconds from);
    /// Its chance, drawn anew.
    [[nodiscard]] bool lucky(State& state);
    template <class Matches>
    std::vector<DueFault> matching(Matches matches);
    [[nodiscard]] std::vector<DueFault> commands(FaultMoment::Kind kind, driver::Op op);

    FaultScript script_;
    std::vector<State> states_;
    std::multimap<Nanoseconds, Entry> agenda_;
    int chunks_ = 0, frames_ = 0, exposures_ = 0;
};

}  // namespace gonio::sim
