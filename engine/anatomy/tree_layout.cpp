#include "anatomy/tree_layout.h"

#include <algorithm>
#include <cmath>

#include "core/deterministic_math.h"

namespace cathlab {
namespace {

constexpr double pi = 3.14159265358979323846;

Index index_of(const AnatomySpec& spec, const std::string& vessel) {
    for (std::size_t v = 0; v < spec.vessels.size(); ++v) {
        if (spec.vessels[v].name == vessel) return static_cast<Index>(v);
    }
    return -1;
}

std::string mm(double v) {
    const std::string s = std::to_string(v);
    return s.substr(0, s.find('.') + 3) + " mm";
}

std::vector<ImplicitTree::Vessel> make_curves(const AnatomySpec& spec, TreeLayout& out) {
    std::vector<ImplicitTree::Vessel> vessels;
    for (std::size_t v = 0; v < spec.vessels.size(); ++v) {
        const VesselSpec& s = spec.vessels[v];
        std::vector<ControlPoint> points;
        for (const auto& p : s.points) points.push_back({Vec3(p.data()), p[3]});
        const Index parent = s.parent.empty() ? -1 : index_of(spec, s.parent);
        double attach = 0.0;
        Vec3 before = Vec3::Zero();
        if (parent >= 0) {
            const Curve& trunk = vessels[static_cast<std::size_t>(parent)].curve;
            attach = s.continues ? trunk.length() : trunk.nearest_arc(points[0].position);
            points[0].position = trunk.point(attach);
            before = points[0].position - (points[1].position - points[0].position).norm() * trunk.tangent(attach);
            if ((points[1].position - points[0].position).norm() < 0.5)
                throw UserError(s.where, "vessel '" + s.name + "' has no length between its start on '" + s.parent +
                                             "' and its second point");
        }
        double least = points[0].radius;
        for (const ControlPoint& p : points) least = std::min(least, p.radius);
        ImplicitTree::Vessel vessel;
        vessel.curve = sample_curve(points, std::clamp(0.3 * least, 0.3, 1.0), s.continues ? &before : nullptr);
        for (const StenosisSpec& stenosis : spec.stenoses) {
            if (stenosis.vessel != s.name) continue;
            if (stenosis.place_mm > vessel.curve.length())
                throw UserError(stenosis.where, "the stenosis at " + mm(stenosis.place_mm) +
                                                    " lies beyond the end of '" + s.name + "', which is " +
                                                    mm(vessel.curve.length()) + " long");
            narrow(vessel.curve, stenosis);
        }
        least = *std::min_element(vessel.curve.radius.begin(), vessel.curve.radius.end());
        if (least < 0.9 * spec.meshing.voxel_mm)
            throw UserError(s.where, "the lumen of '" + s.name + "' narrows to a radius of " + mm(least) +
                                         ", which a voxel of " + mm(spec.meshing.voxel_mm) +
                                         " cannot resolve; voxel_mm = " + mm(least / 0.9) + " would do");
        vessel.cap_start = parent < 0;
        vessel.cap_end = true;
        if (parent >= 0) {
            ImplicitTree::Vessel& p = vessels[static_cast<std::size_t>(parent)];
            if (attach > p.curve.length() - 0.5 * p.curve.radius.back()) p.cap_end = false;
        }
        out.parent.push_back(parent);
        out.attach_arc.push_back(attach);
        out.least_radius.push_back(least);
        for (std::size_t r = 0; r < spec.regions.size(); ++r) {
            if (spec.regions[r].name == s.region) out.region.push_back(static_cast<Index>(r));
        }
        vessels.push_back(std::move(vessel));
    }
    return vessels;
}

std::vector<ImplicitTree::Branch> make_branches(const AnatomySpec& spec, const TreeLayout& layout,
                                                const std::vector<ImplicitTree::Vessel>& vessels) {
    std::vector<ImplicitTree::Branch> branches;
    std::vector<double> arcs;
    for (std::size_t v = 0; v < vessels.size(); ++v) {
        const Index parent = layout.parent[v];
        if (parent < 0 || spec.vessels[v].continues) continue;
        const auto p = static_cast<std::size_t>(parent);
        const double arc = layout.attach_arc[v];
        const double r_parent = vessels[p].curve.radius_at(arc);
        const double r_child = vessels[v].curve.radius.front();
        const double blend = spec.vessels[v].blend * std::min(r_child, r_parent);
        std::size_t b = 0;
        while (b < branches.size() && !(branches[b].trunk.front() == parent && std::fabs(arcs[b] - arc) < 1.0)) ++b;
        if (b == branches.size()) {
            ImplicitTree::Branch fresh;
            fresh.trunk.push_back(parent);
            if (spec.vessels[p].continues) fresh.trunk.push_back(layout.parent[p]);
            for (std::size_t c = 0; c < vessels.size(); ++c) {
                if (layout.parent[c] == parent && spec.vessels[c].continues)
                    fresh.trunk.push_back(static_cast<Index>(c));
            }
            fresh.center = vessels[p].curve.point(arc);
            fresh.blend_mm = blend;
            branches.push_back(fresh);
            arcs.push_back(arc);
        }
        branches[b].children.push_back(static_cast<Index>(v));
        branches[b].blend_mm = std::min(branches[b].blend_mm, blend);
        branches[b].inner = std::max(branches[b].inner, r_parent + 2.0 * r_child);
        branches[b].outer = std::max(branches[b].outer, r_parent + 4.5 * r_child);
    }
    return branches;
}

/// Do two vessels belong to one branch: parent and child, siblings, or a child and what continues its parent?
bool related(const AnatomySpec& spec, const TreeLayout& layout, std::size_t u, std::size_t v) {
    const auto trunk_of = [&](std::size_t child, std::size_t w) {
        const Index p = layout.parent[child];
        if (p < 0) return false;
        return (layout.parent[w] == p && spec.vessels[w].continues) ||
               (spec.vessels[static_cast<std::size_t>(p)].continues &&
                layout.parent[static_cast<std::size_t>(p)] == static_cast<Index>(w));
    };
    if (trunk_of(u, v) || trunk_of(v, u)) return true;
    const auto is_parent = [&](std::size_t a, std::size_t b) { return layout.parent[b] == static_cast<Index>(a); };
    const bool siblings = layout.parent[u] == layout.parent[v] && layout.parent[u] >= 0 &&
                          std::fabs(layout.attach_arc[u] - layout.attach_arc[v]) < 1.0;
    return is_parent(u, v) || is_parent(v, u) || siblings;
}

/// Vessels that are not joined must stay apart, or the surface would gain a handle.
void check_clearance(const AnatomySpec& spec, const TreeLayout& layout) {
    const auto& vessels = layout.tree->vessels();
    const double clearance = 2.0 * spec.meshing.voxel_mm;
    for (std::size_t u = 0; u < vessels.size(); ++u) {
        for (std::size_t v = 0; v < vessels.size(); ++v) {
            if (u == v || related(spec, layout, u, v)) continue;
            const Curve& c = vessels[v].curve;
            double skip = -1.0;
            for (std::size_t i = 0; i < c.position.size(); ++i) {
                if (c.arc[i] < skip) continue;
                const double gap = layout.tree->vessel_distance(c.position[i], static_cast<Index>(u)) - c.radius[i];
                skip = c.arc[i] + 0.5 * (gap - clearance);
                if (gap >= clearance) continue;
                // what still lies within a vessel to which both belong is no touching
                bool inside_common = false;
                for (std::size_t w = 0; w < vessels.size() && !inside_common; ++w) {
                    const bool joins = (w == v || related(spec, layout, v, w)) && related(spec, layout, w, u) && w != u;
                    inside_common =
                        joins && w != v &&
                        layout.tree->vessel_distance(c.position[i], static_cast<Index>(w)) < 0.5 * c.radius[i];
                }
                if (inside_common) continue;
                throw UserError(spec.vessels[v].where, "vessels '" + spec.vessels[v].name + "' and '" +
                                                           spec.vessels[u].name + "' come within " + mm(gap) + " at " +
                                                           mm(c.arc[i]) + " along the first; they need " +
                                                           mm(clearance));
            }
        }
    }
}

}  // namespace

TreeLayout lay_out(const AnatomySpec& spec) {
    TreeLayout out;
    std::vector<ImplicitTree::Vessel> vessels = make_curves(spec, out);
    std::vector<ImplicitTree::Bulge> bulges;
    if (spec.annulus) {
        const Index v = index_of(spec, spec.annulus->vessel);
        const Curve& c = vessels[static_cast<std::size_t>(v)].curve;
        const Vec3 axis = c.tangent(0.0);
        const Vec3 anterior = (Vec3(0.0, -1.0, 0.0) - axis * axis.dot(Vec3(0.0, -1.0, 0.0))).normalized();
        const Vec3 left = anterior.cross(axis).dot(Vec3::UnitX()) > 0.0 ? anterior.cross(axis) : axis.cross(anterior);
        for (const SinusSpec& s : spec.annulus->sinuses) {
            const double angle = s.angle_deg * pi / 180.0;
            bulges.push_back({v,
                              c.position.front() + s.height_mm * axis +
                                  s.offset_mm * (det::cos(angle) * anterior + det::sin(angle) * left),
                              s.radius_mm, 0.35 * s.radius_mm});
        }
    }
    std::vector<ImplicitTree::Branch> branches = make_branches(spec, out, vessels);
    out.tree = std::make_unique<ImplicitTree>(std::move(vessels), std::move(branches), std::move(bulges),
                                              std::max(5.0, 10.0 * spec.meshing.voxel_mm));
    check_clearance(spec, out);
    return out;
}

Index GraphPlaces::nearest(Index on_vessel, double at_arc) const {
    Index best = 0;
    double distance = 1e300;
    for (std::size_t i = 0; i < vessel.size(); ++i) {
        if (vessel[i] == on_vessel && std::fabs(arc[i] - at_arc) < distance) {
            distance = std::fabs(arc[i] - at_arc);
            best = static_cast<Index>(i);
        }
    }
    return best;
}

GraphPlaces make_graph(const TreeLayout& layout) {
    GraphPlaces out;
    const auto& vessels = layout.tree->vessels();
    for (std::size_t v = 0; v < vessels.size(); ++v) {
        const Curve& c = vessels[v].curve;
        const double spacing = layout.least_radius[v] < 2.4 ? 1.0 : 2.5;
        const int pieces = std::max(1, static_cast<int>(std::lround(c.length() / spacing)));
        Index previous = layout.parent[v] < 0 ? -1 : out.nearest(layout.parent[v], layout.attach_arc[v]);
        for (int i = layout.parent[v] < 0 ? 0 : 1; i <= pieces; ++i) {
            const double arc = c.length() * i / pieces;
            CentrelineNode node;
            node.position = c.point(arc);
            // inside its parent's lumen a branch has the parent's room, not its own
            node.radius = std::max(c.radius_at(arc), -layout.tree->sample(node.position).value);
            if (i == 0 || i == pieces) node.radius = c.radius_at(arc);
            node.region = layout.region[v];
            const auto here = static_cast<Index>(out.graph.nodes.size());
            out.graph.nodes.push_back(node);
            out.vessel.push_back(static_cast<Index>(v));
            out.arc.push_back(arc);
            if (previous >= 0) out.graph.edges.emplace_back(previous, here);
            previous = here;
        }
    }
    return out;
}

void place_names(const AnatomySpec& spec, const TreeLayout& layout, const GraphPlaces& places, AnatomyModel& model) {
    const auto& vessels = layout.tree->vessels();
    for (std::size_t r = 0; r < spec.regions.size(); ++r) {
        const RegionSpec& s = spec.regions[r];
        Region region{s.name, s.wall_thickness_mm, s.force_limit_n, s.spacing_mm(spec.particle_spacing_mm)};
        for (std::size_t v = 0; v < vessels.size();
             ++v) {  // eight particles round: spacing <= 2 pi r / 8, some to spare
            if (layout.region[v] == static_cast<Index>(r))
                region.particle_spacing_mm = std::min(region.particle_spacing_mm, 0.72 * layout.least_radius[v]);
        }
        model.regions.push_back(region);
    }
    auto pose_at = [&](Index v, double arc, bool backwards) {
        const Curve& c = vessels[static_cast<std::size_t>(v)].curve;
        const Vec3 t = c.tangent(arc);
        return Pose{c.point(arc), det::rotation_between(Vec3::UnitZ(), backwards ? Vec3(-t) : t)};
    };
    auto node_at = [&](Index v, double arc) { return places.nearest(v, arc); };
    for (const EntrySpec& e : spec.entries) {
        const Index v = index_of(spec, e.vessel);
        const Curve& c = vessels[static_cast<std::size_t>(v)].curve;
        if (!vessels[static_cast<std::size_t>(v)].cap_end)
            throw UserError(e.where, "entry '" + e.name + "' needs a free end, but '" + e.vessel + "' goes on");
        if (e.inset_mm >= c.length())
            throw UserError(e.where,
                            "inset_mm of entry '" + e.name + "' is longer than '" + e.vessel + "', " + mm(c.length()));
        const double arc = c.length() - e.inset_mm;
        model.entries.push_back({e.name, pose_at(v, arc, true), c.radius_at(arc), node_at(v, arc)});
    }
    for (std::size_t v = 0; v < vessels.size(); ++v) {
        if (!spec.vessels[v].fixed_end) continue;
        const Curve& c = vessels[v].curve;
        const double thick = std::min(spec.vessels[v].fixed_length_mm, c.length());
        const double arc = c.length() - 0.5 * thick;
        // 1 mm beyond the cap, and wide enough for a bend within the zone
        model.fixed.push_back({spec.vessels[v].name + "_end", c.point(arc) + 0.5 * c.tangent(arc), c.tangent(arc),
                               1.4 * c.radius_at(arc) + 0.25 * thick, 0.5 * thick + 0.5});
    }
    for (const LandmarkSpec& l : spec.landmarks) {
        const Index v = index_of(spec, l.vessel);
        const Curve& c = vessels[static_cast<std::size_t>(v)].curve;
        double arc = l.place_mm;
        if (l.at == "start") arc = 0.0;
        if (l.at == "end") arc = c.length();
        if (l.at == "top")
            arc = c.arc[static_cast<std::size_t>(
                std::max_element(c.position.begin(), c.position.end(),
                                 [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); }) -
                c.position.begin())];
        if (l.at == "ostium") {
            const Index parent = layout.parent[static_cast<std::size_t>(v)];
            if (parent < 0) throw UserError(l.where, "'" + l.vessel + "' is the root and has no ostium");
            arc = 0.0;
            while (arc < c.length() && layout.tree->vessel_distance(c.point(arc), parent) < 0.0) arc += 0.1;
        }
        if (arc > c.length())
            throw UserError(l.where, "landmark '" + l.name + "' lies beyond the end of '" + l.vessel + "', which is " +
                                         mm(c.length()) + " long");
        model.landmarks.push_back({l.name, pose_at(v, arc, false), c.radius_at(arc), node_at(v, arc)});
    }
    if (spec.annulus)
        model.annulus = Annulus{pose_at(index_of(spec, spec.annulus->vessel), 0.0, false), spec.annulus->radius_mm};
}

}  // namespace cathlab
