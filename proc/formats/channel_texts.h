#pragma once
// Names of channels as a file's columns can have them: each comes back as the channel that it is
// of, and no two are the same. A name that would end its line, be another's column or read as a
// wavelength gets its number in front.

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proc/table/channel.h"

namespace gonio::proc {

/// How a format calls a channel.
struct ChannelNaming {
    /// What of it the column's name can say.
    std::function<Channel(const Channel&)> plain;
    std::function<std::string(const Channel&)> text;
    /// The reader's: none where it refuses such a column.
    std::function<std::optional<Channel>(std::string_view)> back;
};

struct ChannelTexts {
    std::vector<std::string> texts;  ///< one for each channel
    std::size_t changed = 0;         ///< names that come back as others
};

[[nodiscard]] ChannelTexts channelTexts(const std::vector<Channel>& channels,
                                        const ChannelNaming& naming);

}  // namespace gonio::proc
