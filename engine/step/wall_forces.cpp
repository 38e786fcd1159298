#include "step/wall_forces.h"

#include <algorithm>

namespace cathlab {
namespace {

// The bond of the annulus to the heart, in units of a particle's own goal stiffness: stiff enough that the ring follows
// within a twentieth, soft enough that it does not tear at its neighbours.
constexpr double bond_stiffness = 20.0;

/// The model's foundation and that of effects, mN/mm; nothing where no effect has one.
void set_support(const Parts& p, std::span<const double> kpa_per_mm) {
    std::vector<double>& support = p.wall_scratch->support;
    support.clear();
    if (std::all_of(kpa_per_mm.begin(), kpa_per_mm.end(), [](double k) { return k == 0.0; })) return;
    for (std::size_t i = 0; i < kpa_per_mm.size(); ++i)
        support.push_back(kpa_per_mm[i] * p.wall->area_mm2[i] + (p.wall->support.empty() ? 0.0 : p.wall->support[i]));
}

/// The membrane as it stands when the substep begins: what effects make of its law, and what they keep of it.
void ask_membrane_law(const Parts& p, const EffectContext& context) {
    std::vector<ActiveEffect*> active;
    for (ActiveEffect* effect : p.effects)
        if (effect->info->hooks & hook_membrane) active.push_back(effect);
    std::stable_sort(active.begin(), active.end(),
                     [](const ActiveEffect* a, const ActiveEffect* b) { return a->info < b->info; });
    std::vector<Effect*> effects;
    for (ActiveEffect* effect : active) {
        effect->effect->points(p.wall->elastic.groups() * kernel::lanes);
        effects.push_back(effect->effect.get());
    }
    SoftBodyScratch& scratch = *p.wall_scratch;
    const auto law = [&](const MembraneMaterial& material, MembranePoint& point) {
        ask_membrane(effects, context, material, scratch.fibres, point);
        for (Effect* effect : effects) effect->remember(context, point);
    };
    ask_law(*p.wall, *p.wall_state, scratch, law, p.world->workers());
}

}  // namespace

WallForces::WallForces(const Parts& p, const EffectContext& context) {
    const std::size_t n = p.wall->size();
    unsigned hooks = 0;
    for (const ActiveEffect* active : p.effects) hooks |= active->info->hooks;
    if (hooks & hook_material) {
        std::vector<double>& scale = p.wall_scratch->stiffness_scale;
        scale.assign(n, 1.0);
        Fibres& fibres = p.wall_scratch->fibres;
        fibres = {};
        std::vector<double> around(n, 0.0);
        p.each_effect(hook_material, [&](Effect& effect) {
            effect.material(context, scale);
            effect.fibres(context, fibres);
            effect.surroundings(context, around);
        });
        set_support(p, around);
    }
    if ((hooks & hook_membrane) && p.wall->form == WallForm::elastic) ask_membrane_law(p, context);
    if (hooks & hook_constraint)
        p.each_effect(hook_constraint, [&](Effect& effect) { effect.constraint(context, anchors_); });
    if (hooks & hook_force) {
        external_.assign(n, Vec3::Zero());
        p.each_effect(hook_force, [&](Effect& effect) { effect.force(context, external_); });
    }
}

void WallForces::detect_heart(const Parts& p, const Drive& drive, double h) {
    anchor_force_.assign(anchors_.size(), Vec3::Zero());
    if (!p.heart) return;
    advance(*p.heart, *p.heart_state, h, drive.heart_rate_scale);
    double displacement = p.heart_state->displacement_mm;
    if (drive.heart_amplitude_scale != 1.0) {
        const double onset = profile(*p.heart, 0.0).displacement_mm;
        displacement = onset + drive.heart_amplitude_scale * (displacement - onset);
    }
    displacement += drive.heart_displacement_mm;
    const Pose cylinder = cylinder_pose(*p.heart, p.anatomy->annulus->pose, displacement);
    if (p.heart->bonded)
        for (const Index i : p.annulus->particles) {
            const auto k = static_cast<std::size_t>(i);
            if (p.wall->fixed[k]) continue;
            anchors_.push_back(
                {i, p.wall->rest[k] + displacement * p.annulus->axis, bond_stiffness * p.wall->stiffness[k]});
        }
    anchor_force_.resize(anchors_.size(), Vec3::Zero());
    find_rows(*p.heart, cylinder, p.wall_state->x, p.annulus->candidates, p.settings->contact_margin_mm, rows_);
    // Particles without a row are not touched: their force ends here.
    std::vector<double> kept(p.wall->size(), 0.0);
    for (const CylinderRow& row : rows_)
        kept[static_cast<std::size_t>(row.particle)] =
            p.heart_contact->force_mn[static_cast<std::size_t>(row.particle)];
    p.heart_contact->force_mn.swap(kept);
}

void WallForces::solve(const Parts& p) {
    const std::vector<double>& c = p.wall_scratch->compliance;
    for (const CylinderRow& row : rows_) {
        const auto i = static_cast<std::size_t>(row.particle);
        if (c[i] <= 0.0) continue;
        double& lambda = p.heart_contact->force_mn[i];
        lambda = std::max(0.0, lambda - row.gap_at(p.wall_state->x[i]) / c[i]);
    }
    for (std::size_t k = 0; k < anchors_.size(); ++k) {
        const auto i = static_cast<std::size_t>(anchors_[k].particle);
        if (c[i] <= 0.0) continue;
        const Vec3 free = p.wall_state->x[i] - c[i] * anchor_force_[k];
        anchor_force_[k] = anchors_[k].stiffness / (1.0 + c[i] * anchors_[k].stiffness) * (anchors_[k].target - free);
    }
}

void WallForces::add_touched(std::vector<Index>& particles) const {
    for (const CylinderRow& row : rows_) particles.push_back(row.particle);
    for (const WallAnchor& anchor : anchors_) particles.push_back(anchor.particle);
}

void WallForces::gather(const Parts& p) {
    std::vector<Vec3>& force = p.wall_scratch->force;
    const auto add = [&](Index particle, const Vec3& f) {
        written_.push_back(particle);
        force[static_cast<std::size_t>(particle)] += f;
    };
    for (const Index i : written_) force[static_cast<std::size_t>(i)].setZero();
    const auto touched = p.contacts->touched();
    written_.assign(touched.begin(), touched.end());
    p.contacts->apply_to_wall(force);
    for (const CylinderRow& row : rows_)
        add(row.particle, p.heart_contact->force_mn[static_cast<std::size_t>(row.particle)] * row.normal);
    for (std::size_t k = 0; k < anchors_.size(); ++k) add(anchors_[k].particle, anchor_force_[k]);
}

}  // namespace cathlab
