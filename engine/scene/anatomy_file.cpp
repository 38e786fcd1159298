#include "scene/anatomy_file.h"

namespace cathlab {
namespace {

constexpr Range far{-10000.0, 10000.0};

struct AnatomyFile {
    int schema = 0;
    AnatomySpec anatomy;
};

Table<RegionSpec> region_table() {
    return Table<RegionSpec>("a part of the wall")
        .text("name", &RegionSpec::name, "its name")
        .required()
        .number("wall_thickness_mm", &RegionSpec::wall_thickness_mm, "mm", {0.1, 5.0}, "thickness of the wall")
        .number("force_limit_n", &RegionSpec::force_limit_n, "N", {0.01, 100.0},
                "largest force allowed on it: force bar = 1")
        .number("particle_spacing_mm", &RegionSpec::particle_spacing_mm, "mm", {0.2, 10.0},
                "wanted distance of wall particles, the scene's where absent; lowered where fewer than eight would go "
                "round")
        .place(&RegionSpec::where);
}

Table<VesselSpec> vessel_table() {
    return Table<VesselSpec>("a tube along a smooth curve; parents stand before their branches")
        .text("name", &VesselSpec::name, "its name")
        .required()
        .text("parent", &VesselSpec::parent, "the vessel that it leaves; absent for the first one, the root")
        .text("region", &VesselSpec::region, "the region to which its wall belongs")
        .required()
        .boolean("continues", &VesselSpec::continues, "goes on where the parent ends, without a seam")
        .rows("points", &VesselSpec::points, "mm", far, {2, 500},
              "centre-line: x (left), y (posterior), z (cranial), radius of the lumen")
        .required()
        .number("blend", &VesselSpec::blend, "1", {0.0, 2.0}, "rounding of the ostium over the smaller radius")
        .boolean("fixed_end", &VesselSpec::fixed_end, "the wall is held at the far end")
        .number("fixed_length_mm", &VesselSpec::fixed_length_mm, "mm", {0.5, 200.0},
                "length of wall that is held there")
        .place(&VesselSpec::where);
}

Table<StenosisSpec> stenosis_table() {
    return Table<StenosisSpec>("a narrowing")
        .text("vessel", &StenosisSpec::vessel, "the vessel")
        .required()
        .number("place_mm", &StenosisSpec::place_mm, "mm", {0.0, 2000.0},
                "its middle, along the vessel from its first point")
        .required()
        .number("length_mm", &StenosisSpec::length_mm, "mm", {1.0, 100.0}, "its length")
        .number("degree", &StenosisSpec::degree, "1", {0.0, 0.9}, "share of the diameter that is lost in the middle")
        .required()
        .place(&StenosisSpec::where);
}

Table<SinusSpec> sinus_table() {
    return Table<SinusSpec>("a sinus of Valsalva: a sphere beside the annulus' axis")
        .text("name", &SinusSpec::name, "its name")
        .number("angle_deg", &SinusSpec::angle_deg, "deg", {-360.0, 360.0}, "about the axis: 0 anterior, 90 left")
        .number("height_mm", &SinusSpec::height_mm, "mm", {0.0, 100.0}, "of the centre above the annulus")
        .number("offset_mm", &SinusSpec::offset_mm, "mm", {0.0, 60.0}, "of the centre from the axis")
        .number("radius_mm", &SinusSpec::radius_mm, "mm", {0.5, 40.0}, "of the sphere");
}

Table<AnnulusSpec> annulus_table() {
    return Table<AnnulusSpec>("the ring where the aorta meets the heart")
        .text("vessel", &AnnulusSpec::vessel, "the vessel whose first point is its centre")
        .required()
        .number("radius_mm", &AnnulusSpec::radius_mm, "mm", {1.0, 40.0}, "of the ring")
        .tables("sinus", &AnnulusSpec::sinuses, sinus_table(), {0, 8})
        .place(&AnnulusSpec::where);
}

Table<EntrySpec> entry_table() {
    return Table<EntrySpec>("a place where a device enters: the free end of a vessel")
        .text("name", &EntrySpec::name, "its name")
        .required()
        .text("vessel", &EntrySpec::vessel, "the vessel")
        .required()
        .number("inset_mm", &EntrySpec::inset_mm, "mm", {1.0, 100.0}, "how far inside the end")
        .place(&EntrySpec::where);
}

Table<LandmarkSpec> landmark_table() {
    return Table<LandmarkSpec>("a named place on a centre-line")
        .text("name", &LandmarkSpec::name, "its name")
        .required()
        .text("vessel", &LandmarkSpec::vessel, "the vessel")
        .required()
        .choice("at", &LandmarkSpec::at, {"ostium", "start", "end", "top", "place"}, "where on it")
        .number("place_mm", &LandmarkSpec::place_mm, "mm", {0.0, 2000.0},
                "arc length from the first point, for at = 'place'")
        .place(&LandmarkSpec::where);
}

Table<MeshingSpec> meshing_table() {
    return Table<MeshingSpec>("how fine the surfaces are")
        .number("voxel_mm", &MeshingSpec::voxel_mm, "mm", {0.1, 3.0}, "of the distance grid")
        .integer("face_count", &MeshingSpec::face_count, "1", {100, 2e6}, "triangles of the lumen surface")
        .integer("smoothing_steps", &MeshingSpec::smoothing_steps, "1", {0, 100}, "Taubin steps on the grid's surface")
        .number("smoothing_lambda", &MeshingSpec::smoothing_lambda, "1", {0.0, 1.0}, "Taubin's lambda")
        .number("smoothing_mu", &MeshingSpec::smoothing_mu, "1", {-1.0, 0.0}, "Taubin's mu")
        .number("edges_round", &MeshingSpec::edges_round, "1", {6.0, 64.0}, "least number of edges round every lumen")
        .number("coarse_edge_mm", &MeshingSpec::coarse_edge_mm, "mm", {1.0, 20.0},
                "longest wanted edge of the lumen surface, before face_count scales it")
        .number("fine_edge_mm", &MeshingSpec::fine_edge_mm, "mm", {0.2, 5.0}, "longest wanted edge of the fine surface")
        .place(&MeshingSpec::where);
}

Table<ImportedEntry> imported_entry_table(const std::string& doc) {
    return Table<ImportedEntry>(doc)
        .text("name", &ImportedEntry::name, "its name")
        .required()
        .vec3("near", &ImportedEntry::near, "mm", far, "a point near it, in the mesh's frame after scaling to mm")
        .required()
        .number("inset_mm", &ImportedEntry::inset_mm, "mm", {0.0, 100.0}, "how far inside the vessel's end")
        .place(&ImportedEntry::where);
}

}  // namespace

const Table<AnatomySpec>& anatomy_table() {
    static const auto table = Table<AnatomySpec>("a parametric arterial tree")
                                  .text("name", &AnatomySpec::name, "its name")
                                  .boolean("torso", &AnatomySpec::torso, "put bones, lungs and a body outline round it")
                                  .tables("region", &AnatomySpec::regions, region_table(), {1, 200})
                                  .tables("vessel", &AnatomySpec::vessels, vessel_table(), {1, 200})
                                  .tables("stenosis", &AnatomySpec::stenoses, stenosis_table(), {0, 100})
                                  .table("annulus", &AnatomySpec::annulus, annulus_table())
                                  .tables("entry", &AnatomySpec::entries, entry_table(), {0, 20})
                                  .tables("landmark", &AnatomySpec::landmarks, landmark_table(), {0, 200})
                                  .table("meshing", &AnatomySpec::meshing, meshing_table());
    return table;
}

const Table<ImportedAnatomySpec>& imported_anatomy_table() {
    static const auto table =
        Table<ImportedAnatomySpec>("vessels from a triangle mesh")
            .text("name", &ImportedAnatomySpec::name, "its name")
            .path("mesh", &ImportedAnatomySpec::mesh, "OBJ, STL, PLY, GLB or glTF file: closed and manifold")
            .required()
            .choice("unit", &ImportedAnatomySpec::unit, {"mm", "cm", "m"}, "the unit of its coordinates")
            .tables("entry", &ImportedAnatomySpec::entries, imported_entry_table("a place where a device enters"),
                    {0, 20})
            .tables("landmark", &ImportedAnatomySpec::landmarks, imported_entry_table("a named place"), {0, 200})
            .tables("fixed", &ImportedAnatomySpec::fixed,
                    Table<ImportedFixed>("wall that is held, beside the ends")
                        .text("name", &ImportedFixed::name, "its name")
                        .vec3("center", &ImportedFixed::center, "mm", far, "middle of the ball in which it is held")
                        .required()
                        .number("radius_mm", &ImportedFixed::radius_mm, "mm", {0.1, 1000.0}, "of the ball")
                        .place(&ImportedFixed::where),
                    {0, 100})
            .table("annulus", &ImportedAnatomySpec::annulus,
                   Table<ImportedAnnulus>("where the aorta meets the heart; without it no heart may act")
                       .vec3("center", &ImportedAnnulus::center, "mm", far, "its centre")
                       .required()
                       .vec3("axis", &ImportedAnnulus::axis, "1", far, "from the ventricle into the aorta")
                       .required()
                       .number("radius_mm", &ImportedAnnulus::radius_mm, "mm", {1.0, 40.0}, "of the ring"))
            .number("wall_thickness_mm", &ImportedAnatomySpec::wall_thickness_mm, "mm", {0.1, 5.0},
                    "thickness of the wall")
            .number("force_limit_n", &ImportedAnatomySpec::force_limit_n, "N", {0.01, 100.0},
                    "largest force allowed on it")
            .number("particle_spacing_mm", &ImportedAnatomySpec::particle_spacing_mm, "mm", {0.2, 10.0},
                    "wanted distance of wall particles")
            .number("edges_round", &ImportedAnatomySpec::edges_round, "1", {6.0, 64.0},
                    "least number of edges round every lumen")
            .integer("face_count", &ImportedAnatomySpec::face_count, "1", {0, 2e6},
                     "triangles of the lumen; 0 = as many as edges_round asks for")
            .place(&ImportedAnatomySpec::where);
    return table;
}

AnatomySpec load_anatomy(const std::string& path) {
    static const auto file = Table<AnatomyFile>("an anatomy file")
                                 .integer("schema", &AnatomyFile::schema, "1", {1, 1}, "version of this file's form")
                                 .required()
                                 .include(&AnatomyFile::anatomy, anatomy_table());
    AnatomySpec spec = read_table(load_toml(path), file).anatomy;
    validate(spec);
    return spec;
}

}  // namespace cathlab
