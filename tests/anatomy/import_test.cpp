#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "adult.h"
#include "anatomy/build.h"
#include "anatomy/mesh_file.h"
#include "anatomy/remesh.h"

namespace cathlab {
namespace {

namespace fs = std::filesystem;

/// A folder of its own that goes away with the test.
class Import : public testing::Test {
protected:
    void SetUp() override {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::path(testing::TempDir()) / ("cathlab-" + std::to_string(getpid()) + std::string(info->name()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return (folder_ / name).string();
    }
    /// scale: the file's unit; shared_vertices false: every triangle has corners of its own, as in an STL.
    static std::string obj(const TriMesh& mesh, double scale) {
        std::string out;
        for (const Vec3& p : mesh.vertices)
            out += "v " + std::to_string(scale * p.x()) + " " + std::to_string(scale * p.y()) + " " +
                   std::to_string(scale * p.z()) + "\n";
        for (const Triangle& t : mesh.triangles)
            out += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1) +
                   "\n";
        return out;
    }
    static std::string stl(const TriMesh& mesh) {
        std::string out = "solid vessel\n";
        for (const Triangle& t : mesh.triangles) {
            out += "facet normal 0 0 0\nouter loop\n";
            for (int k = 0; k < 3; ++k) {
                const Vec3& p = mesh.vertices[static_cast<std::size_t>(t[k])];
                out += "vertex " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) +
                       "\n";
            }
            out += "endloop\nendfacet\n";
        }
        return out + "endsolid vessel\n";
    }
    static std::string error_of(const std::string& path) {
        ImportedAnatomySpec spec;
        spec.mesh = path;
        try {
            import_anatomy(spec);
        } catch (const UserError& e) {
            return e.what();
        }
        return "no error";
    }

