// The rigs, one a kind of data, and what they share.
#pragma once

#include "explain/rig.h"

namespace cathlab {

std::unique_ptr<Rig> make_catheter_rig(const Dataset& data, const Split& split);
std::unique_ptr<Rig> make_tendon_rig(const Dataset& data, const Split& split);
std::unique_ptr<Rig> make_heart_rig(const Dataset& data, const Split& split);
std::unique_ptr<Rig> make_tension_rig(const Dataset& data, const Split& split);
std::unique_ptr<Rig> make_contact_rig(const Dataset& data, const Split& split, const Crew& crew);

/// The effects of one recording, from its first row on, asked as a step asks them.
class RigEffects {
public:
    explicit RigEffects(std::span<const EffectTrial> trials);

    /// Begins a recording: every effect is made anew.
    void begin_run(Index run);
    /// Goes on to a row's time.
    void next_row(double time_s);
    EffectContext& context() { return context_; }

    void actuation(Actuation& act);
    /// What the drive asks of a support that moves in full, and of the heart; valid until the next call.
    const Drive& drive();
    void measure(Channels& channels);
    /// Where a sensor reads a tip that is there, mm.
    Vec3 read_tip(const Vec3& tip);
    bool uses(unsigned hooks) const;

    /// The wall's law: how many points it has (each recording begins with none of them strained), its fibres, what the
    /// law makes of a point, and what is kept of it when the row is over.
    void points(std::size_t count);
    Fibres fibres();
    double surroundings();  ///< kPa/mm
    void membrane(const MembraneMaterial& material, const Fibres& fibres, MembranePoint& point);
    void remember(const MembranePoint& point);
    bool remembers();  ///< whether any effect of the membrane keeps something of it from row to row
    void slip(HeldPoint& held);
    void remember_slip(const HeldPoint& held);

private:
    std::span<const EffectTrial> trials_;
    std::vector<std::unique_ptr<Effect>> made_;
    std::vector<Effect*> of_membrane_;  // of those
    EffectContext context_;
    Drive drive_;
    bool first_ = true;
    double last_s_ = 0.0;
};

}  // namespace cathlab
