#include "tests/formats/allocation_peak.h"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> held = 0;
std::atomic<std::size_t> most = 0;

void* counted(void* memory) noexcept {
    const std::size_t now = held += malloc_usable_size(memory);
    std::size_t seen = most;
    while (now > seen && !most.compare_exchange_weak(seen, now)) {
    }
    return memory;
}

void release(void* memory) noexcept {
    held -= malloc_usable_size(memory);
    std::free(memory);
}

}  // namespace

gonio::test::AllocationPeak::AllocationPeak() : held_(held) { most = held_; }
std::size_t gonio::test::AllocationPeak::bytes() const { return most - held_; }

// In place of the library's, in a file of its own: the compiler must not see both ends of a pair.
void* operator new(std::size_t size) {
    if (void* memory = std::malloc(size)) return counted(memory);
    throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
    return counted(std::malloc(size));
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
