#include "studio.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <future>
#include <optional>

#include "core/errors.h"
#include "core/log.h"
#include "imaging/video_writer.h"
#include "render/frame_renderer.h"

namespace cathlab {

struct Studio::Impl {
    Impl(const FilmOptions& options, bool apart)
        : renderer(make_gl_target(), Workers(options.draw_threads)), probe(options.probe), encode_apart(apart) {
        renderer.set_probe(probe);
        if (!options.path.empty())
            writer.emplace(options.path, options.width, options.height, options.fps, options.codec);
        at_close = options.at_close;
        dicom_path = options.dicom;
        dicom_facts = options.dicom_facts;
        frames = options.frames;
        frames_as_float = options.frames_as_float;
        if (frames.empty()) return;
        std::error_code error;
        std::filesystem::create_directories(frames, error);
        if (error) throw UserError("cannot make the folder '" + frames + "': " + error.message());
    }

    FrameRenderer renderer;
    std::optional<VideoWriter> writer;
    std::array<Image8, 2> pictures;  // in turn: one is encoded while the next is drawn
    std::function<void(std::string_view)> probe;
    bool encode_apart = false;
    std::size_t count = 0;
    std::string dicom_path, frames;
    DicomFacts dicom_facts;
    bool frames_as_float = false;
    std::optional<DicomWriter> dicom;  // opened at its first picture, whose size it takes
    std::size_t exposed = 0, open_pictures = 0;
    std::function<void(std::size_t, std::size_t)> at_close;
    std::future<void> encoding;  // destroyed, and so waited for, before what it works on

    Image8& last() { return pictures[(count + 1) % 2]; }
    // What only a picture that was exposed has.
    void keep_exposure(const FilmFrame& frame) {
        const FrameRect at = layout_of(frame.picture).fluoroscopy;
        if (at.width == 0 || !frame.picture.beam_on) return;
        ++exposed;
        if (renderer.bad_pixels() > 0) ++open_pictures;
        if (!dicom_path.empty()) {
            if (!dicom) {
                dicom_facts.pixel_mm = frame.picture.view.width_mm / at.width;
                dicom.emplace(dicom_path, dicom_facts, at.width, at.height);
            }
            dicom->add(renderer.fluoroscopy(), frame.machine);
        }
        if (frames.empty()) return;
        std::array<char, 16> name{};
        std::snprintf(name.data(), name.size(), "%06llu", static_cast<unsigned long long>(frame.picture.frame_index));
        const std::string path = frames + "/" + name.data();
        if (frames_as_float)
            write_floats(path + ".f32", renderer.detected());
        else  // 4096 is what the exposure control wants: the rest is room for what is brighter
            write_png16(path + ".png", renderer.detected(), 4096.0 / renderer.wanted_photons());
    }
    void wait() {
        if (encoding.valid()) encoding.get();
    }
};

Studio::Studio(const FilmOptions& options, bool encode_apart) : impl_(std::make_unique<Impl>(options, encode_apart)) {}

Studio::~Studio() = default;

void Studio::add(const FilmFrame& frame) {
    Impl& m = *impl_;
    Image8& picture = m.pictures[m.count % 2];
    m.renderer.render(frame.picture, picture);
    m.keep_exposure(frame);
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
    if (m.at_close) m.at_close(m.exposed, m.open_pictures);
    if (m.open_pictures > 0)
        log::warn("open surfaces: in " + std::to_string(m.open_pictures) +
                  " pictures some rays enter what they do not leave");
    if (!m.dicom_path.empty() && !m.dicom) throw UserError("'" + m.dicom_path + "': no picture was exposed");
    if (m.dicom) m.dicom->close();
    m.dicom.reset();
    m.dicom_path.clear();
}

}  // namespace cathlab
