#include "render/frame_renderer.h"

#include <algorithm>
#include <utility>

#include "core/errors.h"
#include "render/fluoroscope.h"
#include "render/gl_device.h"
#include "render/inner_view.h"
#include "render/outer_view.h"
#include "render/overlay.h"

namespace cathlab {

FrameLayout layout_of(const FrameDescription& frame) {
    FrameLayout layout;
    const int w = frame.width, h = frame.height;
    const int beside = int{frame.show_inner_view} + int{frame.show_outer_view} + int{frame.show_reference};
    FrameRect rest{0, 0, w, h};
    if (frame.show_fluoroscopy) {
        const int side = beside > 0 ? std::min(h, w / 2) : std::min(h, w);
        layout.fluoroscopy = {beside > 0 ? 0 : (w - side) / 2, (h - side) / 2, side, side};
        rest = {side, (h - side) / 2, w - side, side};
    }
    int place = 0;
    const auto next = [&](bool shown, FrameRect& out) {
        if (!shown) return;
        const int top = rest.height * place / beside, bottom = rest.height * (place + 1) / beside;
        out = {rest.x, rest.y + top, rest.width, bottom - top};
        ++place;
    };
    next(frame.show_inner_view, layout.inner_view);
    next(frame.show_outer_view, layout.outer_view);
    next(frame.show_reference, layout.reference);
    return layout;
}

struct FrameRenderer::Impl {
    Impl(std::unique_ptr<GlTarget> target, const Workers& the_workers)
        : device(std::make_shared<GlDevice>(std::move(target))),
          workers(the_workers),
          fluoroscope(workers),
          inner_view(device),
          outer_view(device),
          overlay(device) {}
    GlDevicePtr device;
    Workers workers;
    Fluoroscope fluoroscope;
    InnerView inner_view;
    OuterView outer_view;
    Overlay overlay;
    Image8 part;
    std::function<void(std::string_view)> probe;

    void begin(std::string_view name) const {
        if (probe) probe(name);
    }

    // The largest centred square of its place, sampled at the nearest pixel; black without a reference.
    void paste_reference(const FrameLayout& layout, Image8& out) const {
        const std::vector<std::uint8_t>& grey = fluoroscope.reference();
        const auto from = static_cast<std::size_t>(layout.fluoroscopy.width);
        if (grey.empty() || grey.size() != from * from) return;
        const FrameRect& r = layout.reference;
        const int side = std::min(r.width, r.height);
        for (int y = 0; y < side; ++y) {
            std::uint8_t* row =
                out.rgb.data() + out.offset(r.x + (r.width - side) / 2, r.y + (r.height - side) / 2 + y);
            const std::size_t source = from * static_cast<std::size_t>(y) / static_cast<std::size_t>(side) * from;
            for (int x = 0; x < side; ++x, row += 3)
                row[0] = row[1] = row[2] =
                    grey[source + from * static_cast<std::size_t>(x) / static_cast<std::size_t>(side)];
        }
    }
};

FrameRenderer::FrameRenderer(std::unique_ptr<GlTarget> target, const Workers& workers)
    : impl_(std::make_unique<Impl>(std::move(target), workers)) {}
FrameRenderer::~FrameRenderer() = default;

void FrameRenderer::render(const FrameDescription& frame, Image8& out) {
    if (frame.width < 64 || frame.height < 64 || frame.width > 8192 || frame.height > 8192) {
        throw UserError("a picture of " + std::to_string(frame.width) + "x" + std::to_string(frame.height) +
                        " cannot be drawn: width and height must lie in [64, 8192]");
    }
    if (out.width != frame.width || out.height != frame.height) out = Image8(frame.width, frame.height);
    const FrameLayout layout = layout_of(frame);
    std::fill(out.rgb.begin(), out.rgb.end(), std::uint8_t{0});
    if (layout.fluoroscopy.width > 0) {
        impl_->begin("fluoroscopy");
        const FrameRect& r = layout.fluoroscopy;
        const std::vector<std::uint8_t>& grey = impl_->fluoroscope.draw(frame, r.width, r.height);
        impl_->workers.for_ranges(static_cast<std::size_t>(r.height), 32, [&](std::size_t begin, std::size_t end) {
            for (std::size_t y = begin; y < end; ++y) {
                std::uint8_t* row = out.rgb.data() + out.offset(r.x, r.y + static_cast<int>(y));
                const std::uint8_t* from = grey.data() + y * static_cast<std::size_t>(r.width);
                for (int x = 0; x < r.width; ++x, row += 3) row[0] = row[1] = row[2] = from[x];
            }
        });
    }
    if (layout.inner_view.width > 0) {
        impl_->begin("inner view");
        impl_->inner_view.draw(frame, layout.inner_view.width, layout.inner_view.height, impl_->part);
        paste(out, impl_->part, layout.inner_view.x, layout.inner_view.y);
    }
    if (layout.outer_view.width > 0) {
        impl_->begin("outer view");
        impl_->outer_view.draw(frame, layout.outer_view.width, layout.outer_view.height, impl_->part);
        paste(out, impl_->part, layout.outer_view.x, layout.outer_view.y);
    }
    if (layout.reference.width > 0) impl_->paste_reference(layout, out);
    impl_->begin("overlay");
    impl_->overlay.draw(frame.overlay, out);
}

std::size_t FrameRenderer::bad_pixels() const {
    return impl_->fluoroscope.bad_pixels();
}
const ImageF& FrameRenderer::intensity() const {
    return impl_->fluoroscope.intensity();
}
const ImageF& FrameRenderer::detected() const {
    return impl_->fluoroscope.detected();
}
const std::vector<std::uint8_t>& FrameRenderer::fluoroscopy() const {
    return impl_->fluoroscope.grey();
}
const std::vector<std::uint8_t>& FrameRenderer::reference() const {
    return impl_->fluoroscope.reference();
}
bool FrameRenderer::has_roadmap() const {
    return impl_->fluoroscope.has_roadmap();
}
double FrameRenderer::wanted_photons() const {
    return impl_->fluoroscope.wanted_photons();
}
void FrameRenderer::reset() {
    impl_->fluoroscope.reset();
}
std::string FrameRenderer::description() const {
    return impl_->device->description();
}
void FrameRenderer::set_probe(std::function<void(std::string_view)> begin) {
    impl_->probe = std::move(begin);
}
void FrameRenderer::set_fluoroscopy_probe(std::function<void(std::string_view)> begin) {
    impl_->fluoroscope.set_probe(std::move(begin));
}

}  // namespace cathlab
