#include "task/detours.h"

namespace cathlab {

namespace {

constexpr double back_for_s = 1.0;

}  // namespace

Detours::Detours(std::shared_ptr<const AnatomyModel> anatomy, const std::string& goal)
    : anatomy_(std::move(anatomy)), back_s_(back_for_s) {
    for (const Landmark& landmark : anatomy_->landmarks)
        if (landmark.name == goal) goal_ = landmark.node;
}

void Detours::add(const Vec3& tip, double dt) {
    if (!goal_) return;
    if (!way_) {
        const Index from = anatomy_->centreline.nearest(tip);
        if (from == *goal_ || anatomy_->centreline.path(from, *goal_).empty()) {
            goal_.reset();
            return;
        }
        way_.emplace(anatomy_->centreline, from, *goal_);
    }
    if (!way_->locate(tip).astray) {
        back_s_ += dt;
        return;
    }
    if (back_s_ >= back_for_s) ++wrong_branches_;
    back_s_ = 0.0;
}

}  // namespace cathlab
