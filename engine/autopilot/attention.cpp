#include "autopilot/attention.h"

#include "core/random.h"

namespace cathlab {

namespace {

constexpr std::uint64_t moving = 16, looking = 17, guessing = 18;  // indices of the random stream; below: the tremor's
constexpr double across = 1.0 / 3.0;  // of the uncertainty along the beam: there the picture helps

}  // namespace

Attention::Attention(const Skill& skill, std::uint64_t seed) : skill_(skill), seed_(seed) {
    guess_again();
    left_s_ = length_s(skill_.moves_s, moving);
}

double Attention::length_s(double mean_s, std::uint64_t what) const {
    return mean_s * (0.5 + random_uniform(seed_, RandomStream::operator_, look_, what));
}

void Attention::guess_again() {
    ++look_;
    for (Index axis = 0; axis < 3; ++axis)
        off_mm_[axis] =
            (axis == 2 ? 1.0 : across) * skill_.depth_mm *
            random_normal(seed_, RandomStream::operator_, look_, guessing + static_cast<std::uint64_t>(axis));
}

void Attention::step(double dt, bool at_work) {
    if (!at_work && !looks_) return;
    left_s_ -= dt;
    if (left_s_ > 0.0) return;
    looks_ = !looks_ && skill_.looks_s > 0.0;
    if (looks_) guess_again();
    left_s_ = looks_ ? length_s(skill_.looks_s, looking) : length_s(skill_.moves_s, moving);
}

}  // namespace cathlab
