#include "proc/table/metadata.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

constexpr std::string_view kPrefix = "gonio.";
constexpr std::string_view kExtra = "extra.";
constexpr std::string_view kComment = "comment.";

using Text = std::string SampleInfo::*;
constexpr std::array<std::pair<std::string_view, Text>, 13> kTexts{{
    {key::kSample, &SampleInfo::name},
    {key::kRig, &SampleInfo::rigSerial},
    {"profile_hash", &SampleInfo::profileHash},
    {key::kCalibration, &SampleInfo::calibrationId},
    {key::kSession, &SampleInfo::session},
    {key::kDate, &SampleInfo::dateUtc},
    {key::kNotes, &SampleInfo::operatorNotes},
    {key::kSoftware, &SampleInfo::softwareVersion},
    {key::kEffort, &SampleInfo::effort},
    {key::kReference, &SampleInfo::referenceCertificate},
    {key::kQuality, &SampleInfo::qcVerdicts},
    {"truth", &SampleInfo::truthSpec},
    {"budget", &SampleInfo::budgetJson},
}};
using Seconds = double SampleInfo::*;
constexpr std::array<std::pair<std::string_view, Seconds>, 2> kSeconds{{
    {"rig_seconds", &SampleInfo::rigSeconds},
    {"compute_seconds", &SampleInfo::computeSeconds},
}};
using Share = std::optional<double> SampleInfo::*;
constexpr std::array<std::pair<std::string_view, Share>, 2> kShares{{
    {"requested_uncertainty", &SampleInfo::requestedUncertainty},
    {"achieved_uncertainty", &SampleInfo::achievedUncertainty},
}};
constexpr std::string_view kInterruptions = "interruptions";

std::string onOneLine(std::string_view text) {
    std::string line;
    line.reserve(text.size());
    for (const char c : text) {
        if (c == '\n') {
            line += "\\n";
        } else if (c == '\r') {
            line += "\\r";
        } else if (c == '\\') {
            line += "\\\\";
        } else {
            line += c;
        }
    }
    return line;
}

std::string asItWas(std::string_view line) {
    std::string text;
    text.reserve(line.size());
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char next = line[i] == '\\' && i + 1 < line.size() ? line[i + 1] : ' ';
        if (line[i] == '\\' && (next == 'n' || next == 'r' || next == '\\')) {
            text += next == 'n' ? '\n' : next == 'r' ? '\r' : '\\';
            ++i;
        } else {
            text += line[i];
        }
    }
    return text;
}

/// Has SampleInfo a member of its own for this key?
bool isMember(std::string_view name) {
    const auto among = [name](const auto& members) {
        return std::any_of(members.begin(), members.end(), [name](const auto& member) {
            return member.first == name;
        });
    };
    return among(kTexts) || among(kSeconds) || among(kShares) || name == kInterruptions;
}

/// Puts a value into the member that it is of; false for a key without one.
bool placed(SampleInfo& info, std::string_view name, const std::string& value) {
    for (const auto& [known, member] : kTexts) {
        if (known == name) {
            info.*member = value;
            return true;
        }
    }
    const std::optional<double> number = parseDouble(value);
    for (const auto& [known, member] : kSeconds) {
        if (known == name && number) {
            info.*member = *number;
            return true;
        }
    }
    for (const auto& [known, member] : kShares) {
        if (known == name && number) {
            info.*member = number;
            return true;
        }
    }
    if (const auto count = parseInteger(value); name == kInterruptions && count && *count >= 0) {
        info.interruptions = static_cast<int>(std::min<std::int64_t>(*count, 1'000'000));
        return true;
    }
    return false;
}

}  // namespace

std::string_view Metadata::at(std::string_view name) const {
    const auto found = values.find(name);
    return found == values.end() ? std::string_view() : std::string_view(found->second);
}

void Metadata::set(std::string_view name, std::string value) {
    if (!value.empty()) values.insert_or_assign(std::string(name), std::move(value));
}

std::vector<std::string> metadataLines(const Metadata& about) {
    std::vector<std::string> lines;
    for (const auto& [name, value] : about.values) {
        if (name == key::kCosine) continue;
        lines.push_back(std::string(kPrefix) + onOneLine(name) + ": " + onOneLine(value));
    }
    lines.insert(lines.end(), about.comments.begin(), about.comments.end());
    return lines;
}

Metadata metadataOfLines(std::span<const std::string> lines) {
    Metadata about;
    for (const std::string& line : lines) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with(kPrefix) && colon != std::string::npos) {
            const std::string_view name =
                std::string_view(line).substr(kPrefix.size(), colon - kPrefix.size());
            if (name == key::kCosine) continue;
            about.set(asItWas(name), asItWas(std::string_view(line).substr(colon + 2)));
        } else {
            about.comments.push_back(line);
        }
    }
    return about;
}

Metadata metadataOf(const SampleInfo& info) {
    Metadata about;
    for (const auto& [name, member] : kTexts) about.set(name, info.*member);
    for (const auto& [name, member] : kSeconds) {
        if (info.*member != 0) about.set(name, shortest(info.*member));
    }
    for (const auto& [name, member] : kShares) {
        const std::optional<double> share = info.*member;
        if (share && std::isfinite(*share)) about.set(name, shortest(*share));
    }
    if (info.interruptions > 0) about.set(kInterruptions, std::to_string(info.interruptions));
    std::map<std::size_t, std::string> comments;
    for (const auto& [name, value] : info.extra) {
        const auto number = name.starts_with(kComment)
                                ? parseInteger(std::string_view(name).substr(kComment.size()))
                                : std::nullopt;
        if (number && *number >= 0) {
            comments[static_cast<std::size_t>(*number)] = value;
        } else {
            const bool taken = isMember(name) || name.starts_with(kExtra);
            about.set(taken ? std::string(kExtra) + name : name, value);
        }
    }
    for (auto& [number, line] : comments) about.comments.push_back(std::move(line));
    return about;
}

SampleInfo infoOf(const Metadata& about) {
    SampleInfo info;
    for (const auto& [name, value] : about.values) {
        if (placed(info, name, value)) continue;
        const bool ours = name.starts_with(kExtra);
        info.extra[ours ? name.substr(kExtra.size()) : name] = value;
    }
    for (std::size_t i = 0; i < about.comments.size(); ++i) {
        info.extra[std::string(kComment) + std::to_string(i + 1)] = about.comments[i];
    }
    return info;
}

}  // namespace gonio::proc
