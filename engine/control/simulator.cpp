#include "control/simulator.h"

#include "core/check.h"
#include "core/errors.h"
#include "scene/build_world.h"
#include "scene/load_scene.h"
#include "scene/script.h"
#include "step/step.h"
#include "world/world.h"

namespace cathlab {

struct Simulator::Impl {
    SceneSpec scene;
    std::shared_ptr<const SceneModels> models;
    int threads = 1;
    std::unique_ptr<World> world;
    Channels channels;
    std::vector<Event> events;

    void reset(std::uint64_t seed) {
        world = build_world(scene, *models, seed, threads);
        prepare(*world);
        channels = {};
        take_events();
    }
    void take_events() {
        EventLog& log = *world->first<EventLog>();
        events = std::move(log.pending);
        log.pending.clear();
    }
};

namespace {

template <class Info>
std::size_t place_of(std::span<const Info> table, std::string_view name, const std::string& what) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < table.size(); ++i) {
        if (table[i].name == name) return i;
        names.emplace_back(table[i].name);
    }
    throw UserError("there is no " + what + " '" + std::string(name) + "'" + did_you_mean(std::string(name), names));
}

}  // namespace

Simulator::Simulator(const std::string& scene, const std::string& data_root, const std::string& cache_folder,
                     int threads)
    : impl_(std::make_unique<Impl>()) {
    CATHLAB_CHECK(threads >= 1, "a step runs on one thread at least");
    impl_->scene = load_scene(find_scene(scene, data_root), {}, data_root);
    BuildOptions options;
    options.threads = threads;
    options.cache_folder = cache_folder;
    impl_->models = build_models(impl_->scene, options);
    impl_->threads = threads;
    impl_->reset(impl_->scene.seed);
}

Simulator::Simulator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

Simulator Simulator::another() const {
    auto impl = std::make_unique<Impl>();
    impl->scene = impl_->scene;
    impl->models = impl_->models;
    impl->threads = impl_->threads;
    impl->reset(impl->scene.seed);
    return Simulator(std::move(impl));
}

void Simulator::reset(std::uint64_t seed) {
    impl_->reset(seed);
}

void Simulator::step(std::span<const double> action, std::span<double> observation) {
    CATHLAB_CHECK(action.size() == action_size(), "one number an action");
    Input input;
    for (std::size_t i = 0; i < action.size(); ++i) input.*action_table()[i].value = action[i];
    cathlab::step(*impl_->world, input, impl_->channels);
    impl_->take_events();
    if (!observation.empty()) observe(observation);
}

void Simulator::observe(std::span<double> observation) const {
    CATHLAB_CHECK(observation.size() == observation_size(), "one number a channel");
    for (std::size_t i = 0; i < observation.size(); ++i) observation[i] = impl_->channels.*channel_table()[i].value;
}

const Channels& Simulator::channels() const {
    return impl_->channels;
}
const std::vector<Event>& Simulator::events() const {
    return impl_->events;
}
double Simulator::dt_s() const {
    return impl_->scene.step.dt_s;
}
std::uint64_t Simulator::state_hash() {
    return impl_->world->state_hash().whole;
}
World& Simulator::world() {
    return *impl_->world;
}

std::vector<double> Simulator::idle() const {
    std::vector<double> action;
    const Input input = base_input(impl_->scene);
    for (const ActionInfo& info : action_table()) action.push_back(input.*info.value);
    return action;
}

std::size_t Simulator::action(std::string_view name) {
    return place_of(action_table(), name, "action");
}
std::size_t Simulator::observation(std::string_view name) {
    return place_of(channel_table(), name, "channel");
}

}  // namespace cathlab
