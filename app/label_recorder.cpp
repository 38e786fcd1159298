#include "label_recorder.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "imaging/coco_writer.h"
#include "render/frame_renderer.h"
#include "render/labels.h"
#include "world/step_settings.h"

namespace cathlab {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t vertices_a_landmark = 12;

Json rounded(double v) {
    return std::round(v * 1000.0) / 1000.0;
}
Json place(const Vec2& p, int x, int y) {
    return {rounded(p.x() + x), rounded(p.y() + y)};
}
Json place(const Vec3& p) {
    return {rounded(p.x()), rounded(p.y()), rounded(p.z())};
}

// A place of the anatomy that goes along with the wall round it.
struct WallPoint {
    std::string name;
    Vec3 rest;
    Index node;
    std::vector<std::size_t> vertices;  // of the lumen, the nearest at rest
};

WallPoint wall_point(const std::string& name, const Vec3& rest, Index node, const std::vector<Vec3>& lumen) {
    std::vector<std::size_t> order(lumen.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto count = static_cast<std::ptrdiff_t>(std::min(vertices_a_landmark, order.size()));
    std::partial_sort(order.begin(), order.begin() + count, order.end(), [&](std::size_t a, std::size_t b) {
        return (lumen[a] - rest).squaredNorm() < (lumen[b] - rest).squaredNorm();
    });
    order.resize(static_cast<std::size_t>(count));
    return {name, rest, node, order};
}

}  // namespace

struct LabelRecorder::Impl {
    std::string film;
    std::unique_ptr<CocoWriter> writer;
    LabelSource source;
    std::vector<WallPoint> wall_points;
    std::vector<std::string> device_names;  // whose tips are key points, in their order

    // Of the last picture that was exposed.
    bool exposed = false;
    std::vector<CocoAnnotation> annotations;
    std::vector<CocoKeyPoint> key_points;
    Json view;

