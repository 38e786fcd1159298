// Kind wall-contact: the vessel of the data as an elastic shell at rest, pushed by the tool sample by sample; its
// material is given, nothing is fitted.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "core/errors.h"
#include "explain/rigs.h"
#include "explain/wall_contact.h"
#include "softbody/push_rig.h"
#include "softbody/shell_statics.h"

namespace cathlab {
namespace {

// Models are searched on particles so far apart; what that costs is known of one of them, at first the base model,
// which is solved on two sets of finer ones too, and taken off every model in proportion.  What goes from one of these
// to the other says how much is left to none at all: errors fall with the square of the distance [richardson1911].
constexpr double spacing_mm = 4.0, far_spacing_mm = 9.0;
constexpr double middle_spacing_mm = 2.5, middle_far_spacing_mm = 6.0;
constexpr double fine_spacing_mm = 1.5, fine_far_spacing_mm = 3.5;
constexpr double square_ratio = middle_spacing_mm * middle_spacing_mm / (fine_spacing_mm * fine_spacing_mm);
constexpr double left_of_step = 1.0 / (square_ratio - 1.0);

// What the shell is off of finite elements of a solid wall, a seventh to an eighth of its radius thick, as a part of
// how far the marker goes and of the force (docs/validation.md, walls pushed by a ball).
constexpr double solid_marker = 0.015, solid_force = 0.035;

// Factors kept of every sample's matrix are some MB each.
constexpr std::size_t most_factors = 400;

constexpr unsigned of_wall = hook_material | hook_membrane | hook_slip;

class ContactRig final : public Rig {
public:
    ContactRig(const Dataset& data, const Split& split, const Crew& crew) : Rig(data, split), crew_(crew) {
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
        walls_.resize(pushes_.size());
        plain_.resize(pushes_.size());
        middle_.resize(pushes_.size());
        finest_.resize(pushes_.size());
        crew_.each(3 * pushes_.size(), [&](std::size_t k) {
            const std::size_t run = k % pushes_.size();
            if (k < pushes_.size()) {  // the longest first
                finest_[run] = rest_of(run, wall_of(run, fine_spacing_mm, fine_far_spacing_mm), false);
            } else if (k < 2 * pushes_.size()) {
                middle_[run] = rest_of(run, wall_of(run, middle_spacing_mm, middle_far_spacing_mm), false);
            } else {
                walls_[run].emplace(wall_of(run, spacing_mm, far_spacing_mm));
                plain_[run] = rest_of(run, *walls_[run], true);
            }
        });
        for (std::size_t run = 0; run < pushes_.size(); ++run) go_on(middle_[run], finest_[run]);
        about_ = plain_;
        about_middle_ = middle_;
        about_finest_ = finest_;
    }

    bool slow() const override { return true; }

    /// What the finest particles change of those in the middle, nearly twice what they are thought to leave; and what a
    /// shell is off of a solid wall.
    std::vector<double> own_error() const override {
        std::vector<double> out;
        for (const DataColumn* column : measured_) {
            const bool force = column->quantity == "force";
            const auto axis = static_cast<Eigen::Index>(force ? 0 : column->quantity.back() - 'x');
            double square = 0.0, samples = 0.0;
            for (std::size_t run = 0; run < pushes_.size(); ++run)
                for (std::size_t k = 0; k < pushes_[run].ball_mm.size(); ++k) {
                    const PushResult &middle = about_middle_[run], &finest = about_finest_[run];
                    const double all = force ? finest.force_mn[k] - middle.force_mn[k]
                                             : (finest.marker_mm[k] - middle.marker_mm[k])[axis];
                    const double far = force ? solid_force * finest.force_mn[k]
                                             : solid_marker * (finest.marker_mm[k] - pushes_[run].marker_mm)[axis];
                    const double off = all / (1.0 + left_of_step);
                    square += off * off + far * far;
                    samples += 1.0;
                }
            out.push_back(std::sqrt(square / samples));
        }
        return out;
    }

