#include "film.h"

#include <deque>
#include <optional>

#include "describe_frame.h"
#include "hud/hud.h"
#include "hud_fill.h"
#include "imaging/video_writer.h"
#include "render/frame_renderer.h"

namespace cathlab {
namespace {

constexpr std::size_t message_lines = 4;
constexpr double message_s = 4.0;

}  // namespace

struct Film::Impl {
    Impl(const SceneSpec& the_scene, const FilmOptions& the_options, int threads)
        : scene(the_scene),
          options(the_options),
          hud(static_cast<float>(the_options.height) / 512.0F),
          renderer(make_gl_target(), Workers(threads)) {
        if (!options.path.empty()) writer.emplace(options.path, options.width, options.height, options.fps);
        frame.width = options.width;
        frame.height = options.height;
        frame.seed = scene.seed;
    }

    SceneSpec scene;
    FilmOptions options;
    Hud hud;
    FrameRenderer renderer;
    std::optional<VideoWriter> writer;
    FrameDescription frame;
    HudData panels;
    std::deque<Event> messages;
    Image8 picture;
    std::size_t count = 0;
};

Film::Film(const SceneSpec& scene, const FilmOptions& options, int threads)
    : impl_(std::make_unique<Impl>(scene, options, threads)) {}

Film::~Film() = default;

bool Film::due(double time_s) const {
    return time_s * impl_->options.fps + 1e-9 >= static_cast<double>(impl_->count);
}

void Film::add(World& world, const Channels& channels) {
    Impl& m = *impl_;
    describe_frame(world, m.scene, channels, m.frame);
    m.frame.frame_index = m.count;
    fill_hud(m.scene, channels, m.panels);
    while (!m.messages.empty() && m.messages.front().time_s < channels.time_s - message_s) m.messages.pop_front();
    m.panels.messages.clear();
    for (const Event& event : m.messages) m.panels.messages.push_back(event.message);
    HudLayout layout;
    layout.width = static_cast<float>(m.options.width);
    layout.height = static_cast<float>(m.options.height);
    const FrameRect left = layout_of(m.frame).fluoroscopy;
    layout.split = static_cast<float>(left.x + left.width);
    m.hud.draw(m.panels, layout, m.frame.overlay);
    m.renderer.render(m.frame, m.picture);
    if (m.writer) m.writer->add(m.picture);
    ++m.count;
}

void Film::message(const Event& event) {
    // A command that is refused is refused in every step: the same sentence moves on instead of filling the lines.
    for (Event& known : impl_->messages) {
        if (known.kind != event.kind || known.entity != event.entity) continue;
        known = event;
        return;
    }
    impl_->messages.push_back(event);
    if (impl_->messages.size() > message_lines) impl_->messages.pop_front();
}

const Image8& Film::last() const {
    return impl_->picture;
}

std::size_t Film::frames() const {
    return impl_->count;
}

void Film::close() {
    if (impl_->writer && impl_->count > 0) impl_->writer->close();
    impl_->writer.reset();
}

}  // namespace cathlab
