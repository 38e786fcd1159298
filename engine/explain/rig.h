// What was measured, done again by the engine: the smallest world in which a kind of data makes sense.  The engine's
// own kinematics and the effects' own code run in it, not copies of them.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "effects/effect.h"
#include "explain/dataset.h"
#include "explain/split.h"
#include "optimise/crew.h"
#include "optimise/problem.h"

namespace cathlab {

/// Numbers of every measured column, (columns x rows).
using Columns = std::vector<std::vector<double>>;

/// An effect with values for all of its parameters.
struct EffectTrial {
    const EffectInfo* effect = nullptr;
    std::vector<double> values;
    /// What runs by its own clock goes on between recordings: its phase at the start of each run, less that of the
    /// first.  Empty = the recordings begin alike.
    std::vector<double> phase_of_run = {};
    /// Values of the parameters in each run where recordings have their own (Rig::places_differ); those of the
    /// other parameters are as in `values`.  Empty = the same in all.
    std::vector<std::vector<double>> own = {};
};

/// The place of the parameter `phase`, or the number of parameters where there is none.
std::size_t phase_place(const EffectInfo& effect);

using NamedNumbers = std::vector<std::pair<std::string, double>>;

/// What a rig leaves from one model to the next one that is near it, so that it is found sooner.  One a search: its
/// models come one after another.
class RigMemory {
public:
    virtual ~RigMemory() = default;
};

/// Const after construction; its functions may be called from several threads.
class Rig {
public:
    Rig(const Dataset& data, const Split& split);
    virtual ~Rig() = default;
    Rig(const Rig&) = delete;
    Rig& operator=(const Rig&) = delete;

    const Dataset& data() const { return data_; }
    const Split& split() const { return split_; }
    /// Measured columns, in the data's order.
    const std::vector<const DataColumn*>& measured() const { return measured_; }

    /// The base model's free numbers that a search has to find; those that are linear are found by residual() itself.
    virtual std::vector<Bound> bounds() const { return {}; }
    /// Where to begin with them.
    virtual std::vector<double> start() const { return {}; }

    /// Measured less modelled, with these base numbers and effects; NaN where nothing was measured.
    virtual Columns residual(std::span<const double> base, std::span<const EffectTrial> effects) const = 0;

    /// The same to the rig's own tolerance, beginning at what the last model of `memory` left.
    virtual std::unique_ptr<RigMemory> memory() const { return nullptr; }
    virtual Columns residual_near(std::span<const double> base, std::span<const EffectTrial> effects,
                                  RigMemory* /*memory*/) const {
        return residual(base, effects);
    }

    /// The base model's numbers, the linear ones too, with names.
    virtual NamedNumbers parameters(std::span<const double> base, std::span<const EffectTrial> effects) const = 0;

    /// Why an effect cannot be tried on these data, in a sentence; "" where it can.
    virtual std::string why_not(const EffectInfo& effect) const;

    /// Whether one model takes seconds: searches are then short.
    virtual bool slow() const { return false; }

    /// A rig that corrects its models by what a finer one says of a single one: from now on by what it says of this.
    /// Not while other threads ask it.
    virtual void anchor(std::span<const EffectTrial> /*effects*/) {}

    /// By how much the base model itself is known to be off, root mean square a measured column; empty = it is exact.
    virtual std::vector<double> own_error() const { return {}; }

    /// Whether each recording was taken at another place.
    virtual bool places_differ() const { return false; }

    /// What the reader should know of how the data were taken, a sentence each.
    virtual std::vector<std::string> notes() const { return {}; }

    /// Whether the base model's own numbers do what this parameter does: it is then not searched.
    virtual bool takes_up(const EffectInfo& /*effect*/, std::string_view /*key*/) const { return false; }

protected:
    const Dataset& data_;
    const Split& split_;
    std::vector<const DataColumn*> measured_;
    unsigned hooks_ = 0;  ///< that this rig asks
};

/// Throws UserError for kinds without a rig, for more than 100,000 rows, and for data that do not determine the base
/// model.  crew: those who may help with one model; results do not depend on it.
std::unique_ptr<Rig> make_rig(const Dataset& data, const Split& split, const Crew& crew = Crew());

/// The rows that the fit sees (0) or that judge it (1): root mean square a measured column.  NaN without such a row.
double rms_of(const Columns& residual, const Split& split, std::uint8_t part);

}  // namespace cathlab
