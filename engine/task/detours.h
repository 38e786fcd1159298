// How far it is from where a tip began to its goal, and into how many vessels it went that are not on the way.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "anatomy/model.h"
#include "task/way.h"

namespace cathlab {

class Detours {
public:
    Detours() = default;  ///< of a run without a task: nothing is counted
    /// goal: a landmark's name; without one of that name nothing is counted.
    Detours(std::shared_ptr<const AnatomyModel> anatomy, const std::string& goal);

    /// The tip, world, mm, after every step.  The way begins at the first one.
    void add(const Vec3& tip, double dt);

    double way_mm() const { return way_ ? way_->length_mm() : 0.0; }
    /// Times that the tip went into another vessel, counted again once it has been back on its way for a second.
    int wrong_branches() const { return wrong_branches_; }

private:
    std::shared_ptr<const AnatomyModel> anatomy_;
    std::optional<Index> goal_;
    std::optional<Way> way_;
    double back_s_ = 0.0;
    int wrong_branches_ = 0;
};

}  // namespace cathlab
