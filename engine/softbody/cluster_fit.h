// The wall's clusters as a solver fits them to positions, in the model's precision (kernel.h): from positions to
// transforms, from transforms to goals.
#pragma once

#include <cstdint>
#include <span>

#include "softbody/solver.h"

namespace cathlab {

/// The groups of clusters in the model's precision.
class ClusterFit {
public:
    explicit ClusterFit(const SoftBodyModel& model);

    /// Fits groups [begin, end) to state.x, whose places the grid has already.
    void fit(SoftBodyState& state, SoftBodyScratch& scratch, std::size_t begin, std::size_t end) const;
    /// Places of a group's particles among the coordinates, with repeats.
    std::span<const std::int32_t> places(std::size_t group) const;

private:
    bool wide_;
    kernel::Groups<double> double_;
    kernel::Groups<float> float_;
};

/// Positions of particles [begin, end) in steps of the grid, which has room for them.
void to_grid(const SoftBodyState& state, SoftBodyScratch& scratch, std::size_t begin, std::size_t end);

/// Where fits are in float, all positions in steps of the grid; else nothing.
void all_to_grid(const SoftBodyModel& model, const SoftBodyState& state, SoftBodyScratch& scratch,
                 const Workers& workers);

/// Fits all clusters to state.x; the grid has its places already.
void fit_all(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, const Workers& workers);

/// Goals of particles [begin, end) from the clusters as they are fitted.
void gather_goals(const SoftBodyModel& model, const SoftBodyState& state, SoftBodyScratch& scratch, std::size_t begin,
                  std::size_t end);

}  // namespace cathlab
