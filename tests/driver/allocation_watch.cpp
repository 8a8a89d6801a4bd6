#include "tests/driver/allocation_watch.h"

#include <pthread.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>

#include "driver/usb_stream.h"

namespace gonio::driver::test {
namespace {

std::atomic<bool> watching = false;
std::atomic<std::size_t> seen = 0;
thread_local bool watcher = false;
thread_local int unwatched = 0;

bool onStreamThread() {
    std::array<char, 16> name{};
    pthread_getname_np(pthread_self(), name.data(), name.size());
    return std::strcmp(name.data(), kStreamThread) == 0;
}

void note() {
    if (!watching) return;
    if (watcher ? unwatched == 0 : onStreamThread()) ++seen;
}

}  // namespace

std::size_t allocationsSeen() { return seen; }

void startWatching() {
    watcher = true;
    seen = 0;
    watching = true;
}

void stopWatching() { watching = false; }

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
