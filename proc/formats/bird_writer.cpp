#include <algorithm>
#include <cmath>
#include <utility>

#include "proc/core/number_text.h"
#include "proc/formats/bird.h"
#include "proc/formats/bird_metadata.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/json_scan.h"

namespace gonio::proc {
namespace {

bool known(double u) { return std::isfinite(u) && u >= 0; }

/// Numbers behind one another, each text as long as its value is the last one's, which is common:
/// one light has many values.
class NumberList {
public:
    explicit NumberList(std::string& text) : text_(text) {}

    void add(double value) {
        if (any_) text_ += ',';
        if (!any_ || value != last_ || std::signbit(value) != std::signbit(last_)) {
            last_ = value;
            const std::size_t from = text_.size();
            appendShortest(text_, value);
            shown_ = text_.substr(from);
        } else {
            text_ += shown_;
        }
        any_ = true;
    }
    void addUnknown() {
        text_ += any_ ? ",null" : "null";
        any_ = true;
        last_ = std::nan("");
    }

private:
    std::string& text_;
    std::string shown_;
    double last_ = 0;
    bool any_ = false;
};

class Writer {
public:
    Writer(const BrdfRows& rows, const Metadata& about) : rows_(rows), about_(about) {}

    Result<Written> write() {
        select();
        if (entries_ == 0) {
            return Error{ErrorKind::Usage, "bird: no value at thetas below 90 degrees"};
        }
        std::string& text = written_.bytes;
        constexpr std::size_t kUsualEntry = 130;
        text.reserve(2000 + entries_ * kUsualEntry);
        text = "{\n\t\"metadata\": " + birdMetadataJson(about_, rows_.isotropic) +
               ",\n\t\"data\": {\n";
        angles();
        spectrum();
        values();
        adhoc();
        text += "\n\t}\n}\n";
        return std::move(written_);
    }

private:
    /// A pair that the schema can hold: both thetas below 90 degrees as they are written.
    static bool holds(const LightView& pair) {
        return fileDegrees(pair.in.theta()) < 90 && fileDegrees(pair.out.theta()) < 90;
    }

    void select() {
        std::size_t missing = 0, missingFlags = 0, below = 0, negative = 0;
        const std::size_t channels = rows_.channels.size();
        holds_.reserve(rows_.pairs.size());
        for (std::size_t pair = 0; pair < rows_.pairs.size(); ++pair) {
            holds_.push_back(holds(rows_.pairs[pair]));
            for (std::size_t c = 0; c < channels; ++c) {
                const std::size_t at = rows_.index(pair, c);
                if (!std::isfinite(rows_.f[at])) {
                    ++missing;
                    if (!rows_.flags.empty() && rows_.flags[at] != Flags{}) ++missingFlags;
                } else if (!holds_.back()) {
                    ++below;
                } else {
                    ++entries_;
                    if (rows_.f[at] < 0) ++negative;
                    if (!rows_.uRandom.empty() && !std::isfinite(uAt(at))) ++unknown_;
                }
            }
        }
        negative_ = negative > 0;
        LossReport& loss = written_.loss;
        loss.add(Loss::Masked, "missing values, left out", missing);
        loss.add(Loss::Dropped, "flags of missing values", missingFlags);
        loss.add(Loss::Dropped, "values at a theta of 90 degrees and more", below);
        loss.add(Loss::Clamped, "negative values, 0 in BRDF and kept in 'negative'", negative);
    }
    [[nodiscard]] double uAt(std::size_t at) const {
        const double random = rows_.uRandom[at];
        const double systematic = rows_.uSystematic.empty() ? 0 : rows_.uSystematic[at];
        return known(random) && known(systematic) ? std::hypot(random, systematic) : std::nan("");
    }

    /// Calls `add(pair, place)` for each entry, channel fastest.
    template <class Add>
    void eachEntry(const Add& add) const {
        for (std::size_t pair = 0; pair < rows_.pairs.size(); ++pair) {
            if (!holds_[pair]) continue;
            for (std::size_t c = 0; c < rows_.channels.size(); ++c) {
                const std::size_t at = rows_.index(pair, c);
                if (std::isfinite(rows_.f[at])) add(pair, at);
            }
        }
    }

    /// `more`: what stands between the unit and the values, as JSON.
    void begin(std::string_view name, std::string_view unit, std::string_view more) {
        std::string& text = written_.bytes;
        if (!std::exchange(first_, false)) text += ",\n";
        text += inAdhoc_ ? "\t\t\t" : "\t\t";
        text += jsonString(name) + ": {\"unit\": " + jsonString(unit) + std::string(more) +
                ", \"values\": [";
    }
    void end() { written_.bytes += "]}"; }

    void angles() {
        for (const bool in : {true, false}) {
            for (const bool theta : {true, false}) {
                begin(std::string(theta ? "theta_" : "phi_") + (in ? "i" : "r"), "deg", {});
                NumberList list(written_.bytes);
                Eigen::Vector3d last(0, 0, 0);
                double degrees = 0;
                eachEntry([&](std::size_t pair, std::size_t) {
                    const Direction& w = in ? rows_.pairs[pair].in : rows_.pairs[pair].out;
                    if (w.vector() != last) {
                        last = w.vector();
                        degrees = theta ? fileDegrees(w.theta()) : fileAzimuthDegrees(w.phi());
                    }
                    list.add(degrees);
                });
                end();
            }
        }
    }

