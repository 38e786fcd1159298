// The rhythm of hand and eye: an operator moves, rests to look at the picture, guesses what the picture does not show,
// and moves on.
#pragma once

#include <cstdint>

#include "autopilot/skill.h"
#include "core/types.h"

namespace cathlab {

/// Moves and looks last between half and one and a half times the skill's means.  Every number is a function of (seed,
/// number of the look), so the same seed gives the same rhythm.
class Attention {
public:
    Attention(const Skill& skill, std::uint64_t seed);

    /// One step of dt s.  at_work: there is something left to do; a hand that stands at the goal does not begin to rest
    /// from that.
    void step(double dt, bool at_work);
    /// Whether the hand rests.
    bool looks() const { return looks_; }
    /// How far off it believes things to be, mm: z along the beam, x and y, a third as uncertain, across it.  Guessed
    /// anew in each look.
    const Vec3& off_mm() const { return off_mm_; }
    /// What was believed cannot be: guess anew.
    void guess_again();

private:
    double length_s(double mean_s, std::uint64_t what) const;

    Skill skill_;
    std::uint64_t seed_, look_ = 0;
    bool looks_ = false;
    double left_s_ = 0.0;
    Vec3 off_mm_ = Vec3::Zero();
};

}  // namespace cathlab
