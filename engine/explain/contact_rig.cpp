// Kind wall-contact: the vessel of the data as an elastic shell at rest, pushed by the tool sample by sample; its
// material is given, nothing is fitted.
#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "explain/rigs.h"
#include "explain/wall_contact.h"
#include "softbody/push_rig.h"

namespace cathlab {
namespace {

// Twice the distance at which the calibration compares: a marker stands several of them from the tool, and a model must
// be solved hundreds of times.
constexpr double spacing_mm = 4.5;
constexpr double far_spacing_mm = 9.0;  // of the wall that nothing touches

constexpr unsigned of_wall = hook_material | hook_membrane | hook_slip;

class ContactRig final : public Rig {
public:
    ContactRig(const Dataset& data, const Split& split) : Rig(data, split) {
        hooks_ = of_wall | hook_measure;
        for (const char* axis : {"tool_x", "tool_y", "tool_z"}) {
            const std::vector<double>& values = data.find(axis)->values;
            for (std::size_t i = 0; i < data.rows(); ++i)
                if (std::isnan(values[i]))
                    throw UserError(data.folder + ": the tool's place is missing at " + std::to_string(data.time_s[i]) +
                                    " s of run " + data.run_names[static_cast<std::size_t>(data.run[i])]);
        }
        for (std::size_t i = 0; i < data.rows(); ++i) {
            const auto run = static_cast<std::size_t>(data.run[i]);
            if (run >= pushes_.size()) {
                pushes_.resize(run + 1);
                first_.push_back(i);
                pushes_[run].marker_mm = data.contact.sensor_rest_mm[run];
            }
            pushes_[run].ball_mm.emplace_back(data.find("tool_x")->values[i], data.find("tool_y")->values[i],
                                              data.find("tool_z")->values[i]);
        }
        PushRig rig = push_rig_of(data.contact, spacing_mm);
        rig.far_spacing_mm = far_spacing_mm;
        for (std::size_t run = 0; run < pushes_.size(); ++run) {
            rig.looked_at = pushes_[run].ball_mm;
            rig.looked_at.push_back(pushes_[run].marker_mm);
            walls_.emplace_back(rig);
            pushes_[run].keep_wall = true;
            plain_.push_back(walls_[run].push(pushes_[run]));
            pushes_[run].keep_wall = false;
            if (!plain_.back().at_rest)
                throw UserError(data.folder + ": the wall of run " + data.run_names[run] +
                                " comes to no rest under its tool; there is no base model");
        }
        for (std::size_t run = 0; run < pushes_.size(); ++run) pushes_[run].guess = plain_[run].wall_mm;
    }

    bool slow() const override { return true; }

    Columns residual(std::span<const double>, std::span<const EffectTrial> trials) const override {
        Columns out;
        for (const DataColumn* column : measured_) out.push_back(column->values);
        RigEffects effects(trials);
        const bool walled = effects.uses(of_wall), read = effects.uses(hook_measure);
        for (std::size_t run = 0; run < pushes_.size(); ++run) {
            PushResult own;
            if (walled) own = pushed(effects, run);
            const PushResult& result = walled ? own : plain_[run];
            effects.begin_run(static_cast<Index>(run));
            for (std::size_t k = 0; k < pushes_[run].ball_mm.size(); ++k) {
                const std::size_t row = first_[run] + k;
                effects.next_row(data_.time_s[row]);
                Vec3 place = result.marker_mm[k];
                double force = result.force_mn[k];
                if (!place.allFinite()) {  // came to no rest: as bad as a wall that does not move
                    place = pushes_[run].marker_mm + Vec3::Constant(no_rest_mm);
                    force = 0.0;
                }
                if (read) place = effects.read_tip(place);
                for (std::size_t c = 0; c < out.size(); ++c) {
                    const std::string& quantity = measured_[c]->quantity;
                    out[c][row] -= quantity == "force" ? force : place[quantity.back() - 'x'];
                }
            }
        }
        return out;
    }

    NamedNumbers parameters(std::span<const double>, std::span<const EffectTrial>) const override {
        return {{"young_modulus_kpa (given)", data_.contact.young_modulus_kpa}};
    }

    bool takes_up(const EffectInfo& effect, std::string_view key) const override {
        // A push at one place stretches the wall every way a little: of the fibres it sees how many there are.
        return effect.name == "stiffening" && key != "fibre_kpa";
    }

private:
    static constexpr double no_rest_mm = 20.0;

    PushResult pushed(RigEffects& effects, std::size_t run) const {
        effects.begin_run(static_cast<Index>(run));
        effects.points(walls_[run].triangles());
        PushedLaw law;
        law.begin = [&](std::size_t k) { effects.next_row(data_.time_s[first_[run] + k]); };
        law.fibres = effects.fibres();
        law.support_kpa_per_mm = effects.surroundings();
        if (effects.uses(hook_membrane)) {
            law.membrane = [&](const MembraneMaterial& material, MembranePoint& point) {
                effects.membrane(material, law.fibres, point);
            };
            law.remember = [&](const MembranePoint& point) { effects.remember(point); };
        }
        if (effects.uses(hook_slip)) {
            const auto held = [](std::size_t i, const Vec3& traction) {
                HeldPoint out;
                out.index = i;
                out.traction = traction;
                return out;
            };
            law.slip = [&effects, held](std::size_t i, const Vec3& traction) {
                HeldPoint point = held(i, traction);
                effects.slip(point);
                return point.slipped;
            };
            law.remember_slip = [&effects, held](std::size_t i, const Vec3& traction) {
                effects.remember_slip(held(i, traction));
            };
        }
        return walls_[run].push(pushes_[run], law);
    }

    std::vector<PushedWall> walls_;   // (runs) dense where each is pushed
    std::vector<Push> pushes_;        // (runs)
    std::vector<std::size_t> first_;  // (runs) row
    std::vector<PushResult> plain_;   // (runs) of the base model
};

}  // namespace

std::unique_ptr<Rig> make_contact_rig(const Dataset& data, const Split& split) {
    return std::make_unique<ContactRig>(data, split);
}

}  // namespace cathlab
