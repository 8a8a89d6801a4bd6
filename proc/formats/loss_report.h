#pragma once
// What a file format could not hold. Every writer returns one; an empty report means that reading
// the file back gives the same.

#include <cstddef>
#include <string>
#include <vector>

namespace gonio::proc {

struct LossReport {
    struct Item {
        std::string what;  ///< "nodes without data, written as 0"
        std::size_t count = 0;

        bool operator==(const Item&) const = default;
    };
    std::vector<Item> items;

    /// Ignores a count of 0.
    void add(std::string what, std::size_t count) {
        if (count > 0) items.push_back({std::move(what), count});
    }
};

/// Bytes of a file and what they leave out.
struct Written {
    std::string bytes;
    LossReport loss;
};

}  // namespace gonio::proc
