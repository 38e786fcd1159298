// Kind catheter-tip: base, two arcs, a link and a tip, of which everything is given.
#include <algorithm>
#include <cmath>

#include "catheter/shape.h"
#include "core/deterministic_math.h"
#include "core/units.h"
#include "explain/rigs.h"

namespace cathlab {
namespace {

// The sheath's mouth lies so far behind the base that all of the steerable part is out, also where the insertion is
// counted from somewhere else.
constexpr double behind_mm = 10000.0;
constexpr double one_sample_mm = 1e9;  // the tip alone is looked at

class CatheterRig final : public Rig {
public:
    CatheterRig(const Dataset& data, const Split& split) : Rig(data, split) {
        hooks_ = hook_actuation | hook_drive | hook_measure;
        const CatheterTipSetup& setup = data.catheter;
        spec_.segments = {{"proximal", setup.proximal_length_mm, 180.0, 1.0},
                          {"distal", setup.distal_length_mm, 180.0, 1.0}};
        spec_.link_length_mm = setup.middle_length_mm;
        spec_.tip_length_mm = setup.tip_length_mm;
        const Vec3 z = setup.base.orientation * Vec3::UnitZ(), x = setup.base.orientation * Vec3::UnitX();
        rail_.points = {setup.base.position - behind_mm * z, setup.base.position};
        rail_.arc = {0.0, behind_mm};
        rail_.tangent = {z, z};
        rail_.side = {x, x};
        const auto input = [&](const char* name) { return &data.find(name)->values; };
        insertion_ = input("insertion");
        rotation_ = input("rotation");
        proximal_ = input("proximal_bend");
        distal_ = input("distal_bend");
        for (const DataColumn* column : measured_) axis_.push_back(column->quantity.back() - 'x');
        CatheterState state = initial_state(spec_);
        Actuation act;
        for (std::size_t i = 0; i < data.rows(); ++i) {
            begin(act, i);
            commanded_.push_back(place(act, state));
        }
    }

    Columns residual(std::span<const double>, std::span<const EffectTrial> trials) const override {
        Columns out;
        for (const DataColumn* column : measured_) out.push_back(column->values);
        RigEffects effects(trials);
        const bool actuated = effects.uses(hook_actuation), driven = effects.uses(hook_drive);
        const bool read = effects.uses(hook_measure);
        const Quat to_base = data_.catheter.base.orientation.conjugate();
        CatheterState state = initial_state(spec_);
        Actuation act;
        Vec3 tip = Vec3::Zero();
        for (std::size_t i = 0; i < data_.rows(); ++i) {
            if (i == 0 || data_.run[i] != data_.run[i - 1]) effects.begin_run(data_.run[i]);
            effects.next_row(data_.time_s[i]);
            tip = commanded_[i];
            if (actuated) {
                begin(act, i);
                if (data_.catheter.down) {
                    const Quat turn = det::rotation_from_vector(Vec3(0.0, 0.0, -act.rotation_rad));
                    act.down = turn * (to_base * *data_.catheter.down);
                }
                effects.actuation(act);
                tip = place(act, state);
            }
            if (driven) tip += effects.drive().support_displacement[0];
            if (read) tip = effects.read_tip(tip);
            for (std::size_t c = 0; c < out.size(); ++c) out[c][i] -= tip[axis_[c]];
        }
        return out;
    }

    NamedNumbers parameters(std::span<const double>, std::span<const EffectTrial>) const override { return {}; }

    std::string why_not(const EffectInfo& effect) const override {
        if (effect.name == "gravity_sag" && !data_.catheter.down)
            return "the data do not say where down is (setup.down_axis)";
        return Rig::why_not(effect);
    }

private:
    void begin(Actuation& act, std::size_t i) const {
        act.insertion_mm = (*insertion_)[i];
        act.rotation_rad = (*rotation_)[i] * units::deg;
        act.link_length_mm = spec_.link_length_mm;
        act.tip_length_mm = spec_.tip_length_mm;
        act.segments.resize(2);
        act.segments[0].length_mm = spec_.segments[0].length_mm;
        act.segments[0].taper = act.segments[1].taper = 0.0;
        act.segments[0].bend_rad = Vec2((*proximal_)[i] * units::deg, 0.0);
        act.segments[1].length_mm = spec_.segments[1].length_mm;
        act.segments[1].bend_rad = Vec2((*distal_)[i] * units::deg, 0.0);
    }

    Vec3 place(const Actuation& act, CatheterState& state) const {
        state.taper.resize(act.segments.size());
        state.insertion_mm = std::max(0.0, behind_mm + act.insertion_mm + spec_.steerable_length_mm());
        state.rotation_rad = act.rotation_rad;
        for (std::size_t k = 0; k < act.segments.size(); ++k) {
            const Vec2& b = act.segments[k].bend_rad;
            state.bend_rad[k] = std::sqrt(b.squaredNorm());
            state.direction_rad[k] = det::atan2(b.y(), b.x());
            state.taper[k] = act.segments[k].taper;
        }
        return shape(spec_, state, rail_, one_sample_mm).tip.position;
    }

    CatheterSpec spec_;
    Rail rail_;
    const std::vector<double>*insertion_, *rotation_, *proximal_, *distal_;
    std::vector<int> axis_;
    std::vector<Vec3> commanded_;  // (rows) tips as the drive asks for them
};

}  // namespace

std::unique_ptr<Rig> make_catheter_rig(const Dataset& data, const Split& split) {
    return std::make_unique<CatheterRig>(data, split);
}

}  // namespace cathlab
