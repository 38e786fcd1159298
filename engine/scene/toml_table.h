// A section of a file described once: key, kind, unit, range, doc and the member of a plain struct that it fills.
// Reading with errors, the JSON Schema and the docs come from the same description.
//
//     struct Vessel { std::string name; double length_mm = 10; std::vector<std::array<double, 3>> points; SourcePlace
//     where; }; const auto vessel = Table<Vessel>("one vessel")
//         .text("name", &Vessel::name, "its name").required()
//         .number("length_mm", &Vessel::length_mm, "mm", {1, 500}, "length along the centre-line")
//         .rows("points_mm", &Vessel::points, "mm", {-1000, 1000}, {2, 500}, "centre-line")
//         .place(&Vessel::where);
//     struct File { std::vector<Vessel> vessels; };
//     const auto file = Table<File>("an anatomy").tables("vessel", &File::vessels, vessel, "vessels");
//     File f = read_table(load_toml(path), file);          // throws UserError: file:line: [vessel 2] lenght_mm: no
//     such key...
//
// Defaults are the struct's own initial values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/check.h"
#include "core/parameter.h"
#include "core/types.h"
#include "scene/toml_document.h"

namespace cathlab {

struct Range {
    double minimum = -std::numeric_limits<double>::infinity();  ///< inclusive; NaN and infinities are never allowed
    double maximum = std::numeric_limits<double>::infinity();   ///< inclusive
};

struct Count {
    std::size_t least = 0;
    std::size_t most = 100000;
};

/// A landmark's name or a point in world coordinates (mm): whichever the file gave.
struct NameOrPoint {
    std::string name;  ///< "" when a point was given
    Vec3 point = Vec3::Zero();
};

enum class FieldKind {
    number,
    integer,
    boolean,
    text,
    choice,
    path,
    numbers,
    rows,
    texts,
    name_or_point,
    table,
    tables
};

using FieldValue = std::variant<std::monostate, double, std::int64_t, bool, std::string, std::vector<double>,
                                std::vector<std::string>>;

struct TableSpec;

/// One key of a section.  The functions see the struct through an untyped pointer; Table<T> below writes them.
struct FieldSpec {
    std::string key;
    FieldKind kind = FieldKind::number;
    std::string unit;
    std::string doc;
    Range range;                       ///< of each number
    Count count;                       ///< of entries: numbers, rows, texts, tables
    std::size_t width = 1;             ///< numbers a row
    std::vector<std::string> choices;  ///< of a choice
    std::string library;               ///< of a path: folder of the data root in which a bare name is looked up
    bool required = false;
    bool unlisted = false;  ///< allowed, but not named among the known keys of an error

    std::function<void(void* object, const FieldValue& value)> store;
    std::function<FieldValue(const void* object)> load;  ///< for defaults in the schema and the docs
    std::shared_ptr<const TableSpec> sub;                ///< of a table and of tables
    std::function<void*(void* object)> open;             ///< table: the member; tables: appends one and returns it
    std::function<void(void* object)> clear;             ///< tables: a file's list replaces the default one
};

struct TableSpec {
    std::string doc;
    std::vector<FieldSpec> fields;
    std::function<void(void* object, const SourcePlace&)> store_place;
    std::function<std::shared_ptr<void>()> make_default;
};

/// Turns the text of a path field into a path that exists, or throws UserError.  `library`: see FieldSpec.
using PathResolver =
    std::function<std::string(const std::string& text, const std::string& library, const SourcePlace& where)>;

/// Relative to the folder of the file that holds the key.
std::string resolve_beside_file(const std::string& text, const std::string& library, const SourcePlace& where);

/// Fills object (of the spec's type) from a table node; section = the name that errors show, "" at the top.
void read_table(const TomlNode& node, const TableSpec& spec, void* object,
                const PathResolver& resolve = resolve_beside_file, const std::string& section = "");

template <class T>
class Table {
public:
    explicit Table(std::string doc) {
        spec_.doc = std::move(doc);
        spec_.make_default = [] { return std::static_pointer_cast<void>(std::make_shared<T>()); };
    }
    const TableSpec& spec() const { return spec_; }