    fs::path folder_;
};

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST_F(Import, AForkIsFoundWithItsThreeEnds) {
    const TriMesh mesh = build_anatomy(test::fork()).lumen;
    ImportedAnatomySpec spec;
    spec.mesh = write("fork.obj", obj(mesh, 0.001));  // in metres
    spec.unit = "m";
    ImportedEntry entry;
    entry.name = "trunk";
    entry.near = Vec3(1.0, 0.0, -5.0);
    spec.entries.push_back(entry);
    const AnatomyModel m = import_anatomy(spec, Workers(2));
    EXPECT_EQ(m.fixed.size(), 3U);
    EXPECT_EQ(m.centreline.edges.size() + 1, m.centreline.nodes.size());
    ASSERT_EQ(m.entries.size(), 1U);
    EXPECT_GT((m.entries[0].pose.orientation * Vec3::UnitZ()).z(), 0.9);  // into the vessel
    EXPECT_LT(m.entries[0].pose.position.z(), 14.0);
    EXPECT_NEAR(m.entries[0].radius_mm, 4.0, 0.5);
    EXPECT_EQ(m.lumen.vertices.size(), m.lumen_region.size());
    EXPECT_NEAR(signed_volume(m.lumen) / signed_volume(mesh), 1.0, 0.04);
    EXPECT_TRUE(find_faults(m.lumen).sound());
    EXPECT_TRUE(find_faults(m.fine).sound());
    for (const CentrelineNode& n : m.centreline.nodes) EXPECT_GT(n.radius, 1.0);
}

TEST_F(Import, AnEntryOrALandmarkFarFromTheVesselsIsRefused) {
    const TriMesh mesh = build_anatomy(test::straight_tube(5.0, 80.0)).lumen;
    ImportedAnatomySpec spec;
    spec.mesh = write("tube.obj", obj(mesh, 1.0));
    ImportedEntry entry;
    entry.name = "groin";
    entry.near = Vec3(0.0, 300.0, 0.0);
    entry.where = {"scene.toml", 7, "anatomy.entry.near"};
    spec.entries.push_back(entry);
    const auto refusal = [&] {
        try {
            import_anatomy(spec);
        } catch (const UserError& e) {
            return std::string(e.what());
        }
        return std::string("no error");
    };
    const std::string far_entry = refusal();
    EXPECT_TRUE(has(far_entry, "scene.toml:7")) << far_entry;
    EXPECT_TRUE(has(far_entry, "of 'groin' lies 29")) << far_entry;
    EXPECT_TRUE(has(far_entry, "from the nearest open end")) << far_entry;
    spec.entries[0].near = Vec3(0.0, 0.0, 40.0);  // half way along: which end is meant?
    EXPECT_TRUE(has(refusal(), "open end"));
    spec.landmarks.push_back(entry);
    spec.entries[0].near = Vec3(0.0, 6.0, -4.0);
    EXPECT_TRUE(has(refusal(), "place of the centre-line"));
    spec.landmarks[0].near = Vec3(0.0, 5.0, 40.0);
    EXPECT_EQ(import_anatomy(spec).entries.size(), 1U);
}

TEST_F(Import, CornersOfItsOwnInEveryTriangleAreWelded) {
    const TriMesh mesh = build_anatomy(test::straight_tube(5.0, 40.0)).lumen;
    const TriMesh read = load_mesh(write("tube.stl", stl(mesh)), "cm", {});
    EXPECT_EQ(read.vertices.size(), mesh.vertices.size());
    EXPECT_TRUE(find_faults(read).sound());
    EXPECT_NEAR(signed_volume(read), 1000.0 * signed_volume(mesh), 1.0);
}

TEST_F(Import, AnInsideOutMeshIsTurned) {
    TriMesh mesh = build_anatomy(test::straight_tube(5.0, 40.0)).lumen;
    const double volume = signed_volume(mesh);
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 2) std::swap(mesh.triangles[i][0], mesh.triangles[i][1]);
    EXPECT_TRUE(orient_outward(mesh));
    EXPECT_TRUE(find_faults(mesh).sound());
    EXPECT_NEAR(signed_volume(mesh), volume, 1e-9);
}

TEST_F(Import, AHoleIsNamedAndCounted) {
    TriMesh mesh = build_anatomy(test::straight_tube(5.0, 40.0)).lumen;
    mesh.triangles.pop_back();
    EXPECT_TRUE(has(error_of(write("hole.obj", obj(mesh, 1.0))), "3 open edges"));
    TriMesh fin = mesh;
    fin.triangles.emplace_back(fin.triangles[5]);
    fin.triangles.back()[2] = fin.triangles[200][0];
    EXPECT_TRUE(has(error_of(write("fin.obj", obj(fin, 1.0))), "non-manifold"));
}

TEST_F(Import, FilesThatAreNoMeshesAreTheUsersErrors) {
    const TriMesh mesh = build_anatomy(test::straight_tube(5.0, 40.0)).lumen;
    EXPECT_TRUE(has(error_of((folder_ / "none.obj").string()), "no mesh file"));
    EXPECT_TRUE(has(error_of(folder_.string()), "no mesh file"));
    EXPECT_TRUE(has(error_of(write("empty.obj", "")), "empty"));
    EXPECT_TRUE(has(error_of(write("words.txt", "v 0 0 0")), "none of OBJ"));
    std::string rubbish;
    for (unsigned i = 0; i < 20000; ++i) rubbish += static_cast<char>((i * 2654435761U) >> 13U);
    for (const char* name : {"rubbish.obj", "rubbish.stl", "rubbish.ply", "rubbish.glb", "rubbish.gltf"})
        EXPECT_FALSE(has(error_of(write(name, rubbish)), "no error")) << name;
    const std::string whole = obj(mesh, 1.0);
    EXPECT_FALSE(has(error_of(write("half.obj", whole.substr(0, whole.size() / 2))), "no error"));
    const std::string text = stl(mesh);
    EXPECT_FALSE(has(error_of(write("half.stl", text.substr(0, text.size() / 2))), "no error"));
    EXPECT_FALSE(
        has(error_of(write("nan.obj", "v nan 0 0\nv inf 1 0\nv 0 1 1\nv 1 1 1\nf 1 2 3\nf 1 3 4\n")), "no error"));
    EXPECT_FALSE(has(error_of(write("far.obj", "v 0 0 0\nv 5 0 0\nv 0 5 0\nf 1 2 9000\n")), "no error"));
    EXPECT_TRUE(has(error_of(write("small.obj", obj(mesh, 0.001))), "is the unit right"));
}

TEST_F(Import, ThePatientsArchHasItsLoops) {
    const fs::path path = fs::path(CATHLAB_SHARED_DATA) / "anatomy" / "arch-and-carotids.obj";
    if (!fs::exists(path)) GTEST_SKIP() << path << " is not there";
    TriMesh mesh = load_mesh(path.string(), "mm", {});
    orient_outward(mesh);
    require_closed(mesh, path.string(), 1.0, {});
    EXPECT_EQ(mesh.triangles.size(), 3584U);
    EXPECT_EQ(measure_quality(mesh).genus, 4);
    EXPECT_GT(signed_volume(mesh), 0.0);
}

TEST_F(Import, ThePatientsOpenAortaIsRefused) {
    const fs::path path = fs::path(CATHLAB_SHARED_DATA) / "anatomy" / "abdominal-aorta.stl";
    if (!fs::exists(path)) GTEST_SKIP() << path << " is not there";
    const std::string error = error_of(path.string());
    EXPECT_TRUE(has(error, "18 open edges")) << error;
    EXPECT_TRUE(has(error, "8 non-manifold edges")) << error;
}

TEST_F(Import, AKeptModelIsTheBuiltOneAndDamageIsNoticed) {
    const AnatomySpec spec = test::straight_tube(5.0, 30.0);
    const std::string cache = (folder_ / "cache").string();
    int built = 0;
    const BuildProgress count = [&](double fraction, std::string_view) { built += fraction >= 1.0 ? 1 : 0; };
    const AnatomyModel first = load_or_build(spec, cache, Workers(1), count);
    EXPECT_EQ(built, 1);
    EXPECT_EQ(model_hash(load_or_build(spec, cache, Workers(1), count)), model_hash(first));
    EXPECT_EQ(built, 1);
    ASSERT_EQ(std::distance(fs::directory_iterator(cache), fs::directory_iterator()), 1);
    const fs::path file = fs::directory_iterator(cache)->path();
    for (const std::uintmax_t place : {std::uintmax_t{3}, std::uintmax_t{20}, fs::file_size(file) / 2}) {
        std::fstream bytes(file, std::ios::binary | std::ios::in | std::ios::out);
        bytes.seekp(static_cast<std::streamoff>(place));
        bytes.put('\x55');
        bytes.close();
        EXPECT_EQ(model_hash(load_or_build(spec, cache, Workers(1), count)), model_hash(first));
    }
    EXPECT_EQ(built, 4);
    fs::resize_file(file, 100);
    EXPECT_EQ(model_hash(load_or_build(spec, cache, Workers(1), count)), model_hash(first));
    AnatomySpec other = spec;
    other.vessels[0].points[1][2] = 31.0;
    EXPECT_NE(load_or_build(other, cache).content_hash, first.content_hash);
    EXPECT_EQ(model_hash(load_or_build(spec, "/proc/none", Workers(1), count)), model_hash(first));
}

}  // namespace
}  // namespace cathlab
