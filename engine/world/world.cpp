#include "world/world.h"

#include <algorithm>

namespace cathlab {

Entity World::create(const std::string& name) {
    CATHLAB_CHECK(!find(name), "an entity named '" + name + "' exists already");
    names_.push_back(name);
    return static_cast<Entity>(names_.size() - 1);
}

std::optional<Entity> World::find(const std::string& name) const {
    const auto it = std::find(names_.begin(), names_.end(), name);
    if (it == names_.end()) return std::nullopt;
    return static_cast<Entity>(it - names_.begin());
}

void World::visit_states(Archive& archive, Entity e) {
    for (TableBase* table : order_) table->visit_entity(archive, e);
}

World::StateHash World::state_hash() {
    StateHash out;
    Hash64 whole;
    whole.word(static_cast<std::uint64_t>(step_index));
    for (std::size_t i = 0; i < names_.size(); ++i) {
        HashArchive archive;
        visit_states(archive, static_cast<Entity>(i));
        out.entities.emplace_back(names_[i], archive.value());
        whole.text(names_[i]);
        whole.word(archive.value());
    }
    out.whole = whole.value();
    return out;
}

}  // namespace cathlab
