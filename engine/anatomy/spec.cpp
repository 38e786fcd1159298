#include "anatomy/spec.h"

#include <cmath>
#include <set>

#include "core/hash.h"

namespace cathlab {
namespace {

std::string number(double v) {
    std::string s = std::to_string(v);
    while (s.size() > 1 && s.back() == '0') s.pop_back();
    if (s.back() == '.') s.pop_back();
    return s;
}

SourcePlace keyed(SourcePlace where, const std::string& key) {
    if (where.key.empty()) where.key = key;
    return where;
}

void in_range(const SourcePlace& where, const std::string& what, double v, double low, double high) {
    if (!std::isfinite(v) || v < low || v > high)
        throw UserError(where, what + " is " + number(v) + "; allowed is " + number(low) + " to " + number(high));
}

void finite(const SourcePlace& where, const std::string& what, const Vec3& v) {
    for (int k = 0; k < 3; ++k) {
        if (!std::isfinite(v[k]) || std::fabs(v[k]) > 1e5)
            throw UserError(where, what + " has a coordinate that is not a finite number of mm below 100000");
    }
}

class Names {
public:
    explicit Names(std::string kind) : kind_(std::move(kind)) {}
    void add(const SourcePlace& where, const std::string& name) {
        if (name.empty()) throw UserError(where, "a " + kind_ + " has no name");
        if (!set_.insert(name).second) throw UserError(where, "two " + kind_ + " entries are named '" + name + "'");
        list_.push_back(name);
    }
    void want(const SourcePlace& where, const std::string& name) const {
        if (set_.count(name) == 0)
            throw UserError(where, "unknown " + kind_ + " '" + name + "'" + did_you_mean(name, list_) +
                                       " (known: " + comma_list(list_) + ")");
    }
    bool has(const std::string& name) const { return set_.count(name) != 0; }

private:
    std::string kind_;
    std::set<std::string> set_;
    std::vector<std::string> list_;
};

void validate_vessel(const VesselSpec& v, const Names& regions, const Names& earlier, bool first) {
    const SourcePlace where = keyed(v.where, "vessel." + v.name);
    if (first != v.parent.empty())
        throw UserError(where, first ? "the first vessel '" + v.name + "' is the root and may not have a parent"
                                     : "vessel '" + v.name + "' needs a parent: only the first vessel is a root");
    if (!first) earlier.want(where, v.parent);  // parents stand before their children, so there can be no circle
    regions.want(where, v.region);
    if (v.points.size() < 2)
        throw UserError(
            where, "vessel '" + v.name + "' has " + std::to_string(v.points.size()) + " points; at least 2 are needed");
    for (std::size_t i = 0; i < v.points.size(); ++i) {
        const std::string what = "point " + std::to_string(i + 1) + " of vessel '" + v.name + "'";
        const Vec3 here(v.points[i].data());
        finite(where, what, here);
        in_range(where, "the radius of " + what, v.points[i][3], 0.2, 60.0);
        if (i > 0 && (here - Vec3(v.points[i - 1].data())).norm() < 0.5)
            throw UserError(where, what + " stands less than 0.5 mm from the one before it: a vessel needs a length");
    }
    in_range(where, "blend", v.blend, 0.0, 2.0);
    in_range(where, "fixed_length_mm", v.fixed_length_mm, 0.5, 200.0);
}

}  // namespace

void validate(const AnatomySpec& spec) {
    Names regions("region");
    for (const RegionSpec& r : spec.regions) {
        const SourcePlace where = keyed(r.where, "region." + r.name);
        regions.add(where, r.name);
        in_range(where, "wall_thickness_mm", r.wall_thickness_mm, 0.1, 5.0);
        in_range(where, "force_limit_n", r.force_limit_n, 0.01, 100.0);
        in_range(where, "particle_spacing_mm", r.spacing_mm(spec.particle_spacing_mm), 0.2, 10.0);
    }
    if (spec.vessels.empty()) throw UserError("the anatomy '" + spec.name + "' has no vessel");
    Names vessels("vessel");
    for (const VesselSpec& v : spec.vessels) {
        validate_vessel(v, regions, vessels, &v == &spec.vessels.front());
        vessels.add(v.where, v.name);
    }
    for (const StenosisSpec& s : spec.stenoses) {
        const SourcePlace where = keyed(s.where, "stenosis");
        vessels.want(where, s.vessel);
        in_range(where, "place_mm", s.place_mm, 0.0, 2000.0);
        in_range(where, "length_mm", s.length_mm, 1.0, 100.0);
        in_range(where, "degree", s.degree, 0.0, 0.9);
    }
    if (spec.annulus) {
        const SourcePlace where = keyed(spec.annulus->where, "annulus");
        vessels.want(where, spec.annulus->vessel);
        in_range(where, "radius_mm", spec.annulus->radius_mm, 1.0, 40.0);
        for (const SinusSpec& s : spec.annulus->sinuses) {
            in_range(where, "angle_deg", s.angle_deg, -360.0, 360.0);
            in_range(where, "height_mm", s.height_mm, 0.0, 100.0);
            in_range(where, "offset_mm", s.offset_mm, 0.0, 60.0);
            in_range(where, "radius_mm of sinus '" + s.name + "'", s.radius_mm, 0.5, 40.0);
        }
    }
    Names entries("entry");
    for (const EntrySpec& e : spec.entries) {
        const SourcePlace where = keyed(e.where, "entry." + e.name);
        entries.add(where, e.name);
        vessels.want(where, e.vessel);
        in_range(where, "inset_mm", e.inset_mm, 1.0, 100.0);
    }
    Names landmarks("landmark");
    const std::vector<std::string> places = {"ostium", "start", "end", "top", "place"};
    for (const LandmarkSpec& l : spec.landmarks) {
        const SourcePlace where = keyed(l.where, "landmark." + l.name);
        landmarks.add(where, l.name);
        vessels.want(where, l.vessel);
        in_range(where, "place_mm", l.place_mm, 0.0, 2000.0);
        bool known = false;
        for (const std::string& p : places) known = known || p == l.at;
        if (!known)
            throw UserError(where, "at = '" + l.at + "' is none of " + comma_list(places) + did_you_mean(l.at, places));
    }
    const MeshingSpec& m = spec.meshing;
    const SourcePlace where = keyed(m.where, "meshing");
    in_range(where, "voxel_mm", m.voxel_mm, 0.1, 3.0);
    in_range(where, "face_count", m.face_count, 100, 2e6);
    in_range(where, "smoothing_steps", m.smoothing_steps, 0, 100);
    in_range(where, "smoothing_lambda", m.smoothing_lambda, 0.0, 1.0);
    in_range(where, "smoothing_mu", m.smoothing_mu, -1.0, 0.0);
    in_range(where, "edges_round", m.edges_round, 6.0, 64.0);
    in_range(where, "coarse_edge_mm", m.coarse_edge_mm, 1.0, 20.0);
    in_range(where, "fine_edge_mm", m.fine_edge_mm, 0.2, 5.0);
}

void validate(const ImportedAnatomySpec& spec) {
    const SourcePlace where = keyed(spec.where, "anatomy");
    const std::vector<std::string> units = {"mm", "cm", "m"};
    bool known = false;
    for (const std::string& u : units) known = known || u == spec.unit;
    if (!known) throw UserError(where, "unit = '" + spec.unit + "' is none of mm, cm, m");
    if (spec.mesh.empty()) throw UserError(where, "no mesh file is named");
    Names entries("entry");
    for (const ImportedEntry& e : spec.entries) {
        entries.add(keyed(e.where, "entry." + e.name), e.name);
        finite(keyed(e.where, "entry." + e.name), "near", e.near);
        in_range(keyed(e.where, "entry." + e.name), "inset_mm", e.inset_mm, 0.0, 100.0);
    }
    Names landmarks("landmark");
    for (const ImportedEntry& l : spec.landmarks) {
        landmarks.add(keyed(l.where, "landmark." + l.name), l.name);
        finite(keyed(l.where, "landmark." + l.name), "near", l.near);
    }
    for (const ImportedFixed& f : spec.fixed) {
        finite(keyed(f.where, "fixed." + f.name), "center", f.center);
        in_range(keyed(f.where, "fixed." + f.name), "radius_mm", f.radius_mm, 0.1, 1000.0);
    }
    if (spec.annulus) {
        finite(where, "annulus center", spec.annulus->center);
        finite(where, "annulus axis", spec.annulus->axis);
        if (spec.annulus->axis.norm() < 1e-6) throw UserError(where, "the annulus' axis has no length");
        in_range(where, "annulus radius_mm", spec.annulus->radius_mm, 1.0, 40.0);
    }
    in_range(where, "wall_thickness_mm", spec.wall_thickness_mm, 0.1, 5.0);
    in_range(where, "force_limit_n", spec.force_limit_n, 0.01, 100.0);
    in_range(where, "particle_spacing_mm", spec.particle_spacing_mm, 0.2, 10.0);
    in_range(where, "edges_round", spec.edges_round, 6.0, 64.0);
    in_range(where, "face_count", spec.face_count, 0, 2e6);
}

namespace {

struct Hasher {
    Hash64 hash;
    void operator()(double v) { hash.bytes(&v, sizeof v); }
    void operator()(const std::string& s) { hash.text(s); }
    void operator()(const Vec3& v) {
        for (int k = 0; k < 3; ++k) (*this)(v[k]);
    }
    void size(std::size_t n) { hash.word(n); }
};

}  // namespace

std::uint64_t content_hash(const AnatomySpec& spec) {
    Hasher h;
    h(spec.name);
    h.size(spec.regions.size());
    for (const RegionSpec& r : spec.regions) {
        h(r.name), h(r.wall_thickness_mm), h(r.force_limit_n), h(r.spacing_mm(spec.particle_spacing_mm));
    }
    h.size(spec.vessels.size());
    for (const VesselSpec& v : spec.vessels) {
        h(v.name), h(v.parent), h(v.region), h(v.continues ? 1.0 : 0.0), h(v.blend);
        h(v.fixed_end ? 1.0 : 0.0), h(v.fixed_length_mm);
        h.size(v.points.size());
        for (const auto& p : v.points) h(Vec3(p.data())), h(p[3]);
    }
    h.size(spec.stenoses.size());
    for (const StenosisSpec& s : spec.stenoses) h(s.vessel), h(s.place_mm), h(s.length_mm), h(s.degree);
    h.size(spec.annulus ? 1 : 0);
    if (spec.annulus) {
        h(spec.annulus->vessel), h(spec.annulus->radius_mm);
        h.size(spec.annulus->sinuses.size());
        for (const SinusSpec& s : spec.annulus->sinuses)
            h(s.name), h(s.angle_deg), h(s.height_mm), h(s.offset_mm), h(s.radius_mm);
    }
    h.size(spec.entries.size());
    for (const EntrySpec& e : spec.entries) h(e.name), h(e.vessel), h(e.inset_mm);
    h.size(spec.landmarks.size());
    for (const LandmarkSpec& l : spec.landmarks) h(l.name), h(l.vessel), h(l.at), h(l.place_mm);
    const MeshingSpec& m = spec.meshing;
    h(m.voxel_mm), h(m.face_count), h(m.smoothing_steps), h(m.smoothing_lambda), h(m.smoothing_mu), h(m.edges_round);
    h(m.fine_edge_mm), h(m.coarse_edge_mm), h(spec.torso ? 1.0 : 0.0);
    return h.hash.value();
}

std::uint64_t content_hash(const ImportedAnatomySpec& spec) {
    Hasher h;
    h(spec.name), h(spec.unit);
    h.hash.word(hash_file(spec.mesh));
    h.size(spec.entries.size());
    for (const ImportedEntry& e : spec.entries) h(e.name), h(e.near), h(e.inset_mm);
    h.size(spec.landmarks.size());
    for (const ImportedEntry& l : spec.landmarks) h(l.name), h(l.near), h(l.inset_mm);
    h.size(spec.fixed.size());
    for (const ImportedFixed& f : spec.fixed) h(f.name), h(f.center), h(f.radius_mm);
    h.size(spec.annulus ? 1 : 0);
    if (spec.annulus) h(spec.annulus->center), h(spec.annulus->axis), h(spec.annulus->radius_mm);
    h(spec.wall_thickness_mm), h(spec.force_limit_n), h(spec.particle_spacing_mm), h(spec.edges_round);
    h(spec.face_count);
    return h.hash.value();
}

}  // namespace cathlab