    void anchor(std::span<const EffectTrial> trials) override {
        about_ = plain_;
        about_middle_ = middle_;
        about_finest_ = finest_;
        if (!RigEffects(trials).uses(of_wall)) return;
        std::vector<PushResult> coarse(pushes_.size()), middle(pushes_.size()), finest(pushes_.size());
        crew_.each(3 * pushes_.size(), [&](std::size_t k) {
            const std::size_t run = k % pushes_.size();
            RigEffects effects(trials);
            if (k < pushes_.size())
                finest[run] = pushed_on(wall_of(run, fine_spacing_mm, fine_far_spacing_mm), effects, run, pushes_[run]);
            else if (k < 2 * pushes_.size())
                middle[run] =
                    pushed_on(wall_of(run, middle_spacing_mm, middle_far_spacing_mm), effects, run, pushes_[run]);
            else
                coarse[run] = pushed(effects, run, nullptr);
        });
        for (const auto* results : {&coarse, &middle, &finest})
            for (const PushResult& result : *results)
                if (!result.at_rest) return;
        for (std::size_t run = 0; run < pushes_.size(); ++run) go_on(middle[run], finest[run]);
        about_ = std::move(coarse);
        about_middle_ = std::move(middle);
        about_finest_ = std::move(finest);
    }

    std::unique_ptr<RigMemory> memory() const override {
        auto out = std::make_unique<Memory>();
        forget(*out);
        return out;
    }

    Columns residual(std::span<const double> base, std::span<const EffectTrial> trials) const override {
        return residual_near(base, trials, nullptr);
    }

