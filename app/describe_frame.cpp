#include "describe_frame.h"

#include <algorithm>
#include <cmath>

#include "world/step_settings.h"

namespace cathlab {
namespace {

void describe_solids(const AnatomyModel& anatomy, FrameDescription& frame) {
    if (frame.solids_revision != 0) return;
    frame.solids_revision = 1;
    for (const ContextSolid& solid : anatomy.context) {
        FrameSolid out;
        out.material = solid.material;
        out.surrounding = "air";
        for (const ContextSolid& outer : anatomy.context)
            if (outer.name == solid.inside) out.surrounding = outer.material;
        out.mesh = solid.mesh;
        frame.solids.push_back(std::move(out));
    }
}

void describe_contrast(const FrameStage& stage, const std::vector<double>& concentration, FrameMemory& memory,
                       FrameLumen& lumen) {
    if (concentration.empty()) {
        lumen.contrast_mg_ml.clear();
        return;
    }
    const AnatomyModel& anatomy = *stage.anatomy;
    const std::vector<Vec3>& vertices = anatomy.lumen.vertices;
    if (memory.along.size() != vertices.size())
        memory.along = along_vessels(anatomy.centreline, vertices, anatomy.lumen_region, *stage.workers);
    lumen.contrast_mg_ml.resize(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i)
        lumen.contrast_mg_ml[i] = concentration_at(memory.along[i], concentration);
}

void describe_lumen(const FrameStage& stage, const ScenePoses& poses, FrameMemory& memory, FrameLumen& lumen) {
    lumen.vertices = poses.lumen;
    if (lumen.topology_revision == 0) {
        lumen.topology_revision = 1;
        lumen.triangles = stage.anatomy->lumen.triangles;
        lumen.radius_mm = stage.anatomy->lumen_radius;
    }
    const auto& rest = stage.anatomy->lumen.vertices;
    lumen.displacement_mm.resize(rest.size());
    for (std::size_t i = 0; i < rest.size(); ++i)
        lumen.displacement_mm[i] = std::sqrt((lumen.vertices[i] - rest[i]).squaredNorm());
    lumen.wall_force_n.assign(rest.size(), 0.0);
    for (const auto& [vertex, newtons] : poses.wall_force_n)
        lumen.wall_force_n[static_cast<std::size_t>(vertex)] = newtons;
    describe_contrast(stage, poses.contrast_mg_ml, memory, lumen);
}

void describe_devices(const std::vector<DevicePose>& devices, std::vector<FrameDevice>& out) {
    out.clear();
    for (const DevicePose& device : devices) {
        FrameDevice& drawn = out.emplace_back();
        drawn.name = device.name;
        drawn.points = device.points;
        drawn.radius_mm = device.radius_mm;
        drawn.inner_radius_mm = device.inner_radius_mm;
        drawn.materials = device.materials;
        drawn.material_of = device.material_of;
        if (device.name == catheter_entity) drawn.color = Vec3(0.25, 0.45, 0.75);
    }
}

// The camera keeps its roll: the old right-hand axis, made square to the new direction.
Pose camera_pose(const Vec3& position, const Vec3& forward, const std::optional<FrameCamera>& before) {
    Vec3 right = before ? Vec3(before->pose.orientation * Vec3::UnitX()) : Vec3::UnitX();
    right -= forward * forward.dot(right);
    if (right.squaredNorm() < 1e-6) right = forward.cross(std::fabs(forward.x()) < 0.8 ? Vec3::UnitX() : Vec3::UnitY());
    right.normalize();
    Mat3 axes;
    axes << right, forward.cross(right), forward;
    return {position, Quat(axes)};
}

void describe_camera(const ScenePoses& poses, FrameDescription& frame) {
    std::optional<FrameCamera> camera;
    if (poses.tip) {
        camera.emplace();
        camera->pose = camera_pose(poses.tip->position, poses.tip->forward, frame.inner_camera);
    }
    frame.inner_camera = camera;
}

// From before the patient, at the tip that the inner view looks from: as the fluoroscopy at AP shows it.
void describe_outer_camera(const ViewChange& change, FrameDescription& frame) {
    constexpr double away_mm = 330.0, field_deg = 40.0;
    frame.show_outer_view = !change.third_person.empty() && !change.alone;
    frame.outer_map = change.third_person == "force" ? OuterMap::force : OuterMap::displacement;
    frame.outer_camera.reset();
    if (!frame.inner_camera) return;
    Mat3 axes;
    axes << Vec3::UnitX(), -Vec3::UnitZ(), Vec3::UnitY();  // right, down, forward
    frame.outer_camera.emplace();
    frame.outer_camera->pose = {frame.inner_camera->pose.position - away_mm * Vec3::UnitY(), Quat(axes)};
    frame.outer_camera->field_of_view_deg = field_deg;
}

void describe_beam(BeamSpec beam, const SceneSpec& scene, const Channels& channels, const ViewChange& change,
                   FrameDescription& frame) {
    beam.c_arm.sid_mm = change.sid_mm.value_or(beam.c_arm.sid_mm);
    beam.c_arm.sod_mm = change.sod_mm.value_or(beam.c_arm.sod_mm);
    beam.c_arm.field_mm = change.field_mm.value_or(beam.c_arm.field_mm);
    validate(beam.c_arm);
    Vec3 isocentre = isocentre_in_patient(beam, channels.table_longitudinal_mm, channels.table_lateral_mm);
    if (change.isocentre.size() == 3) isocentre = Vec3(change.isocentre[0], change.isocentre[1], change.isocentre[2]);
    const CArmPose pose = c_arm_pose(beam.c_arm, isocentre, change.primary_deg.value_or(channels.primary_angle_deg),
                                     change.secondary_deg.value_or(channels.secondary_angle_deg));
    frame.view.source = pose.source;
    frame.view.detector_center = pose.detector;
    frame.view.right = pose.right;
    frame.view.down = pose.down;
    frame.view.width_mm = beam.c_arm.field_mm;
    frame.view.height_mm = beam.c_arm.field_mm;
    frame.view.source_isocentre_mm = beam.c_arm.sod_mm;
    frame.view.open_width = change.open_width.value_or(channels.collimator_width);
    frame.view.open_height = change.open_height.value_or(channels.collimator_height);
    frame.series.number = static_cast<std::uint64_t>(channels.exposure_series);
    frame.series.subtracted = channels.acquisition >= 1.5;
    frame.series.collected = channels.acquisition >= 0.5;
    frame.series.roadmap = channels.roadmap > 0.5;
    frame.series.references = static_cast<std::uint64_t>(channels.references);
    frame.exposure.detector = detector_preset(change.detector.empty() ? scene.c_arm.detector : change.detector);
    frame.exposure.copper_mm = beam.copper_mm;
    if (channels.tube_voltage_kvp > 0.0) frame.exposure.kvp = channels.tube_voltage_kvp;
    if (change.kvp) frame.exposure.kvp = *change.kvp;
    // Another view has another thickness, for which the control would have reached its target.
    frame.exposure.detector_kerma_ngy = channels.acquisition >= 1.5   ? beam.dsa_kerma_ngy
                                        : channels.acquisition >= 0.5 ? beam.cine_kerma_ngy
                                                                      : beam.target_kerma_ngy;
    if (channels.detector_kerma_ngy > 0.0 && !change.moves())
        frame.exposure.detector_kerma_ngy = channels.detector_kerma_ngy;
    if (change.kerma_ngy) frame.exposure.detector_kerma_ngy = *change.kerma_ngy;
    frame.beam_on = change.beam_on || channels.beam_on > 0.5;
}

}  // namespace

void describe_frame(const FrameStage& stage, const ScenePoses& poses, const SceneSpec& scene, const Channels& channels,
                    const ViewChange& change, FrameMemory& memory, FrameDescription& frame) {
    describe_solids(*stage.anatomy, frame);
    describe_lumen(stage, poses, memory, frame.lumen);
    describe_devices(poses.devices, frame.devices);
    describe_camera(poses, frame);
    frame.show_inner_view = frame.inner_camera.has_value() && !change.alone;
    frame.show_reference = channels.references > 0.5 && !change.alone;
    describe_outer_camera(change, frame);
    describe_beam(*stage.beam, scene, channels, change, frame);
    frame.wall_force_limit_n = channels.force_limit_n > 0.0 ? channels.force_limit_n : 0.8;
}

}  // namespace cathlab
