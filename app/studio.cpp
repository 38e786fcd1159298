#include "studio.h"

#include <array>
#include <future>
#include <optional>

#include "imaging/video_writer.h"
#include "render/frame_renderer.h"

namespace cathlab {

struct Studio::Impl {
    Impl(const FilmOptions& options, bool apart)
        : renderer(make_gl_target()), probe(options.probe), encode_apart(apart) {
        renderer.set_probe(probe);
        if (!options.path.empty()) writer.emplace(options.path, options.width, options.height, options.fps);
    }

    FrameRenderer renderer;
    std::optional<VideoWriter> writer;
    std::array<Image8, 2> pictures;  // in turn: one is encoded while the next is drawn
    std::function<void(std::string_view)> probe;
    bool encode_apart = false;
    std::size_t count = 0;
    std::future<void> encoding;  // destroyed, and so waited for, before what it works on

    Image8& last() { return pictures[(count + 1) % 2]; }
    void wait() {
        if (encoding.valid()) encoding.get();
    }
};

Studio::Studio(const FilmOptions& options, bool encode_apart) : impl_(std::make_unique<Impl>(options, encode_apart)) {}

Studio::~Studio() = default;

void Studio::add(const FrameDescription& frame) {
    Impl& m = *impl_;
    Image8& picture = m.pictures[m.count % 2];
    m.renderer.render(frame, picture);
    ++m.count;
    if (m.probe) m.probe(m.writer ? "encoder" : "");
    if (m.writer && m.encode_apart) {
        m.wait();
        m.encoding = std::async(std::launch::async, [&writer = *m.writer, &picture] { writer.add(picture); });
    } else if (m.writer) {
        m.writer->add(picture);
    }
    if (m.probe) m.probe("");
}

const Image8& Studio::last() const {
    return impl_->last();
}

void Studio::close() {
    Impl& m = *impl_;
    m.wait();
    if (m.writer && m.count > 0) m.writer->close();
    m.writer.reset();
}

}  // namespace cathlab
