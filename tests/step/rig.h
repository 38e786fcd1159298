// The three small scenes of scenes/rigs, ready to be stepped.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scene/build_world.h"
#include "scene/load_scene.h"
#include "step/parts.h"
#include "step/step.h"

namespace cathlab {

inline SceneSpec rig_spec(const std::string& name, const std::vector<std::string>& overlays = {}) {
    return load_scene(std::string(CATHLAB_SOURCE_DIR) + "/scenes/rigs/" + name + ".toml", overlays, CATHLAB_SOURCE_DIR);
}

/// Models of a rig as it stands in its file, built once a process.
inline const SceneModels& rig_models(const std::string& name) {
    static std::map<std::string, std::shared_ptr<const SceneModels>> built;
    auto& models = built[name];
    if (!models) models = build_models(rig_spec(name), {});
    return *models;
}

/// A world with its channels and the events since its beginning.
struct RigRun {
    std::unique_ptr<World> world;
    Parts parts;
    Channels channels;
    std::vector<Event> events;

    explicit RigRun(std::unique_ptr<World> fresh) : world(std::move(fresh)) {
        prepare(*world);
        parts = find_parts(*world);
    }
    RigRun(const SceneSpec& spec, const std::string& models, int threads = 1)
        : RigRun(build_world(spec, rig_models(models), spec.seed, threads)) {}
    explicit RigRun(const std::string& name, int threads = 1) : RigRun(rig_spec(name), name, threads) {}

    void step(const Input& input, int count = 1) {
        for (int k = 0; k < count; ++k) {
            cathlab::step(*world, input, channels);
            EventLog& log = *world->first<EventLog>();
            events.insert(events.end(), log.pending.begin(), log.pending.end());
            log.pending.clear();
        }
    }
    std::uint64_t hash() { return world->state_hash().whole; }
    std::uint64_t hash_of(const std::string& entity) {
        for (const auto& [name, hash] : world->state_hash().entities)
            if (name == entity) return hash;
        ADD_FAILURE() << "no entity " << entity;
        return 0;
    }
    bool finite() const {
        for (const ChannelInfo& channel : channel_table())
            if (!std::isfinite(channels.*channel.value)) return false;
        for (const Vec3& x : parts.wall_state->x)
            if (!x.allFinite()) return false;
        return true;
    }
    int count_events(const std::string& kind) const {
        int count = 0;
        for (const Event& event : events) count += event.kind == kind ? 1 : 0;
        return count;
    }
};

/// Switches an effect on, with defaults but for the values that are named.
inline void enable(SceneSpec& spec, const std::string& name, const std::map<std::string, double>& values) {
    for (SceneEffect& effect : spec.effects) {
        if (effect.info->name != name) continue;
        effect.enabled = true;
        std::size_t used = 0;
        for (std::size_t i = 0; i < effect.info->parameters.size(); ++i) {
            const auto it = values.find(std::string(effect.info->parameters[i].key));
            if (it == values.end()) continue;
            effect.values[i] = it->second;
            ++used;
        }
        EXPECT_EQ(used, values.size());
        return;
    }
    FAIL() << "no effect " << name;
}

inline Input push(double speed_mm_s, double device = 0.0) {
    Input input;
    input.device = device;
    input.advance = speed_mm_s;
    return input;
}

/// What an operator does in step k of a rig: everything at once, with numbers that do not fit each other.
inline Input busy_hands(int k) {
    Input input;
    input.device = (k / 30) % 2 == 0 ? 0.0 : 1.0;
    input.advance = k % 40 < 32 ? 47.0 : -31.0;
    input.rotate = k % 25 < 12 ? 130.0 : -77.0;
    input.proximal_bend = 0.31 * static_cast<double>(k);
    input.proximal_direction = 0.7 * static_cast<double>(k);
    input.distal_bend = 0.53 * static_cast<double>(k);
    input.fluoroscopy = k % 50 < 30 ? 1.0 : 0.0;
    input.primary_angle = 0.2 * static_cast<double>(k);
    input.contrast = k % 60 < 20 ? 4.0 : 0.0;
    return input;
}

}  // namespace cathlab
