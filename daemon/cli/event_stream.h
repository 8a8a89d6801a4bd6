#pragma once
// Server-sent events, the reading side (WHATWG HTML, 9.2): bytes as they come in, whole events out.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::daemon {

struct StreamEvent {
    std::uint64_t id = 0;
    std::string type;
    std::string data;
};

class EventStream {
public:
    /// The events that these bytes complete. Comments and unknown fields are skipped.
    std::vector<StreamEvent> feed(std::string_view bytes);

private:
    void line(std::string_view text, std::vector<StreamEvent>& done);
    std::string rest_;
    StreamEvent next_;
};

}  // namespace gonio::daemon
