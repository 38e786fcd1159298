#include "softbody/cluster_fit.h"

#include <algorithm>

namespace cathlab {

namespace {

constexpr std::size_t particle_grain = 1024;
constexpr std::size_t group_grain = 4;

const double* numbers(const std::vector<Vec3>& v) {
    return v.empty() ? nullptr : v.front().data();
}

}  // namespace

ClusterFit::ClusterFit(const SoftBodyModel& model)
    : wide_(model.precision == Precision::double_),
      double_(model.clusters.view()),
      float_(model.clusters_float.view()) {}

void ClusterFit::fit(SoftBodyState& state, SoftBodyScratch& scratch, std::size_t begin, std::size_t end) const {
    const kernel::Set& set = kernel::best();
    const kernel::Positions now{numbers(state.x), scratch.grid.data()};
    if (wide_)
        set.fit_double(&double_, now, state.rotation.data(), scratch.transform.data(), nullptr, begin, end);
    else
        set.fit_float(&float_, now, state.rotation.data(), scratch.grid_transform.data(), scratch.far.data(), begin,
                      end);
}

std::span<const std::int32_t> ClusterFit::places(std::size_t group) const {
    const std::int32_t* slot = wide_ ? double_.first_slot : float_.first_slot;
    const std::int32_t* place = wide_ ? double_.place : float_.place;
    const auto first = static_cast<std::size_t>(slot[group]), last = static_cast<std::size_t>(slot[group + 1]);
    return {place + first * kernel::lanes, (last - first) * kernel::lanes};
}

void to_grid(const SoftBodyState& state, SoftBodyScratch& scratch, std::size_t begin, std::size_t end) {
    kernel::best().to_grid(numbers(state.x), scratch.grid.data(), 3 * begin, 3 * end);
}

void all_to_grid(const SoftBodyModel& model, const SoftBodyState& state, SoftBodyScratch& scratch,
                 const Workers& workers) {
    if (model.precision == Precision::double_) return;
    scratch.grid.resize(3 * model.size() + 1);
    workers.for_even_ranges(model.size(), particle_grain,
                            [&](std::size_t begin, std::size_t end) { to_grid(state, scratch, begin, end); });
}

void fit_all(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, const Workers& workers) {
    const auto empty_last = [&](auto& transform) {
        transform.resize((model.empty_lane() + 1) * kernel::transform_numbers);
        std::fill_n(transform.end() - kernel::transform_numbers, kernel::transform_numbers, 0);
    };
    if (model.precision == Precision::double_)
        empty_last(scratch.transform);
    else
        empty_last(scratch.grid_transform);
    scratch.far.resize(model.group_count());
    scratch.goal.resize(model.size());
    const ClusterFit clusters(model);
    workers.for_even_ranges(model.group_count(), group_grain,
                            [&](std::size_t begin, std::size_t end) { clusters.fit(state, scratch, begin, end); });
}

void gather_goals(const SoftBodyModel& model, const SoftBodyState& state, SoftBodyScratch& scratch, std::size_t begin,
                  std::size_t end) {
    const kernel::Set& set = kernel::best();
    const bool wide = model.precision == Precision::double_;
    const void* transform = wide ? static_cast<const void*>(scratch.transform.data()) : scratch.grid_transform.data();
    const bool far = !wide && std::find(scratch.far.begin(), scratch.far.end(), 1) != scratch.far.end();
    (wide ? set.gather_double : set.gather_float)(model.goals.view(), transform, numbers(model.rest),
                                                  far ? numbers(state.x) : nullptr, scratch.goal.front().data(), begin,
                                                  end);
}

}  // namespace cathlab
