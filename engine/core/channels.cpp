#include "core/channels.h"

#include <array>

namespace cathlab {

std::span<const ChannelInfo> channel_table() {
    static constexpr std::array table{
#define CATHLAB_CHANNEL(name, unit, doc) ChannelInfo{#name, unit, doc, &Channels::name},
#include "core/channels.inl"
#undef CATHLAB_CHANNEL
    };
    return table;
}

const ChannelInfo* find_channel(std::string_view name) {
    for (const ChannelInfo& c : channel_table())
        if (c.name == name) return &c;
    return nullptr;
}

}  // namespace cathlab
