#include "daemon/cli/event_stream.h"

#include "proc/core/number_text.h"

namespace gonio::daemon {

std::vector<StreamEvent> EventStream::feed(std::string_view bytes) {
    std::vector<StreamEvent> done;
    rest_ += bytes;
    std::size_t begin = 0;
    for (std::size_t end = rest_.find('\n'); end != std::string::npos;
         end = rest_.find('\n', begin)) {
        line(std::string_view(rest_).substr(begin, end - begin), done);
        begin = end + 1;
    }
    rest_.erase(0, begin);
    return done;
}

void EventStream::line(std::string_view text, std::vector<StreamEvent>& done) {
    if (text.ends_with('\r')) text.remove_suffix(1);
    if (text.empty()) {
        if (!next_.data.empty()) done.push_back(next_);
        next_ = {};
        return;
    }
    const std::size_t colon = text.find(':');
    if (colon == 0 || colon == std::string_view::npos) return;
    std::string_view value = text.substr(colon + 1);
    if (value.starts_with(' ')) value.remove_prefix(1);
    const std::string_view field = text.substr(0, colon);
    if (field == "id") {
        const std::int64_t number = parseInteger(value).value_or(0);
        next_.id = number > 0 ? static_cast<std::uint64_t>(number) : 0;
    } else if (field == "event") {
        next_.type = value;
    } else if (field == "data") {
        next_.data += (next_.data.empty() ? "" : "\n") + std::string(value);
    }
}

}  // namespace gonio::daemon