    Columns residual_near(std::span<const double>, std::span<const EffectTrial> trials,
                          RigMemory* memory) const override {
        Columns out;
        for (const DataColumn* column : measured_) out.push_back(column->values);
        RigEffects effects(trials);
        const bool walled = effects.uses(of_wall), read = effects.uses(hook_measure);
        std::vector<PushResult> pushes(pushes_.size());
        // A law under which one wall does not come to rest is none: the others need not go on.
        std::atomic<bool> at_rest{true};
        if (walled)
            crew_.each(pushes_.size(), [&](std::size_t run) {
                RigEffects of_run(trials);
                pushes[run] = pushed(of_run, run, static_cast<Memory*>(memory), [&] { return at_rest.load(); });
                if (!pushes[run].at_rest) at_rest = false;
            });
        if (!at_rest && memory != nullptr) forget(*static_cast<Memory*>(memory));
        for (std::size_t run = 0; run < pushes_.size(); ++run) {
            const PushResult& own = pushes[run];
            effects.begin_run(static_cast<Index>(run));
            for (std::size_t k = 0; k < pushes_[run].ball_mm.size(); ++k) {
                const std::size_t row = first_[run] + k;
                effects.next_row(data_.time_s[row]);
                Vec3 place = finest_[run].marker_mm[k];
                double force = finest_[run].force_mn[k];
                if (walled && !at_rest) place.setConstant(std::numeric_limits<double>::quiet_NaN());
                if (walled && at_rest) {
                    const PushResult &coarse = about_[run], &finest = about_finest_[run];
                    const Vec3& rest = pushes_[run].marker_mm;
                    const double moved = part_of((own.marker_mm[k] - rest).norm(), (coarse.marker_mm[k] - rest).norm());
                    place = own.marker_mm[k] + moved * (finest.marker_mm[k] - coarse.marker_mm[k]);
                    const double pushed = part_of(own.force_mn[k], coarse.force_mn[k]);
                    force = own.force_mn[k] + pushed * (finest.force_mn[k] - coarse.force_mn[k]);
                }
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
        // The walls of this rig have no direction: their fibres lie every way alike.  A ball strains too little of them
        // to tell measures of strain apart.
        return key == "measure" || (effect.name == "stiffening" && (key == "angle_deg" || key == "dispersion"));
    }

private:
    static constexpr double no_rest_mm = 20.0;

    /// How much of what finer particles change of one model they change of another one: as much more or less as
    /// that one moves.
    static double part_of(double own, double plain) {
        constexpr double most = 3.0, nothing = 1e-3;
        return std::fabs(plain) > nothing ? std::clamp(own / plain, 0.0, most) : 1.0;
    }

    /// From the finest particles to none at all.
    static void go_on(const PushResult& middle, PushResult& finest) {
        for (std::size_t k = 0; k < finest.marker_mm.size(); ++k) {
            finest.marker_mm[k] += left_of_step * (finest.marker_mm[k] - middle.marker_mm[k]);
            finest.force_mn[k] += left_of_step * (finest.force_mn[k] - middle.force_mn[k]);
        }
    }

    struct Memory final : RigMemory {
        std::vector<std::vector<std::vector<Vec3>>> wall;                 // (runs, samples)
        std::vector<std::vector<std::shared_ptr<ShellFactors>>> factors;  // (runs, samples) or (runs, 0)
    };

    PushedWall wall_of(std::size_t run, double spacing, double far_spacing) const {
        PushRig rig = push_rig_of(data_.contact, spacing);
        rig.far_spacing_mm = far_spacing;
        rig.looked_at = pushes_[run].ball_mm;
        rig.looked_at.push_back(pushes_[run].marker_mm);
        return PushedWall(rig);
    }

    PushResult rest_of(std::size_t run, const PushedWall& wall, bool keep_wall) const {
        Push push = pushes_[run];
        push.keep_wall = keep_wall;
        PushResult out = wall.push(push);
        if (!out.at_rest)
            throw UserError(data_.folder + ": the wall of run " + data_.run_names[run] +
                            " comes to no rest under its tool; there is no base model");
        return out;
    }

    /// How far others came before they were stopped is not to be seen in what is found next.
    void forget(Memory& memory) const {
        memory.wall.clear();
        memory.factors.clear();
        for (std::size_t run = 0; run < pushes_.size(); ++run) {
            memory.wall.push_back(plain_[run].wall_mm);
            memory.factors.emplace_back(data_.rows() <= most_factors ? pushes_[run].ball_mm.size() : 0);
        }
    }

    PushResult pushed(RigEffects& effects, std::size_t run, Memory* memory,
                      const std::function<bool()>& go_on = {}) const {
        Push push = pushes_[run];
        push.guess = plain_[run].wall_mm;
        if (memory == nullptr) return pushed_on(*walls_[run], effects, run, push, go_on);
        push.keep_wall = true;
        push.guess = memory->wall[run];
        push.factors = memory->factors[run];
        PushResult out = pushed_on(*walls_[run], effects, run, push, go_on);
        if (out.at_rest) memory->wall[run] = std::move(out.wall_mm);
        return out;
    }

    PushResult pushed_on(const PushedWall& wall, RigEffects& effects, std::size_t run, const Push& push,
                         const std::function<bool()>& go_on = {}) const {
        effects.begin_run(static_cast<Index>(run));
        effects.points(wall.triangles());
        PushedLaw law;
        law.begin = [&](std::size_t k) { effects.next_row(data_.time_s[first_[run] + k]); };
        law.fibres = effects.fibres();
        law.support_kpa_per_mm = effects.surroundings();
        if (effects.uses(hook_membrane)) {
            law.membrane = [&](const MembraneMaterial& material, MembranePoint& point) {
                effects.membrane(material, law.fibres, point);
            };
            if (effects.remembers()) law.remember = [&](const MembranePoint& point) { effects.remember(point); };
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
        return wall.push(push, law, go_on);
    }

    std::vector<std::optional<PushedWall>> walls_;  // (runs) dense where each is pushed
    std::vector<Push> pushes_;                      // (runs)
    std::vector<std::size_t> first_;                // (runs) row
    std::vector<PushResult> plain_;                 // (runs) of the base model on them
    std::vector<PushResult> middle_;                // (runs) of the base model on finer ones
    std::vector<PushResult> finest_;                // (runs) and on none at all
    // (runs) of the model by which others are corrected
    std::vector<PushResult> about_, about_middle_, about_finest_;
    Crew crew_;
};

}  // namespace

std::unique_ptr<Rig> make_contact_rig(const Dataset& data, const Split& split, const Crew& crew) {
    return std::make_unique<ContactRig>(data, split, crew);
}

}  // namespace cathlab
