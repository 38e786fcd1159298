#include "scene/device_file.h"

#include <algorithm>

#include "beam/materials.h"

namespace cathlab {
namespace {

Table<WireSection> make_section_table() {
    return Table<WireSection>("a stretch of wire, tip first; the last one runs to the end of the wire")
        .number("length_mm", &WireSection::length_mm, "mm", {0, 1e4}, "length; the last section's is not read")
        .number("diameter_mm", &WireSection::diameter_mm, "mm", {0.05, 10}, "outer diameter")
        .required()
        .number("bending_stiffness_n_mm2", &WireSection::bending_stiffness_n_mm2, "N mm2", {1e-3, 1e6}, "EI")
        .required()
        .number("torsion_stiffness_n_mm2", &WireSection::torsion_stiffness_n_mm2, "N mm2", {1e-3, 1e6}, "GJ")
        .required()
        .number("axial_stiffness_n", &WireSection::axial_stiffness_n, "N", {1, 1e7}, "EA")
        .required()
        .number("density_kg_m3", &WireSection::density_kg_m3, "kg/m3", {100, 25000}, "mean over the full circle")
        .required()
        .number("rest_curvature_per_mm", &WireSection::rest_curvature_per_mm, "1/mm", {-1, 1}, "of the unloaded wire")
        .number("link_length_mm", &WireSection::link_length_mm, "mm", {0, 50}, "longest link here; 0 = the wire's")
        .text("material", &WireSection::material, "a name of assets/materials: what the X-ray image sees")
        .required();
}

Table<WireFile> make_wire_table() {
    const auto wire =
        Table<WireSpec>("a guidewire")
            .text("name", &WireSpec::name, "its name")
            .required()
            .text("source", &WireSpec::source, "key in docs/references.md")
            .number("length_mm", &WireSpec::length_mm, "mm", {5, 1e4}, "total length")
            .required()
            .number("link_length_mm", &WireSpec::link_length_mm, "mm", {0.2, 50}, "longest rigid link")
            .required()
            .number("friction", &WireSpec::friction, "1", {0, 2}, "Coulomb coefficient against the wall")
            .number("max_push_n", &WireSpec::max_push_n, "N", {1e-3, 1e3}, "axial force at which the drive slips")
            .number("max_speed_mm_s", &WireSpec::max_speed, "mm/s", {1e-3, 1e3}, "of the drive")
            .number("damping_per_s", &WireSpec::damping_per_s, "1/s", {0, 1e5},
                    "rate at which motion against resting blood dies out")
            .number("spin_damping_per_s", &WireSpec::spin_damping_per_s, "1/s", {0, 1e5}, "the same for turning")
            .tables("sections", &WireSpec::sections, make_section_table(), {1, 1000});
    return Table<WireFile>("a guidewire of cathlab")
        .integer("schema", &WireFile::schema, "1", {1, 1}, "version of this format")
        .required()
        .choice("kind", &WireFile::kind, {"wire"}, "what the file holds")
        .required()
        .include(&WireFile::spec, wire);
}

Table<CatheterFile> make_catheter_table() {
    const auto segment =
        Table<CatheterSegment>("a length that bends as an arc of constant curvature, base first")
            .text("name", &CatheterSegment::name, "its name")
            .required()
            .number("length_mm", &CatheterSegment::length_mm, "mm", {0.1, 500}, "along the centre-line")
            .required()
            .number("max_bend_deg", &CatheterSegment::max_bend_deg, "deg", {0, 180}, "largest angle between its ends")
            .required()
            .number("max_rate_deg_s", &CatheterSegment::max_rate_deg_s, "deg/s", {0.1, 10000},
                    "fastest change of the bend")
            .required()
            .choice("driven_by", &CatheterSegment::driven_by, {"", "proximal", "distal", "none"},
                    "the operator's bend that it follows; empty = by its place: the first proximal, the last distal");
    const auto catheter =
        Table<CatheterSpec>("a steerable catheter")
            .text("name", &CatheterSpec::name, "its name")
            .required()
            .text("source", &CatheterSpec::source, "key in docs/references.md")
            .number("length_mm", &CatheterSpec::length_mm, "mm", {5, 1e4}, "usable length beyond the sheath's mouth")
            .number("outer_diameter_mm", &CatheterSpec::outer_diameter_mm, "mm", {0.1, 20}, "outer diameter")
            .number("inner_diameter_mm", &CatheterSpec::inner_diameter_mm, "mm", {0, 20},
                    "lumen for a guidewire; 0 = none")
            .number("link_length_mm", &CatheterSpec::link_length_mm, "mm", {0, 500},
                    "rigid, between neighbouring segments")
            .number("tip_length_mm", &CatheterSpec::tip_length_mm, "mm", {0, 500}, "straight, after the last segment")
            .number("tip_marker_length_mm", &CatheterSpec::tip_marker_length_mm, "mm", {0, 500},
                    "marker band, from the tip")
            .number("max_speed_mm_s", &CatheterSpec::max_speed_mm_s, "mm/s", {0.1, 1000}, "fastest insertion")
            .number("max_rotation_deg_s", &CatheterSpec::max_rotation_deg_s, "deg/s", {0.1, 10000}, "fastest turning")
            .number("friction", &CatheterSpec::friction, "1", {0, 2}, "Coulomb coefficient against the wall")
            .number("wire_friction", &CatheterSpec::wire_friction, "1", {0, 2},
                    "Coulomb coefficient against a guidewire that lies beside it")
            .number("bending_stiffness_n_mm2", &CatheterSpec::bending_stiffness_n_mm2, "N mm2", {0.1, 1e6},
                    "EI of the steerable part; a stiffer guidewire inside leads it along the vessel")
            .number("force_limit_n", &CatheterSpec::force_limit_n, "N", {0.001, 100},
                    "sum of contact forces beyond which the catheter gives way")
            .number("tip_force_limit_n", &CatheterSpec::tip_force_limit_n, "N", {0.001, 100},
                    "the same for its last 10 mm")
            .number("penetration_limit_mm", &CatheterSpec::penetration_limit_mm, "mm", {0.001, 10},
                    "a command that would press deeper is refused in part")
            .text("material", &CatheterSpec::material, "a name of assets/materials")
            .text("tip_material", &CatheterSpec::tip_material, "of the marker band")
            .tables("segments", &CatheterSpec::segments, segment, {0, 16});
    return Table<CatheterFile>("a steerable catheter of cathlab")
        .integer("schema", &CatheterFile::schema, "1", {1, 1}, "version of this format")
        .required()
        .choice("kind", &CatheterFile::kind, {"catheter"}, "what the file holds")
        .required()
        .include(&CatheterFile::spec, catheter);
}

Table<SleeveFile> make_sleeve_table() {
    const auto sleeve =
        Table<SleeveSpec>("a passive catheter")
            .text("name", &SleeveSpec::name, "its name")
            .required()
            .text("source", &SleeveSpec::source, "key in docs/references.md")
            .number("length_mm", &SleeveSpec::length_mm, "mm", {5, 1e4}, "total length")
            .required()
            .number("link_length_mm", &SleeveSpec::link_length_mm, "mm", {0.2, 50}, "longest rigid link")
            .required()
            .number("inner_diameter_mm", &SleeveSpec::inner_diameter_mm, "mm", {0.05, 10}, "bore for a guidewire")
            .required()
            .number("friction", &SleeveSpec::friction, "1", {0, 2}, "Coulomb coefficient against the wall")
            .number("wire_friction", &SleeveSpec::wire_friction, "1", {0, 2},
                    "the same between it and the guidewire inside")
            .number("max_push_n", &SleeveSpec::max_push_n, "N", {1e-3, 1e3}, "axial force at which the drive slips")
            .number("max_speed_mm_s", &SleeveSpec::max_speed, "mm/s", {1e-3, 1e3}, "of the drive")
            .tables("sections", &SleeveSpec::sections, make_section_table(), {1, 1000});
    return Table<SleeveFile>("a passive catheter of cathlab, over a guidewire")
        .integer("schema", &SleeveFile::schema, "1", {1, 1}, "version of this format")
        .required()
        .choice("kind", &SleeveFile::kind, {"passive_catheter"}, "what the file holds")
        .required()
        .include(&SleeveFile::spec, sleeve);
}

std::string kind_of(const TomlNode& file, const std::string& path) {
    const TomlNode* kind = file.find("kind");
    const std::vector<std::string> known{"wire", "catheter", "passive_catheter"};
    if (kind == nullptr) throw UserError({path, 0, "kind"}, "is missing; one of " + comma_list(known) + " is wanted");
    if (std::find(known.begin(), known.end(), kind->text) == known.end())
        throw UserError(kind->place("kind"), "found " + kind->describe() + "; one of " + comma_list(known) +
                                                 " is wanted" + did_you_mean(kind->text, known));
    return kind->text;
}

TomlNode load_kind(const std::string& path, const std::string& wanted) {
    TomlNode file = load_toml(path);
    const std::string kind = kind_of(file, path);
    if (kind != wanted)
        throw UserError(file.find("kind")->place("kind"),
                        "the device is a " + kind + "; a " + wanted + " is wanted here");
    return file;
}

// What the X-ray image cannot draw must not be found out in the middle of a run.
void check_material(const std::string& path, const std::string& name) {
    std::vector<std::string> known;
    for (const Material& material : material_table()) known.emplace_back(material.name);
    if (std::find(known.begin(), known.end(), name) == known.end())
        throw UserError({path, 0, "material"},
                        "no material '" + name + "'" + did_you_mean(name, known) + " There is: " + comma_list(known));
}

template <class Spec>
void check_sections(const std::string& path, const Spec& spec) {
    try {
        validate(spec);
    } catch (const UserError& error) {
        throw UserError({path, 0, ""}, error.what());
    }
    for (const WireSection& section : spec.sections) check_material(path, section.material);
}

}  // namespace

const Table<WireFile>& wire_table() {
    static const Table<WireFile> table = make_wire_table();
    return table;
}

const Table<CatheterFile>& catheter_table() {
    static const Table<CatheterFile> table = make_catheter_table();
    return table;
}

const Table<SleeveFile>& sleeve_table() {
    static const Table<SleeveFile> table = make_sleeve_table();
    return table;
}

std::string device_kind(const std::string& path) {
    return kind_of(load_toml(path), path);
}

WireSpec load_wire(const std::string& path) {
    WireSpec spec = read_table(load_kind(path, "wire"), wire_table()).spec;
    check_sections(path, spec);
    return spec;
}

SleeveSpec load_sleeve(const std::string& path) {
    SleeveSpec spec = read_table(load_kind(path, "passive_catheter"), sleeve_table()).spec;
    check_sections(path, spec);
    return spec;
}

CatheterSpec load_catheter(const std::string& path) {
    CatheterSpec spec = read_table(load_kind(path, "catheter"), catheter_table()).spec;
    validate(spec, {path, 0, ""});
    check_material(path, spec.material);
    check_material(path, spec.tip_material);
    return spec;
}

}  // namespace cathlab
