// The numbers that a step leaves behind for its observers.  The manifest is channels.inl.
#pragma once

#include <span>
#include <string_view>

namespace cathlab {

struct Channels {
#define CATHLAB_CHANNEL(name, unit, doc) double name = 0.0;
#include "core/channels.inl"
#undef CATHLAB_CHANNEL
};

struct ChannelInfo {
    std::string_view name;
    std::string_view unit;
    std::string_view doc;
    double Channels::*value;
};

/// In the order of channels.inl, which is the order of the columns of trace.csv.
std::span<const ChannelInfo> channel_table();

/// nullptr where there is none of that name.
const ChannelInfo* find_channel(std::string_view name);

}  // namespace cathlab