    /// M: double or std::optional<double>
    template <class M>
    Table& number(std::string key, M T::*member, std::string unit, Range range, std::string doc) {
        FieldSpec& f = add(std::move(key), FieldKind::number, std::move(unit), range, std::move(doc));
        f.store = [member](void* o, const FieldValue& v) { self(o).*member = std::get<double>(v); };
        f.load = [member](const void* o) -> FieldValue {
            if constexpr (std::is_same_v<M, double>)
                return self(o).*member;
            else if (const auto& value = self(o).*member)
                return *value;
            return std::monostate{};
        };
        return *this;
    }
    /// M: any integer type; numbers up to 2^53
    template <class M>
    Table& integer(std::string key, M T::*member, std::string unit, Range range, std::string doc) {
        FieldSpec& f = add(std::move(key), FieldKind::integer, std::move(unit), range, std::move(doc));
        f.store = [member](void* o, const FieldValue& v) {
            self(o).*member = static_cast<M>(std::get<std::int64_t>(v));
        };
        f.load = [member](const void* o) -> FieldValue { return static_cast<std::int64_t>(self(o).*member); };
        return *this;
    }
    Table& boolean(std::string key, bool T::*member, std::string doc) {
        return plain<bool>(std::move(key), FieldKind::boolean, member, std::move(doc));
    }
    Table& text(std::string key, std::string T::*member, std::string doc) {
        return plain<std::string>(std::move(key), FieldKind::text, member, std::move(doc));
    }
    Table& choice(std::string key, std::string T::*member, std::vector<std::string> choices, std::string doc) {
        plain<std::string>(std::move(key), FieldKind::choice, member, std::move(doc));
        spec_.fields.back().choices = std::move(choices);
        return *this;
    }
    /// The member receives what the resolver made of the text.
    Table& path(std::string key, std::string T::*member, std::string doc, std::string library = "") {
        plain<std::string>(std::move(key), FieldKind::path, member, std::move(doc));
        spec_.fields.back().library = std::move(library);
        return *this;
    }
    Table& texts(std::string key, std::vector<std::string> T::*member, Count count, std::string doc) {
        plain<std::vector<std::string>>(std::move(key), FieldKind::texts, member, std::move(doc));
        spec_.fields.back().count = count;
        return *this;
    }
    Table& numbers(std::string key, std::vector<double> T::*member, std::string unit, Range range, Count count,
                   std::string doc) {
        plain<std::vector<double>>(std::move(key), FieldKind::numbers, member, std::move(doc));
        FieldSpec& f = spec_.fields.back();
        f.unit = std::move(unit);
        f.range = range;
        f.count = count;
        return *this;
    }
    /// Exactly three numbers.
    Table& vec3(std::string key, Vec3 T::*member, std::string unit, Range range, std::string doc) {
        FieldSpec& f = add(std::move(key), FieldKind::numbers, std::move(unit), range, std::move(doc));
        f.count = {3, 3};
        f.store = [member](void* o, const FieldValue& v) {
            self(o).*member = Vec3(std::get<std::vector<double>>(v).data());
        };
        f.load = [member](const void* o) -> FieldValue {
            const Vec3& p = self(o).*member;
            return std::vector<double>{p.x(), p.y(), p.z()};
        };
        return *this;
    }
    /// A list of rows of N numbers: [[0.0, 1.5], [0.1, 2.0]]
    template <std::size_t N>
    Table& rows(std::string key, std::vector<std::array<double, N>> T::*member, std::string unit, Range range,
                Count count, std::string doc) {
        FieldSpec& f = add(std::move(key), FieldKind::rows, std::move(unit), range, std::move(doc));
        f.count = count;
        f.width = N;
        f.store = [member](void* o, const FieldValue& v) {
            const auto& flat = std::get<std::vector<double>>(v);
            auto& rows = self(o).*member;
            rows.resize(flat.size() / N);
            for (std::size_t i = 0; i < flat.size(); ++i) rows[i / N][i % N] = flat[i];
        };
        f.load = [member](const void* o) -> FieldValue {
            std::vector<double> flat;
            for (const auto& row : self(o).*member) flat.insert(flat.end(), row.begin(), row.end());
            return flat;
        };
        return *this;
    }
    Table& name_or_point(std::string key, NameOrPoint T::*member, Range range, std::string doc) {
        FieldSpec& f = add(std::move(key), FieldKind::name_or_point, "mm", range, std::move(doc));
        f.store = [member](void* o, const FieldValue& v) {
            NameOrPoint& out = self(o).*member;
            if (const auto* name = std::get_if<std::string>(&v))
                out.name = *name;
            else
                out = {"", Vec3(std::get<std::vector<double>>(v).data())};
        };
        f.load = [member](const void* o) -> FieldValue {
            const NameOrPoint& value = self(o).*member;
            if (!value.name.empty()) return value.name;
            return std::vector<double>{value.point.x(), value.point.y(), value.point.z()};
        };
        return *this;
    }
    /// A section: [key]
    template <class U>
    Table& table(std::string key, U T::*member, const Table<U>& sub) {
        FieldSpec& f = add(std::move(key), FieldKind::table, "", {}, sub.spec().doc);
        f.sub = std::make_shared<const TableSpec>(sub.spec());
        f.open = [member](void* o) -> void* { return &(self(o).*member); };
        return *this;
    }
    /// A section that may be absent: the member gets a value when the file has [key].
    template <class U>
    Table& table(std::string key, std::optional<U> T::*member, const Table<U>& sub) {
        FieldSpec& f = add(std::move(key), FieldKind::table, "", {}, sub.spec().doc);
        f.sub = std::make_shared<const TableSpec>(sub.spec());
        f.open = [member](void* o) -> void* { return &(self(o).*member).emplace(); };
        return *this;
    }
    /// The fields of `part` stand in this section itself and fill the member.
    template <class U>
    Table& include(U T::*member, const Table<U>& part) {
        const auto inner = [member](void* o) -> void* { return &(self(o).*member); };
        for (FieldSpec f : part.spec().fields) {
            if (f.store) f.store = [store = f.store, inner](void* o, const FieldValue& v) { store(inner(o), v); };
            if (f.load) f.load = [load = f.load, member](const void* o) { return load(&(self(o).*member)); };
            if (f.open) f.open = [open = f.open, inner](void* o) { return open(inner(o)); };
            if (f.clear) f.clear = [clear = f.clear, inner](void* o) { clear(inner(o)); };
            spec_.fields.push_back(std::move(f));
        }
        if (const auto store_place = part.spec().store_place)
            spec_.store_place = [store_place, inner](void* o, const SourcePlace& p) { store_place(inner(o), p); };
        return *this;
    }
    /// A list of sections: [[key]]
    template <class U>
    Table& tables(std::string key, std::vector<U> T::*member, const Table<U>& sub, Count count = {}) {
        FieldSpec& f = add(std::move(key), FieldKind::tables, "", {}, sub.spec().doc);
        f.count = count;
        f.sub = std::make_shared<const TableSpec>(sub.spec());
        f.open = [member](void* o) -> void* { return &(self(o).*member).emplace_back(); };
        f.clear = [member](void* o) { (self(o).*member).clear(); };
        return *this;
    }
    /// One number field a Parameter; values in the order of the list (give the object parameter_defaults(list) first).
    Table& parameters(std::span<const Parameter> list, std::vector<double> T::*member) {
        for (std::size_t i = 0; i < list.size(); ++i) {
            const Parameter& p = list[i];
            FieldSpec& f = add(std::string(p.key), FieldKind::number, std::string(p.unit), {p.minimum, p.maximum},
                               std::string(p.doc));
            f.store = [member, i](void* o, const FieldValue& v) { (self(o).*member).at(i) = std::get<double>(v); };
            f.load = [value = p.default_value](const void*) -> FieldValue { return value; };
        }
        return *this;
    }
    /// The member receives file and line of the section, for checks that look at several keys.
    Table& place(SourcePlace T::*member) {
        spec_.store_place = [member](void* o, const SourcePlace& where) { self(o).*member = where; };
        return *this;
    }
    /// The field named last must stand in the file.
    Table& required() {
        CATHLAB_CHECK(!spec_.fields.empty(), "required() before any field");
        spec_.fields.back().required = true;
        return *this;
    }
    /// Takes required() back, for a section that includes another's fields.
    Table& optional(const std::string& key) {
        for (FieldSpec& f : spec_.fields)
            if (f.key == key) f.required = false;
        return *this;
    }
    /// For what the members above do not cover.
    Table& field(FieldSpec spec) {
        spec_.fields.push_back(std::move(spec));
        return *this;
    }

private:
    static T& self(void* o) { return *static_cast<T*>(o); }
    static const T& self(const void* o) { return *static_cast<const T*>(o); }
    FieldSpec& add(std::string key, FieldKind kind, std::string unit, Range range, std::string doc) {
        FieldSpec& f = spec_.fields.emplace_back();
        f.key = std::move(key);
        f.kind = kind;
        f.unit = std::move(unit);
        f.range = range;
        f.doc = std::move(doc);
        return f;
    }
    template <class M>
    Table& plain(std::string key, FieldKind kind, M T::*member, std::string doc) {
        FieldSpec& f = add(std::move(key), kind, "", {}, std::move(doc));
        f.store = [member](void* o, const FieldValue& v) { self(o).*member = std::get<M>(v); };
        f.load = [member](const void* o) -> FieldValue { return self(o).*member; };
        return *this;
    }

    TableSpec spec_;
};

/// A T with its defaults, filled from the whole of a file.
template <class T>
T read_table(const TomlNode& node, const Table<T>& table, const PathResolver& resolve = resolve_beside_file) {
    T object{};
    read_table(node, table.spec(), &object, resolve);
    return object;
}

/// The default values in the order of the list.
std::vector<double> parameter_defaults(std::span<const Parameter> list);

}  // namespace cathlab
