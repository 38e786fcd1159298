#include "film.h"

#include <algorithm>
#include <optional>

#include "describe_frame.h"
#include "film_queue.h"
#include "hud/hud.h"
#include "hud_fill.h"
#include "label_recorder.h"
#include "message_lines.h"
#include "render/frame_renderer.h"

namespace cathlab {
namespace {

constexpr std::size_t queue_slots = 4;  // pictures that a slow moment of the film may lag behind

DicomFrame machine_of(const Channels& channels, const ViewChange& view) {
    DicomFrame out;
    out.primary_deg = view.primary_deg.value_or(channels.primary_angle_deg);
    out.secondary_deg = view.secondary_deg.value_or(channels.secondary_angle_deg);
    out.kvp = view.kvp.value_or(channels.tube_voltage_kvp);
    out.dose_area_gycm2 = channels.dose_area_product_gycm2;
    out.air_kerma_mgy = channels.air_kerma_mgy;
    out.beam_time_s = channels.beam_time_s;
    return out;
}

}  // namespace

ThreadShares share_threads(int threads, bool with_film) {
    if (!with_film || threads < 2) return {threads, 0};
    const int film = threads < 4 ? 1 : 2;
    return {threads - film, film};
}

struct Film::Impl {
    Impl(const SceneSpec& the_scene, const FilmOptions& the_options, int threads)
        : scene(the_scene),
          options(the_options),
          hud(std::clamp(static_cast<float>(the_options.height) / 512.0F, 0.5F, 4.0F)),
          queue(the_options, threads, queue_slots) {}

    void lay_out(FrameDescription& frame, const Channels& channels) {
        if (options.view.alone) {
            frame.overlay = {};
            return;
        }
        fill_hud(scene, channels, panels);
        messages.at(channels.time_s, panels.messages);
        HudLayout layout;
        layout.width = static_cast<float>(options.width);
        layout.height = static_cast<float>(options.height);
        const FrameRect left = layout_of(frame).fluoroscopy;
        layout.split = static_cast<float>(left.x + left.width);
        hud.draw(panels, layout, frame.overlay);
    }

    SceneSpec scene;
    FilmOptions options;
    Hud hud;  // on the caller's thread: ImGui has one current context in a process
    FilmQueue queue;
    std::optional<FrameCamera> camera;  // of the picture before
    FrameMemory memory;
    ScenePoses poses;
    HudData panels;
    MessageLines messages;
    std::unique_ptr<LabelRecorder> labels;
    double pulse = 0.0, series = 0.0;  // of the last picture that was exposed
    std::size_t count = 0;
};

Film::Film(const SceneSpec& scene, const FilmOptions& options, int threads)
    : impl_(std::make_unique<Impl>(scene, options, threads)) {}

Film::~Film() = default;

bool Film::due(double time_s) const {
    const double since_s = time_s - impl_->options.view.from_s;
    return since_s * impl_->options.fps + 1e-9 >= static_cast<double>(impl_->count);
}

void Film::add(World& world, const Channels& channels) {
    if (impl_->options.probe) impl_->options.probe("describe");
    take_poses(world, impl_->poses);
    add(stage_of(world), impl_->poses, channels);
}

void Film::add(const FrameStage& stage, const ScenePoses& poses, const Channels& channels) {
    Impl& m = *impl_;
    FilmFrame& film_frame = m.queue.next();
    FrameDescription& frame = film_frame.picture;
    frame.width = m.options.width;
    frame.height = m.options.height;
    frame.seed = m.scene.seed;
    frame.frame_index = m.count;
    frame.inner_camera = m.camera;
    describe_frame(stage, poses, m.scene, channels, m.options.view, m.memory, frame);
    // Between two pulses the last picture is held; the pedal's first picture does not wait for a pulse.
    const double pulse = channels.exposures, series = channels.exposure_series;
    if (!m.options.view.beam_on && pulse == m.pulse && series == m.series) frame.beam_on = false;
    if (frame.beam_on) {
        m.pulse = pulse;
        m.series = series;
    }
    film_frame.machine = machine_of(channels, m.options.view);
    m.camera = frame.inner_camera;
    if (m.options.probe) m.options.probe("panels");
    m.lay_out(frame, channels);
    if (!m.options.labels.empty()) {
        if (!m.labels) m.labels = std::make_unique<LabelRecorder>(m.options.labels, m.options.path, stage, poses);
        m.labels->add(stage, poses, m.scene, channels, frame);
    }
    ++m.count;
    m.queue.submit();
}

void Film::message(const Event& event) {
    impl_->messages.add(event);
}

void Film::keep_poster() {
    impl_->queue.keep_poster();
}

Image8 Film::poster() {
    return impl_->queue.poster();
}

std::size_t Film::frames() const {
    return impl_->count;
}

bool Film::failed() const {
    return impl_->queue.failed();
}

void Film::close() {
    impl_->queue.close();
    if (impl_->labels) impl_->labels->close();
    impl_->labels.reset();
}

}  // namespace cathlab
