// What the hands do -> what the operator asks of the devices, one step of the simulation after another.
#pragma once

#include "core/channels.h"
#include "core/input.h"
#include "play/controls.h"
#include "play/settings.h"
#include "scene/scene_spec.h"

namespace cathlab::play {

/// Rates are integrated in simulated time, so a session's inputs are what was recorded, whatever the machine's pace.
class Pilot {
public:
    /// isocentre: of the picture while the table stands at 0, world, mm.
    Pilot(const SceneSpec& scene, const Vec3& isocentre);

    /// The input of the next step of dt seconds.  channels: of the step before (for the table that follows the tip).
    Input step(const Controls& controls, const InputSettings& settings, const Channels& channels, double dt);

    bool has_wire() const { return has_wire_; }
    bool has_catheter() const { return has_catheter_; }
    bool catheter() const { return device_ == 1; }
    int segment() const { return segment_; }  ///< of the catheter: 0 = proximal, 1 = distal
    bool jog() const { return jog_; }
    bool moves_table() const { return moves_table_; }
    bool follows() const { return follows_; }
    bool pedal() const { return pedal_; }
    void set_follows(bool yes) { follows_ = yes; }
    /// The C-arm goes there.
    void turn_to(double primary_deg, double secondary_deg);
    /// What the pedal exposes: 0 fluoroscopy, 1 cine, 2 DSA.
    void acquire(int what) { input_.acquisition = what; }
    /// Dose of fluoroscopy: 0 low, 1 normal, 2 high.
    void set_level(int level) { input_.fluoroscopy_level = level; }
    /// The blades go there: shares of the field, 0.1 to 1.
    void open_to(double width, double height);
    /// Whether the roadmap may be had; where it may not, it goes off.
    void allow_roadmap(bool yes) { roadmap_allowed_ = yes; }

private:
    bool pressed(const Controls& controls, Control control);
    double advance(const Controls& controls, const InputSettings& settings, double slow, double dt);
    void imaging(const Controls& controls, const InputSettings& settings, const Channels& channels, double dt);
    void console(const Controls& controls, double dt);

    bool has_wire_, has_catheter_;
    Vec3 middle_;  // of the picture when the table stands at 0: world
    double field_mm_;
    int device_ = 0, segment_ = 1;
    bool jog_ = false, moves_table_ = false, follows_ = true, pedal_ = false, pedal_was_down_ = false;
    bool roadmap_allowed_ = true;
    int jog_direction_ = 0;
    int follow_way_ = 0;  // which way the table is on, to bring the tip back into the picture
    double jog_left_mm_ = 0.0;
    Input input_;
    Controls before_;
    bool first_ = true;
};

}  // namespace cathlab::play
