#include "tests/driver/allocation_watch.h"

#include <pthread.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>

#include "driver/hid_channel.h"
#include "driver/usb_stream.h"

namespace gonio::driver::test {
namespace {

std::atomic<int> onTheirWay = 0;
std::atomic<std::size_t> allocations = 0, copied = 0;
thread_local bool watcher = false;
thread_local int unwatched = 0;

bool onTheDriversThread() {
    std::array<char, 16> name{};
    pthread_getname_np(pthread_self(), name.data(), name.size());
    return std::strcmp(name.data(), kStreamThread) == 0 ||
           std::strcmp(name.data(), kReportThread) == 0;
}

bool watched() {
    if (onTheirWay == 0) return false;
    return watcher ? unwatched == 0 : onTheDriversThread();
}

void note() {
    if (watched()) ++allocations;
}

}  // namespace

void noteCopy(std::size_t size) {
    if (watched()) copied += size;
}

Spent takeSpent() {
    return {.allocations = allocations.exchange(0), .bytesCopied = copied.exchange(0)};
}

void captureArmed() {
    watcher = true;
    ++onTheirWay;
}

void captureTaken() { --onTheirWay; }

Unwatched::Unwatched() { ++unwatched; }
Unwatched::~Unwatched() { --unwatched; }

}  // namespace gonio::driver::test

// In place of the library's, in a file of its own: the compiler must not see both ends of a pair.
void* operator new(std::size_t size) {
    gonio::driver::test::note();
    if (void* memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
    gonio::driver::test::note();
    return std::malloc(size);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

// What the linker calls in place of memcpy and memmove where it is told to (--wrap).
extern "C" {
void* __real_memcpy(void* to, const void* from, std::size_t size);
void* __real_memmove(void* to, const void* from, std::size_t size);
void* __wrap_memcpy(void* to, const void* from, std::size_t size) {
    gonio::driver::test::noteCopy(size);
    return __real_memcpy(to, from, size);
}
void* __wrap_memmove(void* to, const void* from, std::size_t size) {
    gonio::driver::test::noteCopy(size);
    return __real_memmove(to, from, size);
}
}
