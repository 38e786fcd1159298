// One scene, stepped, reset and seeded by code: actions in and observations out as plain arrays.  For controllers and
// for whatever learns (docs/api.md).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/channels.h"
#include "core/event.h"
#include "core/input.h"

namespace cathlab {

class World;

/// An action array has one number for each action of core/actions.inl, an observation array one for each channel of
/// core/channels.inl, both in that order.  Nothing is shared between two simulators but what never changes, so any
/// number of them may run side by side, each on a thread of its own.
class Simulator {
public:
    /// scene: a file, or the name of one in data_root/scenes.  data_root: the folder that holds assets and scenes.
    /// cache_folder: where built anatomies are kept; "" = nowhere.  threads: of a step, 1 or more; they change no bit.
    /// Builds the scene's models, which takes seconds, and a world with the scene's own seed.
    /// Throws UserError for what the files get wrong, std::logic_error for threads below 1.
    explicit Simulator(const std::string& scene, const std::string& data_root = ".",
                       const std::string& cache_folder = "", int threads = 1);
    /// The same scene again, with its models shared and a world of its own.
    Simulator another() const;

    ~Simulator();
    Simulator(Simulator&&) noexcept;
    Simulator& operator=(Simulator&&) noexcept;

    /// A new world at rest, of the same models: two resets with one seed, and the same actions, give the same bits.
    void reset(std::uint64_t seed);

    /// One step of dt_s().  An action out of its range counts as its limit, one that is not a number as its default;
    /// events() tells.  Throws std::logic_error where an array has another size; the observation may be empty.
    void step(std::span<const double> action, std::span<double> observation);

    /// Of the last step; zero after a reset.
    void observe(std::span<double> observation) const;
    const Channels& channels() const;
    const std::vector<Event>& events() const;

    double dt_s() const;
    std::uint64_t state_hash();
    /// For what the channels do not tell: its components are those of step/parts.h.
    World& world();

    static std::size_t action_size() { return action_table().size(); }
    static std::size_t observation_size() { return channel_table().size(); }
    /// What an operator does who does nothing.
    std::vector<double> idle() const;
    /// Place of an action or a channel in its array.  Throws UserError that names the nearest one where there is none.
    static std::size_t action(std::string_view name);
    static std::size_t observation(std::string_view name);

private:
    struct Impl;
    explicit Simulator(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab
