#include "anatomy/build.h"

#include <algorithm>
#include <cmath>

#include "anatomy/remesh.h"
#include "anatomy/torso.h"
#include "anatomy/tree_layout.h"
#include "anatomy/voxel_surface.h"
#include "core/hash.h"

namespace cathlab {
namespace {

constexpr double equilateral = 0.4330127018922193;  // area of a triangle of edge 1

/// Newton steps along the gradient to the level e^2 / (16 r): a surface of flat triangles of edge e whose corners lie
/// that far outside a tube of radius r holds the tube's volume (mean gap of a chord: kappa e^2 / 16 over all
/// directions).
Vec3 project(const ImplicitTree& tree, Vec3 p, double edge) {
    for (int k = 0; k < 3; ++k) {
        const FieldSample s = tree.sample(p);
        if (s.vessel < 0) return p;
        const double off = s.value - edge * edge / (16.0 * std::max(s.radius, 0.1));
        const double slope = s.gradient.squaredNorm();
        if (slope < 1e-6) return p;
        p -= std::clamp(off / slope, -edge, edge) * s.gradient;
        if (std::fabs(off) < 1e-4) break;
    }
    return p;
}

double count_triangles(const TriMesh& fine, const ImplicitTree& tree, const SizingLaw& law, const Workers& workers) {
    std::vector<double> share(fine.triangles.size());
    workers.for_ranges(share.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Triangle& t = fine.triangles[i];
            const Vec3& a = fine.vertices[static_cast<std::size_t>(t[0])];
            const Vec3& b = fine.vertices[static_cast<std::size_t>(t[1])];
            const Vec3& c = fine.vertices[static_cast<std::size_t>(t[2])];
            const double e = tree.size((a + b + c) / 3.0, law);
            share[i] = 0.5 * (b - a).cross(c - a).norm() / (equilateral * e * e);
        }
    });
    double sum = 0.0;
    for (const double s : share) sum += s;
    return sum;
}

RemeshGoal goal_of(const ImplicitTree& tree, const SizingLaw& law, double scale, int rounds) {
    RemeshGoal goal;
    goal.size = [&tree, law, scale](const Vec3& p) { return scale * tree.size(p, law); };
    goal.project = [&tree](const Vec3& p, double edge) { return project(tree, p, edge); };
    goal.rounds = rounds;
    return goal;
}

void attribute(const TriMesh& mesh, const TreeLayout& layout, std::vector<Index>& region, std::vector<double>& radius) {
    for (const Vec3& p : mesh.vertices) {
        const FieldSample s = layout.tree->sample(p);
        region.push_back(s.vessel < 0 ? 0 : layout.region[static_cast<std::size_t>(s.vessel)]);
        radius.push_back(s.radius);
    }
}

/// Scales the wanted edges so that the remeshed lumen has the stated number of triangles.
TriMesh make_lumen(const AnatomySpec& spec, const TreeLayout& layout, const TriMesh& fine, const Workers& workers) {
    SizingLaw law;
    law.edges_round = 1.2 * spec.meshing.edges_round;  // a mean of a fifth more keeps the sparse places above the least
    law.longest = spec.meshing.coarse_edge_mm;
    const double wanted = spec.meshing.face_count;
    double scale = std::sqrt(count_triangles(fine, *layout.tree, law, workers) / wanted);
    TriMesh lumen = fine;
    const auto off_by = [&] { return static_cast<double>(lumen.triangles.size()) / wanted; };
    for (int pass = 0; pass < 3; ++pass) {
        if (scale > 1.06) {
            const double least = wanted * scale * scale / (1.05 * 1.05);
            throw UserError(spec.meshing.where, "face_count = " + std::to_string(spec.meshing.face_count) +
                                                    " is too few for " +
                                                    std::to_string(static_cast<int>(spec.meshing.edges_round)) +
                                                    " edges round every lumen of '" + spec.name + "'; it needs about " +
                                                    std::to_string(100 * static_cast<int>(std::ceil(least / 100.0))) +
                                                    " (or a larger coarse_edge_mm)");
        }
        lumen = remesh(lumen, goal_of(*layout.tree, law, scale, pass == 0 ? 6 : 3), workers);
        if (std::fabs(off_by() - 1.0) < 0.03) break;
        scale = std::min(scale * std::sqrt(off_by()), 1.06);
    }
    if (std::fabs(off_by() - 1.0) > 0.1)
        throw UserError(spec.meshing.where, "face_count = " + std::to_string(spec.meshing.face_count) +
                                                " cannot be met: the lumen of '" + spec.name + "' came out with " +
                                                std::to_string(lumen.triangles.size()) + " triangles");
    return lumen;
}

void require_tree(const TriMesh& mesh, const std::string& name) {
    const MeshFaults faults = find_faults(mesh);
    const MeshQuality quality = measure_quality(mesh);
    if (!faults.sound() || faults.degenerate_triangles > 0 || quality.genus != 0 || quality.components != 1)
        throw UserError("the lumen of '" + name + "' did not come out as one closed tree (" +
                        std::to_string(faults.open_edges) + " open and " + std::to_string(faults.non_manifold_edges) +
                        " non-manifold edges, " + std::to_string(quality.genus) + " handles, " +
                        std::to_string(quality.components) + " parts): vessels touch, or voxel_mm is too large");
}

}  // namespace

AnatomyModel build_anatomy(const AnatomySpec& spec, const Workers& workers, const BuildProgress& progress) {
    auto tell = [&](double fraction, std::string_view what) {
        if (progress) progress(fraction, what);
    };
    validate(spec);
    tell(0.0, "laying out the vessels");
    const TreeLayout layout = lay_out(spec);
    const ImplicitTree& tree = *layout.tree;

    AnatomyModel model;
    model.name = spec.name;
    Hash64 hash;
    hash.word(content_hash(spec));
    hash.word(anatomy_builder_version);
    model.content_hash = hash.value();
    const GraphPlaces places = make_graph(layout);
    model.centreline = places.graph;
    place_names(spec, layout, places, model);

    tell(0.05, "distance field and its surface");
    const MeshingSpec& m = spec.meshing;
    TriMesh raw = mesh_level_set([&](const Vec3& p) { return tree.sample(p).value; }, tree.low(), tree.high(),
                                 m.voxel_mm, workers);
    require_tree(raw, spec.name);
    taubin_smooth(raw, m.smoothing_steps, m.smoothing_lambda, m.smoothing_mu);

    tell(0.35, "fine surface");
    SizingLaw fine_law;
    fine_law.edges_round = 2.0 * m.edges_round;
    fine_law.longest = m.fine_edge_mm;
    for (const Index r : layout.region)
        fine_law.vessel_longest.push_back(
            std::min(m.fine_edge_mm, 0.5 * model.regions[static_cast<std::size_t>(r)].particle_spacing_mm));
    // Straight from the grid's even triangles: decimated first, a straight tube comes in slivers along its whole
    // length, which remeshing splits for ever and cannot collapse.
    model.fine = remesh(raw, goal_of(tree, fine_law, 1.0, 3), workers);
    require_tree(model.fine, spec.name);
    tell(0.75, "lumen surface");
    model.lumen = make_lumen(spec, layout, model.fine, workers);
    require_tree(model.lumen, spec.name);
    attribute(model.fine, layout, model.fine_region, model.fine_radius);
    attribute(model.lumen, layout, model.lumen_region, model.lumen_radius);

    tell(0.92, "torso");
    if (spec.torso) model.context = make_torso(workers);
    tell(1.0, "done");
    return model;
}

}  // namespace cathlab
