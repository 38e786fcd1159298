#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "anatomy/build.h"
#include "anatomy/implicit_tree.h"
#include "anatomy/mesh_file.h"
#include "anatomy/remesh.h"
#include "anatomy/skeleton.h"
#include "anatomy/voxel_surface.h"
#include "core/deterministic_math.h"
#include "core/hash.h"

namespace cathlab {
namespace {

constexpr double equilateral = 0.4330127018922193;  // area of a triangle of edge 1
constexpr double fixed_half_length = 5.0;
constexpr int smoothing_steps = 10;     // of the distance grid's surface [li2025]
constexpr double longest_piece = 25.0;  // mm of vessel in one region

/// The skeleton's chains as vessels (for radii and sizes near the wall) and as a graph.
struct ImportedTree {
    std::unique_ptr<ImplicitTree> tree;
    CentrelineGraph graph;
    std::vector<Index> free_ends;  ///< nodes
};

Pose looking_along(const Vec3& position, const Vec3& direction) {
    return {position, det::rotation_between(Vec3::UnitZ(), direction.normalized())};
}

/// Unit vector from a node towards the node `steps` further along its only way.
Vec3 inward(const CentrelineGraph& graph, const std::vector<std::vector<Index>>& adjacency, Index node) {
    Index previous = node;
    Index at = adjacency[static_cast<std::size_t>(node)].front();
    for (int k = 0; k < 2; ++k) {
        const auto& next = adjacency[static_cast<std::size_t>(at)];
        if (next.size() != 2) break;
        const Index further = next[0] == previous ? next[1] : next[0];
        previous = at;
        at = further;
    }
    return (graph.nodes[static_cast<std::size_t>(at)].position - graph.nodes[static_cast<std::size_t>(node)].position)
        .normalized();
}

/// Long chains in equal pieces, so that a narrow stretch alone gets the fine spacing that it needs.
Skeleton cut(const Skeleton& whole) {
    Skeleton out;
    out.degree = whole.degree;
    out.loops = whole.loops;
    for (std::size_t c = 0; c < whole.chains.size(); ++c) {
        const Curve& chain = whole.chains[c];
        const int pieces = std::max(1, static_cast<int>(std::ceil(chain.length() / longest_piece)));
        Index from = whole.joints[c][0];
        std::size_t first = 0;
        for (int k = 1; k <= pieces; ++k) {
            std::size_t last = first + 1;
            while (last + 1 < chain.arc.size() && (k == pieces || chain.arc[last] < chain.length() * k / pieces))
                ++last;
            Curve piece;
            for (std::size_t i = first; i <= last; ++i) {
                piece.position.push_back(chain.position[i]);
                piece.radius.push_back(chain.radius[i]);
                piece.arc.push_back(chain.arc[i] - chain.arc[first]);
            }
            const bool end = last + 1 == chain.arc.size();
            const Index to = end ? whole.joints[c][1] : static_cast<Index>(out.degree.size());
            if (!end) out.degree.push_back(2);
            out.chains.push_back(std::move(piece));
            out.joints.push_back({from, to});
            if (end) break;
            from = to;
            first = last;
        }
    }
    return out;
}

ImportedTree make_tree(const Skeleton& skeleton) {
    ImportedTree out;
    std::vector<Index> node_of_joint(skeleton.degree.size(), -1);
    std::vector<ImplicitTree::Vessel> vessels;
    for (std::size_t c = 0; c < skeleton.chains.size(); ++c) {
        const Curve& curve = skeleton.chains[c];
        double least = 1e300;
        for (const double r : curve.radius) least = std::min(least, r);
        const double spacing = least < 2.4 ? 1.0 : 2.5;
        const int pieces = std::max(1, static_cast<int>(std::lround(curve.length() / spacing)));
        Index previous = -1;
        for (int i = 0; i <= pieces; ++i) {
            const double arc = curve.length() * i / pieces;
            const Index joint = i == 0 ? skeleton.joints[c][0] : i == pieces ? skeleton.joints[c][1] : -1;
            Index node = joint >= 0 ? node_of_joint[static_cast<std::size_t>(joint)] : -1;
            if (node < 0) {
                node = static_cast<Index>(out.graph.nodes.size());
                out.graph.nodes.push_back({curve.point(arc), curve.radius_at(arc), static_cast<Index>(c)});
                if (joint >= 0) node_of_joint[static_cast<std::size_t>(joint)] = node;
            }
            if (previous >= 0 && previous != node) out.graph.edges.emplace_back(previous, node);
            previous = node;
        }
        ImplicitTree::Vessel vessel;
        vessel.curve = curve;
        vessels.push_back(std::move(vessel));
    }
    for (std::size_t j = 0; j < skeleton.degree.size(); ++j) {
        if (skeleton.degree[j] == 1) out.free_ends.push_back(node_of_joint[j]);
    }
    out.tree = std::make_unique<ImplicitTree>(std::move(vessels), std::vector<ImplicitTree::Branch>{},
                                              std::vector<ImplicitTree::Bulge>{}, 10.0);
    return out;
}

Index nearest_free_end(const ImportedTree& tree, const Vec3& p) {
    Index best = tree.free_ends.front();
    for (const Index e : tree.free_ends) {
        if ((tree.graph.nodes[static_cast<std::size_t>(e)].position - p).norm() <
            (tree.graph.nodes[static_cast<std::size_t>(best)].position - p).norm())
            best = e;
    }
    return best;
}

std::string in_mm(const Vec3& p) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(1) << '[' << p.x() << ", " << p.y() << ", " << p.z() << ']';
    return text.str();
}

/// Throws UserError where a named point is farther from its place on the centre-line than any hand that points at it
/// would be: another mesh was meant, another unit or another end.
void check_near(const ImportedEntry& spec, const CentrelineNode& place, const std::string& what) {
    constexpr double slack_mm = 20.0, radii = 3.0;
    const double away = (place.position - spec.near).norm(), most = slack_mm + radii * place.radius;
    if (away <= most) return;
    std::ostringstream text;
    text << std::fixed << std::setprecision(0) << "near = " << in_mm(spec.near) << " of '" << spec.name << "' lies "
         << away << " mm from the nearest " << what << ", " << in_mm(place.position) << "; allowed are " << most
         << " mm";
    throw UserError(spec.where, text.str());
}

/// A device's mouth stands inset_mm inside the free end nearest to the named point, looking inwards.
EntrySite make_entry(const ImportedEntry& spec, const ImportedTree& tree,
                     const std::vector<std::vector<Index>>& adjacency) {
    Index previous = nearest_free_end(tree, spec.near);
    check_near(spec, tree.graph.nodes[static_cast<std::size_t>(previous)], "open end");
    Index at = previous;
    double walked = 0.0;
    const auto& nodes = tree.graph.nodes;
    while (walked < spec.inset_mm) {
        const auto& next = adjacency[static_cast<std::size_t>(at)];
        if (at != previous && next.size() != 2) break;
        const Index further = next[0] == previous && next.size() == 2 ? next[1] : next[0];
        walked +=
            (nodes[static_cast<std::size_t>(further)].position - nodes[static_cast<std::size_t>(at)].position).norm();
        previous = at;
        at = further;
    }
    Vec3 direction =
        at == previous
            ? inward(tree.graph, adjacency, at)
            : Vec3(nodes[static_cast<std::size_t>(at)].position - nodes[static_cast<std::size_t>(previous)].position);
    const CentrelineNode& node = nodes[static_cast<std::size_t>(at)];
    return {spec.name, looking_along(node.position, direction), node.radius, at};
}

void name_places(const ImportedAnatomySpec& spec, const ImportedTree& tree, AnatomyModel& model) {
    const auto adjacency = tree.graph.adjacency();
    for (const ImportedEntry& e : spec.entries) model.entries.push_back(make_entry(e, tree, adjacency));
    for (const ImportedEntry& l : spec.landmarks) {
        const Index n = tree.graph.nearest(l.near);
        const CentrelineNode& node = tree.graph.nodes[static_cast<std::size_t>(n)];
        check_near(l, node, "place of the centre-line");
        model.landmarks.push_back(
            {l.name, looking_along(node.position, inward(tree.graph, adjacency, n)), node.radius, n});
    }
    for (std::size_t k = 0; k < tree.free_ends.size(); ++k) {
        const Index n = tree.free_ends[k];
        const CentrelineNode& node = tree.graph.nodes[static_cast<std::size_t>(n)];
        const Vec3 normal = inward(tree.graph, adjacency, n);
        // from beyond the cap to a radius or so inside
        model.fixed.push_back({"end_" + std::to_string(k + 1), node.position, normal, 1.8 * node.radius + 2.0,
                               std::max(fixed_half_length, 0.8 * node.radius)});
        model.landmarks.push_back(
            {"end_" + std::to_string(k + 1), looking_along(node.position, normal), node.radius, n});
    }
    for (const ImportedFixed& f : spec.fixed)
        model.fixed.push_back({f.name, f.center, Vec3::UnitZ(), f.radius_mm, f.radius_mm});
    if (spec.annulus)
        model.annulus = Annulus{looking_along(spec.annulus->center, spec.annulus->axis), spec.annulus->radius_mm};
}

double estimate(const TriMesh& mesh, const std::function<double(const Vec3&)>& size) {
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.vertices[static_cast<std::size_t>(t[0])];
        const Vec3& b = mesh.vertices[static_cast<std::size_t>(t[1])];
        const Vec3& c = mesh.vertices[static_cast<std::size_t>(t[2])];
        const double e = size((a + b + c) / 3.0);
        sum += 0.5 * (b - a).cross(c - a).norm() / (equilateral * e * e);
    }
    return sum;
}

