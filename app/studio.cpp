#include "studio.h"

#include <optional>

#include "imaging/video_writer.h"
#include "render/frame_renderer.h"

namespace cathlab {

struct Studio::Impl {
    Impl(const FilmOptions& options, const Workers& workers)
        : renderer(make_gl_target(), workers), probe(options.probe) {
        renderer.set_probe(probe);
        if (!options.path.empty()) writer.emplace(options.path, options.width, options.height, options.fps);
    }

    FrameRenderer renderer;
    std::optional<VideoWriter> writer;
    Image8 picture;
    std::function<void(std::string_view)> probe;
    bool empty = true;
};

Studio::Studio(const FilmOptions& options, const Workers& workers) : impl_(std::make_unique<Impl>(options, workers)) {}

Studio::~Studio() = default;

void Studio::add(const FrameDescription& frame) {
    impl_->renderer.render(frame, impl_->picture);
    if (impl_->probe) impl_->probe(impl_->writer ? "encoder" : "");
    if (impl_->writer) impl_->writer->add(impl_->picture);
    if (impl_->probe) impl_->probe("");
    impl_->empty = false;
}

const Image8& Studio::last() const {
    return impl_->picture;
}

void Studio::close() {
    if (impl_->writer && !impl_->empty) impl_->writer->close();
    impl_->writer.reset();
}

}  // namespace cathlab