    void spectrum() {
        const auto& channels = rows_.channels;
        const auto told = std::count_if(
            channels.begin(), channels.end(), [](const Channel& c) { return !!c.nanometres; });
        if (told == 0) return;
        if (static_cast<std::size_t>(told) < channels.size()) {
            written_.loss.add(Loss::Dropped,
                              "wavelengths of channels beside others without one",
                              static_cast<std::size_t>(told));
            return;
        }
        spectral_ = true;
        column("wavelength_i", "nm", {}, [&](std::size_t at) {
            return *channels[at % channels.size()].nanometres;
        });
    }

    /// A variable of numbers; what is not finite is null.
    template <class Value>
    void column(std::string_view name,
                std::string_view unit,
                std::string_view more,
                const Value& value) {
        begin(name, unit, more);
        NumberList list(written_.bytes);
        eachEntry([&](std::size_t, std::size_t at) {
            const double one = value(at);
            if (std::isfinite(one)) {
                list.add(one);
            } else {
                list.addUnknown();
            }
        });
        end();
    }

    void values() {
        column("BRDF", "sr^-1", {}, [&](std::size_t at) { return std::max(rows_.f[at], 0.0); });
        if (rows_.uRandom.empty() || unknown_ > 0) return;
        column("uBRDF",
               "sr^-1",
               ", \"comments\": \"combined standard uncertainty, k = 1\"",
               [&](std::size_t at) { return uAt(at); });
    }

    static std::string described(std::string_view type, std::string_view description) {
        return ", \"type\": " + jsonString(type) + ", \"description\": " + jsonString(description);
    }

    void adhoc() {
        // uBRDF alone tells of combined uncertainties that are all known.
        const bool split = !rows_.uSystematic.empty() || (!rows_.uRandom.empty() && unknown_ > 0);
        const bool named = hasNames();
        if (!negative_ && !split && rows_.flags.empty() && !named) return;
        written_.bytes += ",\n\t\t\"adhoc_variables\": {\n";
        first_ = inAdhoc_ = true;
        if (negative_) {
            column("negative",
                   "sr^-1",
                   described("number", "The value where it is negative and BRDF is 0; else 0."),
                   [&](std::size_t at) { return std::min(rows_.f[at], 0.0); });
        }
        if (split) uncertainties();
        if (!rows_.flags.empty()) {
            column("flags", "1", described("integer", flagsSentence()), [&](std::size_t at) {
                return static_cast<double>(rows_.flags[at].mask());
            });
        }
        if (named) names();
        written_.bytes += "\n\t\t}";
    }
    void uncertainties() {
        const auto orUnknown = [](double u) { return known(u) ? u : std::nan(""); };
        column("u_random",
               "sr^-1",
               described("number", "Random part of the standard uncertainty, k = 1."),
               [&](std::size_t at) { return orUnknown(rows_.uRandom[at]); });
        if (rows_.uSystematic.empty()) return;
        column("u_systematic",
               "sr^-1",
               described("number", "Systematic part of the standard uncertainty, k = 1."),
               [&](std::size_t at) { return orUnknown(rows_.uSystematic[at]); });
    }
    static std::string flagsSentence() {
        std::string sentence = "Sum of:";
        for (int bit = 0; bit < kFlagCount; ++bit) {
            sentence += (bit == 0 ? " " : ", ") + std::to_string(1 << bit) + " " +
                        std::string(name(static_cast<Flag>(bit)));
        }
        return sentence + ".";
    }

    /// Names that the wavelength does not tell: those there are, and of several channels without a
    /// wavelength.
    [[nodiscard]] bool hasNames() const {
        const auto& channels = rows_.channels;
        return (!spectral_ && channels.size() > 1) ||
               std::any_of(channels.begin(), channels.end(), [](const Channel& channel) {
                   return !channel.name.empty();
               });
    }
    void names() {
        begin("channel", "", described("string", "What the value is of."));
        std::vector<std::string> quoted;
        for (const Channel& channel : rows_.channels) {
            const bool numbered = channel.name.empty() && !spectral_ && rows_.channels.size() > 1;
            quoted.push_back(jsonString(numbered ? "channel " + std::to_string(quoted.size() + 1)
                                                 : channel.name));
        }
        bool any = false;
        eachEntry([&](std::size_t, std::size_t at) {
            if (std::exchange(any, true)) written_.bytes += ',';
            written_.bytes += quoted[at % quoted.size()];
        });
        end();
    }

    const BrdfRows& rows_;
    const Metadata& about_;
    Written written_;
    std::vector<bool> holds_;
    std::size_t entries_ = 0;
    std::size_t unknown_ = 0;
    bool negative_ = false;
    bool spectral_ = false;
    bool first_ = true;  ///< of its object
    bool inAdhoc_ = false;
};

}  // namespace

Result<Written> writeBird(const BrdfRows& rows, const Metadata& about) {
    return Writer(rows, about).write();
}

}  // namespace gonio::proc
