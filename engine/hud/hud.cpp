#include "hud/hud.h"

#include "core/check.h"
#include "hud/ui_context.h"

namespace cathlab {
namespace {

float checked(float scale) {
    CATHLAB_CHECK(scale >= 0.5F && scale <= 4.0F, "HUD scale out of [0.5, 4]");
    return scale;
}

}  // namespace

struct Hud::Impl {
    Impl(float the_scale, const std::string& font_file)
        : scale(checked(the_scale)),
          // Sixteen pixels is the tallest text of the panels; smaller text is the same glyphs shrunk.
          context(16.0F * the_scale, false, font_file) {}
    float scale = 1;
    UiContext context;
};

Hud::Hud(float scale, const std::string& font_file) : impl_(std::make_unique<Impl>(scale, font_file)) {}

Hud::~Hud() = default;

float Hud::scale() const {
    return impl_->scale;
}

void Hud::draw(const HudData& data, HudLayout layout, HudDrawList& out) {
    layout.scale = impl_->scale;
    impl_->context.begin(layout.width, layout.height);
    draw_panels(data, layout);
    impl_->context.end(out);
}

}  // namespace cathlab
