#include "proc/core/parallel.h"

#include <algorithm>
#include <thread>
#include <vector>

namespace gonio {

void parallelFor(std::size_t count, const std::function<void(IndexRange)>& work) {
    if (count == 0) return;
    const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
    const std::size_t parts = std::min(cores, count);
    const auto part = [&](std::size_t i) {
        return IndexRange{count * i / parts, count * (i + 1) / parts};
    };
    std::vector<std::jthread> threads;
    threads.reserve(parts - 1);
    for (std::size_t i = 1; i < parts; ++i) {
        threads.emplace_back([&work, range = part(i)] { work(range); });
    }
    work(part(0));
}

}  // namespace gonio
