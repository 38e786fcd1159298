#include "effects/effect.h"

#include <algorithm>
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

void ask_membrane(std::span<Effect* const> effects, const EffectContext& context, const MembraneMaterial& material,
                  const Fibres& fibres, MembranePoint& point) {
    const Vec3 c = point.c;
    for (Effect* effect : effects) effect->strain(context, point);
    ask_elastic_law(material, fibres, point);
    for (Effect* effect : effects) effect->stress(context, point);
    for (Effect* effect : effects) effect->share(context, c, {effects, context, material, fibres, *effect}, point);
}

void RestOfWall::ask(MembranePoint& point) const {
    for (Effect* effect : effects_)
        if (effect != &without_) effect->strain(context_, point);
    ask_elastic(point);
    for (Effect* effect : effects_) effect->stress(context_, point);
}

const EffectInfo* find_effect(std::string_view name) {
    std::string key(name);
    std::replace(key.begin(), key.end(), '-', '_');
    for (const EffectInfo& info : effect_table())
        if (info.name == key) return &info;
    return nullptr;
}

std::string spoken_name(const EffectInfo& info) {
    std::string out(info.name);
    std::replace(out.begin(), out.end(), '_', '-');
    return out;
}

std::vector<std::string_view> hook_names(unsigned hooks) {
    constexpr std::array<std::string_view, 9> names{"input",   "drive",     "material", "constraint", "force",
                                                    "measure", "actuation", "membrane", "slip"};
    std::vector<std::string_view> out;
    for (std::size_t i = 0; i < names.size(); ++i)
        if ((hooks >> i) & 1U) out.push_back(names[i]);
    return out;
}

}  // namespace cathlab