/// A start for remeshing: a level of the distance grid near the wall, whose triangles are even and which has none of
/// the mesh's own folds through itself.  The first level with the mesh's handles is taken (walls in touch join or part
/// with a little more or less room); where none has them, the mesh itself, cut finer.
TriMesh even_surface(const TriMesh& mesh, const MeshQuality& wanted, const DistanceGrid& wall, double triangles,
                     const Workers& workers) {
    for (const double level : {0.0, -0.15, 0.15, -0.3, 0.3, -0.45}) {
        TriMesh even = largest_part(wall.surface(level, workers));
        if (!find_faults(even).sound() || measure_quality(even).genus != wanted.genus) continue;
        taubin_smooth(even, smoothing_steps, 0.5, -0.53);
        return decimate(even, static_cast<std::size_t>(1.3 * triangles));
    }
    return subdivide(mesh);
}

void attribute(const TriMesh& mesh, const ImportedTree& tree, std::vector<Index>& region, std::vector<double>& radius) {
    for (const Vec3& p : mesh.vertices) {
        const FieldSample s = tree.tree->sample(p);
        const CentrelineNode& node =
            tree.graph.nodes[static_cast<std::size_t>(s.vessel < 0 ? tree.graph.nearest(p) : 0)];
        region.push_back(s.vessel < 0 ? node.region : s.vessel);
        radius.push_back(s.vessel < 0 ? node.radius : s.radius);
    }
}

}  // namespace

