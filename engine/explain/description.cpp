#include "explain/description.h"

#include <algorithm>
#include <cmath>

#include "core/errors.h"

namespace cathlab {

const TomlNode& described(const TomlNode& table, const std::string& key, TomlKind kind, const char* wanted) {
    const TomlNode* node = table.find(key);
    if (node == nullptr) throw UserError(table.place(key), std::string("is missing; ") + wanted + " is wanted");
    const bool whole_for_number = kind == TomlKind::number && node->kind == TomlKind::integer;
    if (node->kind != kind && !whole_for_number)
        throw UserError(node->place(key), "found " + node->describe() + "; " + wanted + " is wanted");
    return *node;
}

double described_number(const TomlNode& node, const std::string& key) {
    const bool fine = (node.kind == TomlKind::number || node.kind == TomlKind::integer) && std::isfinite(node.number);
    if (!fine) throw UserError(node.place(key), "found " + node.describe() + "; a finite number is wanted");
    return node.number;
}

void refuse_unknown(const TomlNode& table, const std::vector<std::string>& known) {
    for (const auto& [key, node] : table.members)
        if (std::find(known.begin(), known.end(), key) == known.end())
            throw UserError(node.place(key), "no such key" + did_you_mean(key, known) + " Known: " + comma_list(known));
}

double described_above_zero(const TomlNode& table, const std::string& key) {
    const TomlNode& node = described(table, key, TomlKind::number, "a number above 0");
    const double value = described_number(node, key);
    if (value <= 0.0) throw UserError(node.place(key), "found " + node.describe() + "; above 0 is wanted");
    return value;
}

double described_not_below_zero(const TomlNode& table, const std::string& key) {
    const TomlNode& node = described(table, key, TomlKind::number, "a number, 0 or more,");
    const double value = described_number(node, key);
    if (value < 0.0) throw UserError(node.place(key), "found " + node.describe() + "; 0 or more is wanted");
    return value;
}

Vec3 described_vector(const TomlNode& node, const std::string& key) {
    if (node.kind != TomlKind::array || node.items.size() != 3)
        throw UserError(node.place(key), "found " + node.describe() + "; three numbers are wanted");
    Vec3 v;
    for (int k = 0; k < 3; ++k) v[k] = described_number(node.items[static_cast<std::size_t>(k)], key);
    return v;
}

Vec3 described_direction(const TomlNode& node, const std::string& key) {
    const Vec3 v = described_vector(node, key);
    const double length = std::sqrt(v.squaredNorm());
    if (length <= 0.0) throw UserError(node.place(key), "length 0 has no direction");
    return v / length;
}

namespace {

HeldPlace held_place(const TomlNode& disc) {
    if (disc.kind != TomlKind::table)
        throw UserError(disc.place("fixed"), "found " + disc.describe() + "; sections [[setup.fixed]] are wanted");
    refuse_unknown(disc, {"name", "center_mm", "normal", "radius_mm", "half_thickness_mm"});
    HeldPlace out;
    if (disc.find("name") != nullptr) out.name = described(disc, "name", TomlKind::text, "a text").text;
    const char* vector = "three numbers";
    out.center_mm = described_vector(described(disc, "center_mm", TomlKind::array, vector), "center_mm");
    out.normal = described_direction(described(disc, "normal", TomlKind::array, vector), "normal");
    out.radius_mm = described_above_zero(disc, "radius_mm");
    out.half_thickness_mm = described_above_zero(disc, "half_thickness_mm");
    return out;
}

}  // namespace

CatheterTipSetup catheter_setup(const TomlNode& setup) {
    refuse_unknown(setup, {"proximal_length_mm", "middle_length_mm", "distal_length_mm", "tip_length_mm",
                           "base_position_mm", "base_axis", "bend_plane_axis", "down_axis"});
    CatheterTipSetup out;
    out.proximal_length_mm = described_above_zero(setup, "proximal_length_mm");
    out.middle_length_mm = described_not_below_zero(setup, "middle_length_mm");
    out.distal_length_mm = described_above_zero(setup, "distal_length_mm");
    out.tip_length_mm = described_not_below_zero(setup, "tip_length_mm");
    const auto vector = [&](const char* key) -> const TomlNode& {
        return described(setup, key, TomlKind::array, "three numbers");
    };
    out.base.position = described_vector(vector("base_position_mm"), "base_position_mm");
    const Vec3 z = described_direction(vector("base_axis"), "base_axis");
    const TomlNode& plane = vector("bend_plane_axis");
    Vec3 x = described_direction(plane, "bend_plane_axis");
    constexpr double square = 0.02;  // what rounding leaves of a right angle; more is a mistake
    if (std::fabs(x.dot(z)) > square) throw UserError(plane.place("bend_plane_axis"), "is not square to base_axis");
    x = (x - x.dot(z) * z).normalized();
    Mat3 frame;
    frame.col(0) = x;
    frame.col(1) = z.cross(x);
    frame.col(2) = z;
    out.base.orientation = Quat(frame).normalized();
    if (const TomlNode* down = setup.find("down_axis")) out.down = described_direction(*down, "down_axis");
    return out;
}

TendonTipSetup tendon_setup(const TomlNode& setup) {
    refuse_unknown(setup, {"tendon_radius_mm", "segment"});
    TendonTipSetup out;
    out.tendon_radius_mm = described_above_zero(setup, "tendon_radius_mm");
    const TomlNode& list = described(setup, "segment", TomlKind::array, "sections [[setup.segment]]");
    if (list.items.empty()) throw UserError(list.place("segment"), "is empty; a segment or more is wanted");
    std::vector<std::string> taken;
    for (const TomlNode& item : list.items) {
        if (item.kind != TomlKind::table)
            throw UserError(item.place("segment"), "found " + item.describe() + "; a section is wanted");
        refuse_unknown(item, {"name", "length_mm", "tendons"});
        TendonSegmentSetup segment;
        segment.name = described(item, "name", TomlKind::text, "a text").text;
        segment.length_mm = described_above_zero(item, "length_mm");
        const TomlNode& tendons = described(item, "tendons", TomlKind::array, "a list of columns");
        for (const TomlNode& tendon : tendons.items) {
            if (tendon.kind != TomlKind::text)
                throw UserError(tendon.place("tendons"), "found " + tendon.describe() + "; a column's name is wanted");
            if (std::find(taken.begin(), taken.end(), tendon.text) != taken.end())
                throw UserError(tendon.place("tendons"), "the column '" + tendon.text + "' is named twice");
            taken.push_back(tendon.text);
            segment.tendons.push_back(tendon.text);
        }
        if (segment.tendons.size() < 2)
            throw UserError(tendons.place("tendons"),
                            "names " + std::to_string(segment.tendons.size()) + " columns; two or more are wanted");
        out.segments.push_back(std::move(segment));
    }
    return out;
}

WallContactSetup contact_setup(const TomlNode& setup, const std::string& folder) {
    refuse_unknown(setup, {"mesh", "tube", "axis", "thickness_mm", "tool_radius_mm", "sensor_rest_mm", "material",
                           "density_kg_m3", "fixed"});
    WallContactSetup out;
    const TomlNode* tube = setup.find("tube");
    if (tube != nullptr && setup.find("mesh") != nullptr)
        throw UserError(tube->place("tube"), "found beside `mesh`; one of the two is wanted");
    if (tube != nullptr) {
        described(setup, "tube", TomlKind::table, "{ radius_mm, length_mm, thickness_mm }");
        refuse_unknown(*tube, {"radius_mm", "length_mm", "thickness_mm"});
        out.tube_radius_mm = described_above_zero(*tube, "radius_mm");
        out.tube_length_mm = described_above_zero(*tube, "length_mm");
    } else {
        const TomlNode& mesh =
            described(setup, "mesh", TomlKind::text, "`tube`, or the name of a mesh beside this file,");
        out.mesh = folder + "/" + mesh.text;
        out.mesh_place = mesh.place("setup.mesh");
    }
    const bool in_tube = tube != nullptr && tube->find("thickness_mm") != nullptr;
    out.thickness_mm = described_above_zero(in_tube ? *tube : setup, "thickness_mm");
    out.tool_radius_mm = described_above_zero(setup, "tool_radius_mm");
    for (const TomlNode& place : described(setup, "sensor_rest_mm", TomlKind::array, "a place for each run").items)
        out.sensor_rest_mm.push_back(described_vector(place, "sensor_rest_mm"));
    const TomlNode& material = described(setup, "material", TomlKind::table, "{ law, young_modulus_kpa, poisson }");
    refuse_unknown(material, {"law", "young_modulus_kpa", "poisson"});
    if (material.find("law") != nullptr) {
        const std::vector<std::string> laws{"neo-hooke", "linear"};
        const TomlNode& law = described(material, "law", TomlKind::text, "a text");
        if (std::find(laws.begin(), laws.end(), law.text) == laws.end())
            throw UserError(law.place("law"), "found " + law.describe() + "; known are " + comma_list(laws) +
                                                  did_you_mean(law.text, laws));
    }
    out.young_modulus_kpa = described_above_zero(material, "young_modulus_kpa");
    const TomlNode& poisson = described(material, "poisson", TomlKind::number, "a number from 0 to 0.4999");
    out.poisson = described_number(poisson, "poisson");
    if (out.poisson < 0.0 || out.poisson > 0.4999)
        throw UserError(poisson.place("poisson"), "found " + poisson.describe() + "; 0 to 0.4999 is wanted");
    if (const TomlNode* fixed = setup.find("fixed"))
        for (const TomlNode& disc : fixed->items) out.held.push_back(held_place(disc));
    return out;
}

}  // namespace cathlab
