#include "effects/effect.h"

#include <array>

namespace cathlab {

#define CATHLAB_EFFECT(name) EffectInfo name##_effect();
#include "effects/effects.inl"
#undef CATHLAB_EFFECT

std::span<const EffectInfo> effect_table() {
    static const std::vector<EffectInfo> table{
#define CATHLAB_EFFECT(name) name##_effect(),
#include "effects/effects.inl"
#undef CATHLAB_EFFECT
    };
    return table;
}

const EffectInfo* find_effect(std::string_view name) {
    for (const EffectInfo& info : effect_table())
        if (info.name == name) return &info;
    return nullptr;
}

std::vector<std::string_view> hook_names(unsigned hooks) {
    constexpr std::array<std::string_view, 6> names{"input", "drive", "material", "constraint", "force", "measure"};
    std::vector<std::string_view> out;
    for (std::size_t i = 0; i < names.size(); ++i)
        if ((hooks >> i) & 1U) out.push_back(names[i]);
    return out;
}

}  // namespace cathlab
