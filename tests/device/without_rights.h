#pragma once
// A user who is not root, for as long as it lives.

#include <sys/fsuid.h>
#include <unistd.h>

namespace gonio::device_test {

/// This thread, and those it starts, without the right to open what only root may.
class WithoutRights {
public:
    WithoutRights() { setfsuid(kNobody); }
    ~WithoutRights() { setfsuid(geteuid()); }
    WithoutRights(const WithoutRights&) = delete;
    WithoutRights& operator=(const WithoutRights&) = delete;

private:
    static constexpr uid_t kNobody = 65534;
};

}  // namespace gonio::device_test