AnatomyModel import_anatomy(const ImportedAnatomySpec& spec, const Workers& workers, const BuildProgress& progress) {
    auto tell = [&](double fraction, std::string_view what) {
        if (progress) progress(fraction, what);
    };
    validate(spec);
    tell(0.0, "reading the mesh");
    TriMesh mesh = load_mesh(spec.mesh, spec.unit, spec.where);
    orient_outward(mesh);
    require_closed(mesh, spec.mesh, unit_in_mm(spec.unit), spec.where);
    const MeshQuality quality = measure_quality(mesh);
    if (quality.components != 1)
        throw UserError(spec.where, "the mesh file '" + spec.mesh + "' has " + std::to_string(quality.components) +
                                        " separate surfaces; a lumen is one");
    Vec3 low = Vec3::Constant(1e300);
    Vec3 high = Vec3::Constant(-1e300);
    for (const Vec3& p : mesh.vertices) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const double extent = (high - low).maxCoeff();
    if (extent < 5.0 || extent > 3000.0)
        throw UserError(spec.where, "the mesh '" + spec.mesh + "' is " + std::to_string(extent) +
                                        " mm large when read in " + spec.unit +
                                        "; vessels are 5 to 3000 mm: is the unit right (mm, cm, m)?");

    tell(0.1, "distance to the wall");
    const double volume = signed_volume(mesh);
    const double boxes = (high - low).prod();
    const double spacing = std::max({std::clamp(std::cbrt(volume / 700000.0), 0.3, 2.0), std::cbrt(boxes / 5e7)});
    const double voxel = std::max(0.35, extent / 1500.0);
    const DistanceGrid coarse(mesh, spacing, 0.5 * extent, 4.0 * spacing, workers);
    const DistanceGrid wall(mesh, voxel, 4.0 * voxel, 4.0 * voxel, workers);
    tell(0.3, "centre-line");
    const Skeleton skeleton = cut(find_skeleton(coarse, low, high, spacing, workers));
    if (skeleton.chains.empty())
        throw UserError(spec.where, "no centre-line was found in the mesh '" + spec.mesh + "': its lumen is too thin");
    const ImportedTree tree = make_tree(skeleton);
    if (tree.free_ends.empty() && !spec.entries.empty())
        throw UserError(spec.where, "the mesh '" + spec.mesh + "' has no free end at which a device could enter");

    AnatomyModel model;
    model.name = spec.name;
    Hash64 hash;
    hash.word(content_hash(spec));
    hash.word(anatomy_builder_version);
    model.content_hash = hash.value();
    model.centreline = tree.graph;
    for (std::size_t c = 0; c < skeleton.chains.size(); ++c) {
        const double least = *std::min_element(skeleton.chains[c].radius.begin(), skeleton.chains[c].radius.end());
        model.regions.push_back(
            {"branch_" + std::to_string(c + 1), spec.wall_thickness_mm, spec.force_limit_n,
             std::clamp(0.72 * least, std::min(1.0, spec.particle_spacing_mm), spec.particle_spacing_mm)});
    }
    name_places(spec, tree, model);

    tell(0.55, "fine surface");
    SizingLaw fine_law;
    fine_law.edges_round = 2.0 * spec.edges_round;
    fine_law.longest = 1.2;
    for (const Region& r : model.regions) fine_law.vessel_longest.push_back(std::min(1.2, 0.5 * r.particle_spacing_mm));
    RemeshGoal goal;
    goal.size = [&](const Vec3& p) { return tree.tree->size(p, fine_law); };
    goal.project = [&](const Vec3& p, double edge) -> Vec3 {
        Vec3 q = p;
        const FieldSample near = tree.tree->sample(p);
        // as in the parametric tree: corners of flat triangles stand that far outside a round lumen of equal volume
        const double level = edge * edge / (16.0 * std::max(near.radius, edge));
        for (int k = 0; k < 2; ++k) {
            const Vec3 g = wall.gradient(q);
            const double slope = g.squaredNorm();
            if (slope < 0.05) break;  // between two walls
            q -= std::clamp((wall.value(q) - level) / slope, -0.5 * edge, 0.5 * edge) * g;
        }
        return q;
    };
    goal.rounds = 4;
    model.fine = remesh(even_surface(mesh, quality, wall, estimate(mesh, goal.size), workers), goal, workers);
    tell(0.8, "lumen surface");
    SizingLaw law;
    law.edges_round = 1.2 * spec.edges_round;
    law.longest = 4.0;
    double scale = 1.0;
    if (spec.face_count > 0) {
        const double least = estimate(model.fine, [&](const Vec3& p) { return tree.tree->size(p, law); });
        scale = std::sqrt(least / spec.face_count);
        if (scale > 1.06)
            throw UserError(spec.where, "face_count = " + std::to_string(spec.face_count) + " is too few for " +
                                            std::to_string(static_cast<int>(spec.edges_round)) +
                                            " edges round every lumen; it needs about " +
                                            std::to_string(static_cast<int>(least / 1.1)));
    }
    goal.size = [&](const Vec3& p) { return scale * tree.tree->size(p, law); };
    goal.rounds = 6;
    model.lumen = remesh(model.fine, goal, workers);
    if (!find_faults(model.fine).sound() || !find_faults(model.lumen).sound())
        throw UserError(spec.where, "the mesh '" + spec.mesh + "' did not survive its refinement as a closed surface");
    attribute(model.fine, tree, model.fine_region, model.fine_radius);
    attribute(model.lumen, tree, model.lumen_region, model.lumen_radius);
    tell(1.0, "done");
    return model;
}

}  // namespace cathlab
