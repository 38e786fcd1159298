// The view from outside, on a flat piece of wall before the camera.
#include "render/outer_view.h"

#include <gtest/gtest.h>

#include "render/frame_renderer.h"

namespace cathlab {
namespace {

FrameDescription wall_before_camera() {
    FrameDescription f;
    f.width = 64;
    f.height = 64;
    f.show_fluoroscopy = false;
    f.show_inner_view = false;
    f.show_outer_view = true;
    f.lumen.vertices = {{-100, -100, 200}, {100, -100, 200}, {0, 150, 200}};
    f.lumen.triangles = {{0, 1, 2}};
    f.lumen.topology_revision = 1;
    f.outer_camera.emplace();
    f.outer_camera->field_of_view_deg = 40;
    return f;
}

int brightness(FrameRenderer& renderer, const FrameDescription& frame) {
    Image8 picture;
    renderer.render(frame, picture);
    int sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += picture.rgb[picture.offset(32, 32) + k];
    return sum;
}

TEST(OuterView, AWallIsSeenAndIsBrighterTheFurtherItIsDisplaced) {
    FrameRenderer renderer(make_gl_target());
    FrameDescription frame = wall_before_camera();
    const int rest = brightness(renderer, frame);
    frame.lumen.displacement_mm = {5, 5, 5};
    const int displaced = brightness(renderer, frame);
    EXPECT_GT(displaced, rest + 10);
    frame.outer_map = OuterMap::force;  // displacement is not what it shows now
    EXPECT_EQ(brightness(renderer, frame), rest);
    frame.lumen.vertices = {{-100, -100, -200}, {100, -100, -200}, {0, 150, -200}};  // behind the camera
    EXPECT_LT(brightness(renderer, frame), rest);
}

TEST(OuterView, ADeviceIsSeenThroughTheWall) {
    FrameRenderer renderer(make_gl_target());
    FrameDescription frame = wall_before_camera();
    const int wall = brightness(renderer, frame);
    FrameDevice wire;
    wire.points = {{-50, 0, 250}, {50, 0, 250}};
    wire.radius_mm = {10};
    frame.devices = {wire};
    EXPECT_GT(brightness(renderer, frame), wall + 100);
}

}  // namespace
}  // namespace cathlab
