#include "play/controls.h"

namespace cathlab::play {
namespace {

template <class... Texts>
constexpr auto texts(Texts... text) {
    return std::array<std::string_view, sizeof...(Texts)>{text...};
}
#define CATHLAB_CONTROL(name, kind, label, doc, ...) constexpr auto sources_of_##name = texts(__VA_ARGS__);
#include "play/controls.inl"
#undef CATHLAB_CONTROL

}  // namespace

std::span<const ControlInfo> control_table() {
    static constexpr std::array table{
#define CATHLAB_CONTROL(name, kind, label, doc, ...) \
    ControlInfo{Control::name, #name, ControlKind::kind, label, doc, sources_of_##name},
#include "play/controls.inl"
#undef CATHLAB_CONTROL
    };
    return table;
}

}  // namespace cathlab::play
