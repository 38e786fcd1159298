// The world: named entities and one table a component type.  Models are const after load and may be shared between
// worlds; states belong to one world and change only in step().
#pragma once

#include <concepts>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <typeindex>
#include <vector>

#include "core/check.h"
#include "core/hash.h"
#include "core/parallel.h"

namespace cathlab {

enum class Entity : std::int32_t { none = -1 };

/// A component whose fields can be visited goes into the state hash; any other (a model, a scratch array) does not.
template <class T>
concept Visitable = requires(Archive& archive, T& t) {
    visit(archive, t);
};

class World {
public:
    explicit World(std::uint64_t seed = 1, Workers workers = Workers(1)) : seed_(seed), workers_(std::move(workers)) {}
    World(const World&) = delete;
    World& operator=(const World&) = delete;
    World(World&&) = default;
    World& operator=(World&&) = default;

    /// A new entity; the name must be new in this world.
    Entity create(const std::string& name);
    const std::string& name(Entity e) const { return names_.at(static_cast<std::size_t>(e)); }
    std::optional<Entity> find(const std::string& name) const;
    std::size_t entity_count() const { return names_.size(); }

    /// Moves a component in.  An entity has at most one of a type.  References stay valid for the life of the world.
    template <class T>
    T& add(Entity e, T component) {
        auto& table = this->template table<T>();
        CATHLAB_CHECK(!table.find(e), "entity '" + name(e) + "' has this component already");
        if (table.rows.empty()) order_.push_back(&table);
        return table.insert(e, std::move(component));
    }

    /// The component of an entity, or nullptr.
    template <class T>
    T* get(Entity e) {
        return table<T>().find(e);
    }
    template <class T>
    const T* get(Entity e) const {
        const auto it = tables_.find(std::type_index(typeid(T)));
        return it == tables_.end() ? nullptr : static_cast<const Table<T>&>(*it->second).find(e);
    }

    /// The first component of a type (most types occur once in a world), or nullptr.
    template <class T>
    T* first() {
        auto& rows = table<T>().rows;
        return rows.empty() ? nullptr : &rows.front().component;
    }
    template <class T>
    const T* first() const {
        const auto it = tables_.find(std::type_index(typeid(T)));
        if (it == tables_.end()) return nullptr;
        const auto& rows = static_cast<const Table<T>&>(*it->second).rows;
        return rows.empty() ? nullptr : &rows.front().component;
    }

    /// The entity that owns the first component of a type.
    template <class T>
    Entity owner() const {
        const auto it = tables_.find(std::type_index(typeid(T)));
        if (it == tables_.end()) return Entity::none;
        const auto& rows = static_cast<const Table<T>&>(*it->second).rows;
        return rows.empty() ? Entity::none : rows.front().entity;
    }

    /// Calls f(entity, component) in order of insertion.
    template <class T, class F>
    void each(F&& f) {
        for (auto& row : table<T>().rows) f(row.entity, row.component);
    }

    /// One hash an entity (of its visitable components in order of insertion), and the whole.  Includes the step.
    struct StateHash {
        std::uint64_t whole = 0;
        std::vector<std::pair<std::string, std::uint64_t>> entities;
    };
    StateHash state_hash();

    /// Lets an archive see every visitable component: f(entity name) is called before each entity's fields.
    void visit_states(Archive& archive, Entity e);

    std::uint64_t seed() const { return seed_; }
    const Workers& workers() const { return workers_; }

    std::int64_t step_index = 0;  ///< steps done
    double time_s = 0.0;          ///< = step_index * step length

private:
    struct TableBase {
        virtual ~TableBase() = default;
        virtual void visit_entity(Archive& archive, Entity e) = 0;
    };
    template <class T>
    struct Table final : TableBase {
        struct Row {
            Entity entity;
            T component;
        };
        std::deque<Row> rows;  // a deque never moves what it holds when it grows at the end

        T* find(Entity e) {
            for (Row& row : rows)
                if (row.entity == e) return &row.component;
            return nullptr;
        }
        const T* find(Entity e) const { return const_cast<Table*>(this)->find(e); }
        T& insert(Entity e, T&& component) { return rows.emplace_back(Row{e, std::move(component)}).component; }
        void visit_entity(Archive& archive, Entity e) override {
            if constexpr (Visitable<T>) {
                if (T* component = find(e)) visit(archive, *component);
            }
        }
    };

    template <class T>
    Table<T>& table() {
        auto& slot = tables_[std::type_index(typeid(T))];
        if (!slot) slot = std::make_unique<Table<T>>();
        return static_cast<Table<T>&>(*slot);
    }

    std::uint64_t seed_;
    Workers workers_;
    std::vector<std::string> names_;
    std::map<std::type_index, std::unique_ptr<TableBase>> tables_;
    std::vector<TableBase*>
        order_;  // order of the first add: independent of addresses, unlike the map's, and of who looked for what
};

}  // namespace cathlab
