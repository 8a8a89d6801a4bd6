#include "sim/faults/fault_script.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "proc/core/number_text.h"
#include "sim/faults/spoiled_answers.h"

namespace gonio::sim {
namespace {

using driver::Op;

constexpr double kLongest = 1e6;  // seconds
constexpr double kMost = 1e6;     // of anything that is counted

/// How a fault is written: # is a count, @ a time, $ a name, all else the word itself.
struct Form {
    FaultKind kind;
    std::string_view words;
    bool lasts = false;  ///< "for 2s" may follow
};
constexpr std::array kForms{
    Form{FaultKind::Unplug, "unplug", true},
    Form{FaultKind::UnplugQuietly, "unplug quietly", true},
    Form{FaultKind::LosePower, "lose power", true},
    Form{FaultKind::Plug, "plug"},
    Form{FaultKind::PlugRebooted, "plug rebooted"},
    Form{FaultKind::PlugAs, "plug as $", true},
    Form{FaultKind::StallBulk, "stall bulk"},
    Form{FaultKind::BreakTransfer, "break transfer"},
    Form{FaultKind::Overflow, "overflow"},
    Form{FaultKind::StallReports, "stall reports", true},
    Form{FaultKind::SilenceReports, "silence reports", true},
    Form{FaultKind::Hang, "hang", true},
    Form{FaultKind::HangUntilReset, "hang until reset"},
    Form{FaultKind::EndHang, "end hang"},
    Form{FaultKind::LimitTransfers, "memory for # transfers", true},
    Form{FaultKind::EndLimit, "memory again"},
    Form{FaultKind::ShortenChunk, "shorten chunk"},
    Form{FaultKind::ShortenChunk, "shorten # chunks"},
    Form{FaultKind::LengthenChunk, "lengthen chunk"},
    Form{FaultKind::EmptyPacket, "empty packet"},
    Form{FaultKind::FlipPayload, "flip # bits in payload"},
    Form{FaultKind::FlipHeader, "flip # bits in header"},
    Form{FaultKind::BurstPayload, "burst of # bits in payload"},
    Form{FaultKind::LoseChunk, "lose chunk"},
    Form{FaultKind::LoseChunk, "lose # chunks"},
    Form{FaultKind::DuplicateChunk, "duplicate chunk"},
    Form{FaultKind::SwapChunks, "swap chunks"},
    Form{FaultKind::StaleFrame, "stale frame"},
    Form{FaultKind::UnknownChunk, "unknown chunk"},
    Form{FaultKind::LoseCommand, "lose command"},
    Form{FaultKind::LoseAck, "lose ack"},
    Form{FaultKind::DelayAck, "delay ack @"},
    Form{FaultKind::DropReport, "drop report"},
    Form{FaultKind::DropReport, "drop # reports"},
    Form{FaultKind::PileUpReports, "pile up # reports"},
    Form{FaultKind::SpoilReport, "spoil report"},
    Form{FaultKind::UnknownReport, "unknown report"},
    Form{FaultKind::UnknownEvent, "unknown event"},
    Form{FaultKind::OpenInterlock, "open interlock", true},
    Form{FaultKind::CloseInterlock, "close interlock"},
    Form{FaultKind::Overheat, "overheat", true},
    Form{FaultKind::CoolDown, "cool down"},
    Form{FaultKind::JumpClock, "jump clock @"},
    Form{FaultKind::WrapClock, "wrap clock"},
    Form{FaultKind::NewerMinor, "newer minor"},
    Form{FaultKind::NewerMajor, "newer major"},
    Form{FaultKind::Malform, "malform $"},
    Form{FaultKind::PreviousFrame, "previous frame again"},
    Form{FaultKind::BlackFrame, "black frame"},
    Form{FaultKind::UnlitLed, "unlit led"},
    Form{FaultKind::LateSettings, "late settings"},
    Form{FaultKind::HiddenLateSettings, "hidden late settings"},
    Form{FaultKind::OldExposure, "old exposure"},
    Form{FaultKind::Reflex, "saturating reflex"},
    Form{FaultKind::LedDrift, "drifting led"},
};

constexpr std::array kNamedOps{
    std::pair{std::string_view("PING"), Op::Ping},
    std::pair{std::string_view("SET_LED"), Op::SetLed},
    std::pair{std::string_view("SET_EXPOSURE"), Op::SetExposure},
    std::pair{std::string_view("SET_FORMAT"), Op::SetFormat},
    std::pair{std::string_view("ARM"), Op::Arm},
    std::pair{std::string_view("TRIGGER"), Op::Trigger},
    std::pair{std::string_view("ABORT"), Op::Abort},
    std::pair{std::string_view("RESEND"), Op::Resend},
    std::pair{std::string_view("FLUSH"), Op::Flush},
    std::pair{std::string_view("SYNC_TIME"), Op::SyncTime},
    std::pair{std::string_view("CLEAR_FAULT"), Op::ClearFault},
    std::pair{std::string_view("REBOOT"), Op::Reboot},
};

std::vector<std::string_view> split(std::string_view text) {
    constexpr std::string_view kBlank = " \t\r";
    std::vector<std::string_view> words;
    while (true) {
        const auto begin = text.find_first_not_of(kBlank);
        if (begin == std::string_view::npos) return words;
        text.remove_prefix(begin);
        const std::size_t length = std::min(text.find_first_of(kBlank), text.size());
        words.push_back(text.substr(0, length));
        text.remove_prefix(length);
    }
}

std::optional<double> counted(std::string_view text) {
    const auto n = parseInteger(text);
    if (!n || *n < 0 || static_cast<double>(*n) > kMost) return std::nullopt;
    return static_cast<double>(*n);
}

/// "1.5s", "300ms", "20us"; also negative, for a clock that jumps back.
std::optional<double> timed(std::string_view text) {
    const auto number = leadingDouble(text);
    if (!number) return std::nullopt;
    const std::string_view unit = text.substr(number->length);
    const double scale = unit == "s" ? 1 : unit == "ms" ? 1e-3 : unit == "us" ? 1e-6 : 0;
    if (scale == 0 || std::abs(number->value * scale) > kLongest) return std::nullopt;
    return number->value * scale;
}

/// "a", or "a..b" with a <= b.
std::optional<FaultRange> range(std::string_view text,
                                std::optional<double> (*read)(std::string_view)) {
    const auto dots = text.find("..");
    const auto low = read(text.substr(0, dots));
    const auto high = dots == std::string_view::npos ? low : read(text.substr(dots + 2));
    if (!low || !high || *low > *high) return std::nullopt;
    return FaultRange{*low, *high};
}

/// The words of a line, taken one after the other.
class Words {
public:
    explicit Words(std::span<const std::string_view> words) : words_(words) {}
    [[nodiscard]] bool done() const { return words_.empty(); }
    [[nodiscard]] std::string_view peek() const { return done() ? "" : words_.front(); }
    [[nodiscard]] std::size_t left() const { return words_.size(); }
    std::string_view next() {
        const std::string_view word = peek();
        if (!done()) words_ = words_.subspan(1);
        return word;
    }
    bool take(std::string_view word) {
        if (done() || peek() != word) return false;
        next();
        return true;
    }
    std::optional<FaultRange> count() { return taken(range(peek(), counted)); }
    std::optional<FaultRange> time() { return taken(range(peek(), timed)); }

private:
    std::optional<FaultRange> taken(std::optional<FaultRange> value) {
        if (value) next();
        return value;
    }
    std::span<const std::string_view> words_;
};

Error wanted(const std::string& what, const Words& at) {
    return {ErrorKind::File,
            (at.done() ? std::string("the line ends") : "\"" + std::string(at.peek()) + "\"") +
                ", wanted " + what};
}

/// The fault, if the words begin as the form does; they are taken then.
std::optional<Fault> matched(const Form& form, Words& words) {
    Words at = words;
    Fault fault{.kind = form.kind};
    for (const std::string_view part : split(form.words)) {
        if (part == "#") {
            const auto count = at.count();
            if (!count) return std::nullopt;
            fault.count = *count;
        } else if (part == "@") {
            const auto time = at.time();
            if (!time) return std::nullopt;
            fault.time = *time;
        } else if (part == "$") {
            if (at.done()) return std::nullopt;
            fault.name = at.next();
        } else if (!at.take(part)) {
            return std::nullopt;
        }
    }
    words = at;
    return fault;
}

/// A form in which nothing would happen.
Error idle(const Form& form, const std::string& wanted) {
    return {ErrorKind::File, "\"" + std::string(form.words) + "\": wanted " + wanted};
}

/// No memory at all is a fault; none of anything else is none.
Result<void> checkAmounts(const Form& form, const Fault& fault) {
    if (fault.count.low < 1 && fault.kind != FaultKind::LimitTransfers)
        return idle(form, "a number from 1 on, or 2..5, for #");
    if (fault.kind == FaultKind::DelayAck && fault.time.low <= 0)
        return idle(form, "a time above 0 for @");
    if (fault.kind == FaultKind::Malform && !isMalformation(fault.name))
        return Error{ErrorKind::File,
                     "malform " + fault.name + ", wanted one of " + malformations()};
    return {};
}

/// Of all forms that match, the longest.
Result<Fault> readFault(Words& words) {
    const Form* best = nullptr;
    Words rest = words;
    Fault fault;
    for (const Form& form : kForms) {
        Words at = words;
        auto found = matched(form, at);
        if (!found || (best && at.left() >= rest.left())) continue;
        best = &form;
        rest = at;
        fault = std::move(*found);
    }
    if (!best) return wanted(R"(what goes wrong, such as "lose chunk" or "unplug for 1s")", words);
    if (auto sound = checkAmounts(*best, fault); !sound) return sound.error();
    words = rest;
    if (best->lasts && words.take("for")) {
        const Words at = words;
        fault.lasting = words.time();
        if (!fault.lasting || fault.lasting->low <= 0)
            return wanted("a time above 0, such as 1.5s", at);
    }
    return fault;
}

std::optional<Op> namedOp(std::string_view name) {
    const auto* found = std::find_if(
        kNamedOps.begin(), kNamedOps.end(), [&](const auto& op) { return op.first == name; });
    if (found == kNamedOps.end()) return std::nullopt;
    return found->second;
}

Error wantedNumber(const Words& words) { return wanted("a number from 1 on, or 2..5", words); }

bool fromOneOn(const std::optional<FaultRange>& count) { return count && count->low >= 1; }

Result<FaultMoment> readChunk(Words& words) {
    FaultMoment when{.kind = FaultMoment::Kind::Chunk};
    const auto index = words.count();
    if (!index) return wantedNumber(words);
    when.value = *index;
    if (words.take("of")) {
        if (!words.take("frame")) return wanted("\"frame\"", words);
        when.ofFrame = words.count();
        if (!fromOneOn(when.ofFrame)) return wantedNumber(words);
    } else if (index->low < 1) {
        return wantedNumber(words);
    }
    return when;
}

/// After "on" or "after": a command by its number or its op.
Result<FaultMoment> readCommand(Words& words, FaultMoment::Kind kind) {
    FaultMoment when{.kind = kind, .value = {1, 1}};
    if (!words.take("command")) {
        when.op = namedOp(words.peek());
        if (!when.op) return wanted("frame, command, chunk or an op such as ARM", words);
        words.next();
    }
    const auto number = words.count();
    if (number) when.value = *number;
    if (when.value.low < 1 || (!number && !when.op)) return wantedNumber(words);
    return when;
}

Result<FaultMoment> readFrame(Words& words, FaultMoment::Kind kind) {
    const auto number = words.count();
    if (!fromOneOn(number)) return wantedNumber(words);
    return FaultMoment{.kind = kind, .value = *number};
}

Result<FaultMoment> readTime(Words& words, FaultMoment::Kind kind) {
    const auto time = words.time();
    const bool period = kind == FaultMoment::Kind::Period;
    if (!time || time->low < (period ? 1e-3 : 0))
        return wanted(period ? "a time from 1ms on" : "a time such as 1.5s or 0.5s..2s", words);
    return FaultMoment{.kind = kind, .value = *time};
}

Result<FaultMoment> readChance(Words& words) {
    if (!words.take("chance")) return wanted("\"chance\"", words);
    const auto chance = parseDouble(words.peek());
    if (!chance || *chance < 0 || *chance > 1) return wanted("a chance from 0 to 1", words);
    words.next();
    if (!words.take("per")) return wanted("\"per\"", words);
    FaultMoment when{.chance = *chance};
    if (words.take("chunk")) {
        when.kind = FaultMoment::Kind::PerChunk;
    } else if (words.take("frame")) {
        when.kind = FaultMoment::Kind::PerExposure;
    } else if (words.take("command")) {
        when.kind = FaultMoment::Kind::PerCommand;
    } else {
        return wanted("chunk, frame or command", words);
    }
    return when;
}

Result<FaultMoment> readMoment(Words& words) {
    using Kind = FaultMoment::Kind;
    if (words.take("at")) return readTime(words, Kind::Time);
    if (words.take("every")) return readTime(words, Kind::Period);
    if (words.take("with")) return readChance(words);
    if (words.take("on")) {
        if (words.take("frame")) return readFrame(words, Kind::Exposure);
        if (words.take("chunk")) return readChunk(words);
        return readCommand(words, Kind::OnCommand);
    }
    if (words.take("after")) {
        if (words.take("frame")) return readFrame(words, Kind::FrameSent);
        return readCommand(words, Kind::AfterCommand);
    }
    return wanted("seed, at, every, on, after or with", words);
}

Result<FaultRule> readRule(Words& words) {
    const auto when = readMoment(words);
    if (!when) return when.error();
    FaultRule rule{.when = *when, .faults = {}};
    do {
        auto fault = readFault(words);
        if (!fault) return fault.error();
        rule.faults.push_back(std::move(*fault));
    } while (words.take("or"));
    if (!words.done()) return wanted("\"or\", or the end of the line", words);
    return rule;
}

Result<void> readLine(Words words, int line, FaultScript& script) {
    if (words.take("seed")) {
        const auto seed = parseInteger(words.peek());
        if (!seed || *seed < 0) return wanted("a number from 0 on", words);
        words.next();
        script.seed = static_cast<std::uint64_t>(*seed);
        if (!words.done()) return wanted("the end of the line", words);
        return {};
    }
    auto rule = readRule(words);
    if (!rule) return rule.error();
    rule->line = line;
    script.rules.push_back(std::move(*rule));
    return {};
}

}  // namespace

std::string_view faultName(FaultKind kind) {
    const auto* form =
        std::find_if(kForms.begin(), kForms.end(), [&](const Form& f) { return f.kind == kind; });
    return form == kForms.end() ? "nothing" : form->words;
}

Result<FaultScript> FaultScript::parse(std::string_view text) {
    if (text.size() > kMostBytes) {
        return Error{ErrorKind::File,
                     "fault script: " + std::to_string(text.size()) + " bytes, at most " +
                         std::to_string(kMostBytes) + " are taken"};
    }
    FaultScript script;
    for (int line = 1; !text.empty(); ++line) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view content = text.substr(0, end);
        const auto words = split(content.substr(0, content.find('#')));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (words.empty()) continue;
        if (auto read = readLine(Words(words), line, script); !read)
            return read.error().in("fault script: line " + std::to_string(line));
    }
    return script;
}

}  // namespace gonio::sim