    void find_points(const FrameStage& stage, const ScenePoses& poses, const FrameDescription& frame);
    void label(const FrameStage& stage, const ScenePoses& poses, const FrameDescription& frame);
};

LabelRecorder::LabelRecorder(const std::string& path, const std::string& film, const FrameStage& stage,
                             const ScenePoses& poses)
    : impl_(std::make_unique<Impl>()) {
    Impl& m = *impl_;
    m.film = film;
    const AnatomyModel& anatomy = *stage.anatomy;
    std::vector<std::pair<std::string, std::string>> categories;
    std::vector<std::string> points;
    for (const DevicePose& device : poses.devices) {
        m.device_names.push_back(device.name);
        categories.emplace_back(device.name, "device");
        points.push_back(device.name + "_tip");
    }
    m.source.region = anatomy.lumen_region;
    for (const Region& region : anatomy.regions) {
        m.source.region_names.push_back(region.name);
        categories.emplace_back(region.name, "vessel");
    }
    for (const Landmark& landmark : anatomy.landmarks)
        m.wall_points.push_back(
            wall_point(landmark.name, landmark.pose.position, landmark.node, anatomy.lumen.vertices));
    if (anatomy.annulus) {
        const Vec3& middle = anatomy.annulus->pose.position;
        m.wall_points.push_back(
            wall_point("annulus", middle, anatomy.centreline.nearest(middle), anatomy.lumen.vertices));
    }
    for (const WallPoint& point : m.wall_points) points.push_back(point.name);
    m.writer =
        std::make_unique<CocoWriter>(path, "cathlab: simulated fluoroscopy, not for diagnosis", categories, points);
}

LabelRecorder::~LabelRecorder() = default;

void LabelRecorder::Impl::find_points(const FrameStage& stage, const ScenePoses& poses, const FrameDescription& frame) {
    source.points.clear();
    for (const std::string& name : device_names) {
        const auto device = std::find_if(frame.devices.begin(), frame.devices.end(),
                                         [&](const FrameDevice& d) { return d.name == name; });
        // The wire's points begin at its tip, the catheter's end there.
        const Vec3 tip = name == wire_entity ? device->points.front() : device->points.back();
        source.points.push_back({name + "_tip", tip, true});
    }
    const std::vector<Vec3>& rest = stage.anatomy->lumen.vertices;
    for (const WallPoint& point : wall_points) {
        Vec3 moved = Vec3::Zero();
        for (const std::size_t v : point.vertices) moved += frame.lumen.vertices[v] - rest[v];
        moved /= static_cast<double>(point.vertices.size());
        const bool filled = point.node >= 0 && static_cast<std::size_t>(point.node) < poses.contrast_mg_ml.size() &&
                            poses.contrast_mg_ml[static_cast<std::size_t>(point.node)] > source.seen_mg_ml;
        source.points.push_back({point.name, point.rest + moved, filled});
    }
}

void LabelRecorder::Impl::label(const FrameStage& stage, const ScenePoses& poses, const FrameDescription& frame) {
    const FrameRect at = layout_of(frame).fluoroscopy;
    find_points(stage, poses, frame);
    const FrameLabels labels = label_frame(frame, source, at.width, at.height, *stage.workers);
    annotations.clear();
    const auto mask = [&](const std::vector<std::uint8_t>& pixels) {
        return coco_mask(pixels, at.width, at.height, at.x, at.y, frame.width, frame.height);
    };
    // As COCO's amodal annotations have it [zhu2017]: what is seen of the mask, and the share of it that is not.
    const auto visible = [&](const FrameLabels::Mask& m, const CocoMask& whole) {
        const CocoMask seen = mask(m.visible);
        const double hidden =
            whole.area > 0 ? 1.0 - static_cast<double>(seen.area) / static_cast<double>(whole.area) : 0.0;
        return Json({{"visible_mask", {{"size", {frame.height, frame.width}}, {"counts", seen.counts}}},
                     {"visible_area", seen.area},
                     {"occlude_rate", rounded(hidden)}});
    };
    for (std::size_t i = 0; i < labels.devices.size(); ++i) {
        Json line_px = Json::array(), line_mm = Json::array();
        for (const Vec2& p : labels.lines[i].pixels) line_px.push_back(place(p, at.x, at.y));
        for (const Vec3& p : labels.lines[i].world) line_mm.push_back(place(p));
        CocoMask whole = mask(labels.devices[i].inside);
        Json facts = visible(labels.devices[i], whole);
        facts["centreline_px"] = line_px;
        facts["centreline_mm"] = line_mm;
        annotations.push_back({labels.devices[i].name, std::move(whole), facts.dump()});
    }
    for (const FrameLabels::Mask& region : labels.regions) {
        CocoMask whole = mask(region.inside);
        Json facts = visible(region, whole);
        annotations.push_back({region.name, std::move(whole), facts.dump()});
    }
    key_points.clear();
    Json world_points = Json::array();
    for (const FrameLabels::Point& p : labels.points) {
        key_points.push_back({p.pixel.x() + at.x, p.pixel.y() + at.y, p.visibility});
        world_points.push_back(place(p.world));
    }
    // To the whole picture's pixels: the fluoroscopy's place in it is added.
    std::array<double, 12> camera = labels.camera;
    for (std::size_t k = 0; k < 4; ++k) {
        camera[k] += at.x * camera[8 + k];
        camera[4 + k] += at.y * camera[8 + k];
    }
    view = {{"camera_matrix", camera},
            {"fluoroscopy", {at.x, at.y, at.width, at.height}},
            {"source_mm", place(frame.view.source)},
            {"detector_mm", place(frame.view.detector_center)},
            {"field_mm", {frame.view.width_mm, frame.view.height_mm}},
            {"kvp", rounded(frame.exposure.kvp)},
            {"keypoints_mm", world_points}};
}

void LabelRecorder::add(const FrameStage& stage, const ScenePoses& poses, const SceneSpec& scene,
                        const Channels& channels, const FrameDescription& frame) {
    Impl& m = *impl_;
    if (frame.beam_on) {
        m.label(stage, poses, frame);
        m.exposed = true;
    }
    Json facts = {{"frame", frame.frame_index}, {"beam_on", frame.beam_on}};
    for (const auto& [key, value] : m.view.items()) facts[key] = value;
    facts["sid_mm"] = scene.c_arm.sid_mm;
    facts["sod_mm"] = scene.c_arm.sod_mm;
    Json numbers;
    for (const ChannelInfo& channel : channel_table()) numbers[std::string(channel.name)] = channels.*channel.value;
    facts["channels"] = numbers;
    m.writer->add({m.film, frame.width, frame.height, facts.dump()},
                  m.exposed ? m.annotations : std::vector<CocoAnnotation>(),
                  m.exposed ? m.key_points : std::vector<CocoKeyPoint>());
}

void LabelRecorder::close() {
    impl_->writer->close();
}

}  // namespace cathlab
