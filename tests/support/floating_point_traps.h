#pragma once
// Invalid operations, divisions by zero and overflows end the test while one of these lives.

#include <cfenv>

namespace gonio::test {

class FloatingPointTraps {
public:
    FloatingPointTraps() { feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW); }
    ~FloatingPointTraps() { fedisableexcept(FE_ALL_EXCEPT); }
    FloatingPointTraps(const FloatingPointTraps&) = delete;
    FloatingPointTraps& operator=(const FloatingPointTraps&) = delete;
};

}  // namespace gonio::test
