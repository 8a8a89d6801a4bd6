#include "daemon/problem.h"

#include <array>
#include <utility>

namespace gonio::daemon {
namespace {

constexpr std::array<std::pair<ErrorKind, std::string_view>, 8> kNames{{
    {ErrorKind::Internal, "internal"},
    {ErrorKind::Usage, "usage"},
    {ErrorKind::NoRig, "no-rig"},
    {ErrorKind::Busy, "busy"},
    {ErrorKind::Device, "device"},
    {ErrorKind::File, "file"},
    {ErrorKind::Quality, "quality"},
    {ErrorKind::Interrupted, "interrupted"},
}};

}  // namespace

std::string_view problemName(ErrorKind kind) {
    for (const auto& [known, name] : kNames) {
        if (known == kind) return name;
    }
    return "internal";
}

ErrorKind problemKind(std::string_view name) {
    for (const auto& [kind, known] : kNames) {
        if (known == name) return kind;
    }
    return ErrorKind::Internal;
}

}  // namespace gonio::daemon
