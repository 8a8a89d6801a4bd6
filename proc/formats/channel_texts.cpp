#include "proc/formats/channel_texts.h"

#include <set>

namespace gonio::proc {
namespace {

class Chooser {
public:
    Chooser(const ChannelNaming& naming, bool several) : naming_(naming), several_(several) {}

    /// The name under which channel `number` is written, from 1.
    std::string choose(const Channel& channel, std::size_t number, ChannelTexts& into) {
        const std::string numbered = "channel " + std::to_string(number);
        std::vector<std::string> names{channel.name};
        if (!channel.name.empty()) names.push_back(numbered + " " + channel.name);
        names.push_back(numbered);
        for (std::size_t i = 0;; ++i) {
            if (i == names.size()) names.push_back(numbered + " (" + std::to_string(i) + ")");
            const Channel one = naming_.plain({names[i], channel.nanometres});
            if (taken(one, into)) return one.name;
        }
    }

private:
    /// A channel of which nothing is known has no name only where it is the only one.
    bool taken(const Channel& one, ChannelTexts& into) {
        if (several_ && one == Channel{}) return false;
        std::string text = naming_.text(one);
        if (naming_.back(text) != one || !used_.insert(text).second) return false;
        into.texts.push_back(std::move(text));
        return true;
    }

    const ChannelNaming& naming_;
    bool several_;
    std::set<std::string> used_;
};

}  // namespace

ChannelTexts channelTexts(const std::vector<Channel>& channels, const ChannelNaming& naming) {
    ChannelTexts made;
    Chooser chooser(naming, channels.size() > 1);
    for (const Channel& channel : channels) {
        const std::string name = chooser.choose(channel, made.texts.size() + 1, made);
        made.changed += !channel.name.empty() && name != channel.name ? 1U : 0U;
    }
    return made;
}

}  // namespace gonio::proc
