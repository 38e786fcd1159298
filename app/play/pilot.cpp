#include "play/pilot.h"

#include <algorithm>
#include <cmath>

#include "beam/view_presets.h"
#include "core/input.h"
#include "scene/script.h"

namespace cathlab::play {
namespace {

constexpr double jog_mm_s = 25.0;       // a step of 1 mm takes two steps of the simulation
constexpr double jog_begins = 0.5;      // of full deflection
constexpr double jog_ends = 0.3;        // below this the next step may begin
constexpr double follow_share = 0.26;   // of the field at the isocentre: within this of the middle the tip may wander
constexpr double follow_past = 0.12;    // then the table moves the tip to so far on the other side, and stands again
constexpr double follow_rest_s = 0.25;  // seconds that the table would take for what is left: it comes to rest softly
constexpr double follow_ends_mm = 1.0;
constexpr double blades_share_s = 0.5;  // of the field a second, while the hand holds them
constexpr double magnification = 1.4;   // SID / SOD, roughly: the field that is seen in the patient is smaller

}  // namespace

Pilot::Pilot(const SceneSpec& scene, const Vec3& isocentre)
    : has_wire_(scene.wire.enabled),
      has_catheter_(scene.catheter.enabled),
      middle_(isocentre),
      field_mm_(scene.c_arm.field_of_view_mm / magnification) {
    device_ = has_wire_ ? 0 : 1;
    input_ = base_input(scene);
    input_.device = device_;
}

void Pilot::turn_to(double primary_deg, double secondary_deg) {
    input_.primary_angle = std::clamp(primary_deg, -180.0, 180.0);
    input_.secondary_angle = std::clamp(secondary_deg, -90.0, 90.0);
}

void Pilot::open_to(double width, double height) {
    const auto within = [](const char* action, double value) {
        const ActionInfo& info = *find_action(action);
        return std::clamp(value, info.minimum, info.maximum);
    };
    input_.collimator_width = within("collimator_width", width);
    input_.collimator_height = within("collimator_height", height);
}

bool Pilot::pressed(const Controls& controls, Control control) {
    return controls.pressed(control) != before_.pressed(control);
}

double Pilot::advance(const Controls& controls, const InputSettings& settings, double slow, double dt) {
    const double wish = controls[Control::advance];
    if (!jog_) return wish * settings.advance_mm_s * slow;
    const int direction = wish > jog_begins ? 1 : wish < -jog_begins ? -1 : 0;
    if (direction != 0 && direction != jog_direction_) {
        jog_direction_ = direction;
        jog_left_mm_ = settings.jog_mm;
    } else if (std::fabs(wish) < jog_ends) {
        jog_direction_ = 0;
    }
    if (jog_left_mm_ <= 0.0) return 0.0;
    const double mm = std::min(jog_left_mm_, jog_mm_s * dt);
    jog_left_mm_ -= mm;
    const int way = jog_direction_ != 0 ? jog_direction_ : (input_.advance < 0.0 ? -1 : 1);
    return way * mm / dt;
}

void Pilot::imaging(const Controls& controls, const InputSettings& settings, const Channels& channels, double dt) {
    const bool down = controls[Control::fluoroscopy] > 0.5;
    if (settings.toggle_pedals) {
        if (down && !pedal_was_down_) pedal_ = !pedal_;
    } else {
        pedal_ = down;
    }
    pedal_was_down_ = down;
    input_.fluoroscopy = pedal_ ? 1.0 : 0.0;
    input_.contrast = controls[Control::contrast] > 0.5 ? settings.contrast_ml_s : 0.0;

    if (pressed(controls, Control::arm_or_table)) moves_table_ = !moves_table_;
    if (pressed(controls, Control::follow)) follows_ = !follows_;
    double along = controls[Control::table_along], across = controls[Control::table_across];
    if (moves_table_) {
        along += controls[Control::secondary];
        across += controls[Control::primary];
    } else {
        turn_to(input_.primary_angle + controls[Control::primary] * settings.c_arm_deg_s * dt,
                input_.secondary_angle + controls[Control::secondary] * settings.c_arm_deg_s * dt);
    }
    double along_mm = along * settings.table_mm_s * dt, across_mm = across * settings.table_mm_s * dt;
    if (along != 0.0 || across != 0.0) follows_ = false;  // a hand on the table has the last word
    if (follows_ && channels.time_s > 0.0) {
        const double z = device_ == 0 ? channels.wire_tip_z_mm : channels.catheter_tip_z_mm;
        const double off = z - (middle_.z() + channels.table_longitudinal_mm);
        // In one go and then at rest: while the table moves, all of the patient has to be drawn anew.
        if (follow_way_ == 0 && std::fabs(off) > follow_share * field_mm_) follow_way_ = off > 0.0 ? 1 : -1;
        const double left = off + follow_way_ * follow_past * field_mm_;
        if (follow_way_ * left < follow_ends_mm) follow_way_ = 0;
        const double most = settings.table_mm_s * dt;
        if (follow_way_ != 0) along_mm += std::clamp(left / follow_rest_s * dt, -most, most);
    } else {
        follow_way_ = 0;
    }
    input_.table_longitudinal = std::clamp(input_.table_longitudinal + along_mm, -1000.0, 1000.0);
    input_.table_lateral = std::clamp(input_.table_lateral + across_mm, -200.0, 200.0);
}

// What stands on the console beside the pedal.
void Pilot::console(const Controls& controls, double dt) {
    const auto next_of_three = [](double value) { return value >= 2.0 ? 0.0 : value + 1.0; };
    if (pressed(controls, Control::acquisition)) input_.acquisition = next_of_three(input_.acquisition);
    if (pressed(controls, Control::fluoroscopy_level))
        input_.fluoroscopy_level = next_of_three(input_.fluoroscopy_level);
    if (pressed(controls, Control::roadmap)) input_.roadmap = 1.0 - input_.roadmap;
    if (!roadmap_allowed_) input_.roadmap = 0.0;
    input_.reference =
        pressed(controls, Control::reference) ? 1.0 : 0.0;  // for one step: the picture is kept as it rises
    if (pressed(controls, Control::named_view)) {
        const ViewPreset& view = view_after(input_.primary_angle, input_.secondary_angle);
        turn_to(view.primary_deg, view.secondary_deg);
    }
    const double wide = controls[Control::collimator_width], high = controls[Control::collimator_height];
    if (wide != 0.0 || high != 0.0)
        open_to(input_.collimator_width + wide * blades_share_s * dt,
                input_.collimator_height + high * blades_share_s * dt);
}

Input Pilot::step(const Controls& controls, const InputSettings& settings, const Channels& channels, double dt) {
    if (first_) before_ = controls;  // what was pressed before the start is over
    first_ = false;
    if (pressed(controls, Control::wire) && has_wire_) device_ = 0;
    if (pressed(controls, Control::catheter) && has_catheter_) {
        if (device_ == 1) segment_ = 1 - segment_;
        device_ = 1;
    }
    if (pressed(controls, Control::jog)) jog_ = !jog_;
    const double slow = 1.0 + controls[Control::precision] * (settings.precision - 1.0);
    input_.device = device_;
    input_.advance = advance(controls, settings, slow, dt);
    input_.rotate = controls[Control::rotate] * settings.rotate_deg_s * slow;
    if (has_catheter_) {
        const bool distal = segment_ == 1;
        double& bend = distal ? input_.distal_bend : input_.proximal_bend;
        double& direction = distal ? input_.distal_direction : input_.proximal_direction;
        bend = std::clamp(bend + controls[Control::bend] * settings.bend_deg_s * slow * dt, 0.0, distal ? 140.0 : 60.0);
        direction += controls[Control::bend_direction] * settings.direction_deg_s * slow * dt;
        // The range of the action is two turns either way; a whole turn back is the same direction, but the segment
        // would swing round, so it simply stops there.
        direction = std::clamp(direction, -720.0, 720.0);
    }
    imaging(controls, settings, channels, dt);
    console(controls, dt);
    before_ = controls;
    return input_;
}

}  // namespace cathlab::play
