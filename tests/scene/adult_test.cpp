// The default adult as its file describes it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "anatomy/build.h"
#include "anatomy/remesh.h"
#include "core/winding.h"
#include "scene/anatomy_file.h"

namespace cathlab {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Built by whichever test comes first and kept for the others, also for those that run as programs of their own.
const AnatomyModel& adult() {
    static const AnatomyModel model =
        load_or_build(load_anatomy(std::string(CATHLAB_SOURCE_DIR) + "/assets/anatomy/adult.toml"),
                      (std::filesystem::path(testing::TempDir()) / "cathlab-test-anatomies").string(), Workers(3));
    return model;
}

Index region(const std::string& name) {
    for (std::size_t r = 0; r < adult().regions.size(); ++r) {
        if (adult().regions[r].name == name) return static_cast<Index>(r);
    }
    return -1;
}

const Landmark& landmark(const std::string& name) {
    for (const Landmark& l : adult().landmarks) {
        if (l.name == name) return l;
    }
    throw std::runtime_error("no landmark " + name);
}

bool inside(const TriMesh& mesh, const Vec3& p) {
    return winding(mesh, p) > 0.5;
}

TEST(Adult, IsOneClosedTreeWithoutHandles) {
    for (const TriMesh* mesh : {&adult().fine, &adult().lumen}) {
        EXPECT_TRUE(find_faults(*mesh).sound());
        EXPECT_EQ(find_faults(*mesh).degenerate_triangles, 0U);
        const MeshQuality q = measure_quality(*mesh);
        EXPECT_EQ(q.genus, 0);
        EXPECT_EQ(q.components, 1);
        EXPECT_GT(q.smallest_angle_deg, 20.0);
        EXPECT_GT(signed_volume(*mesh), 0.0);
    }
    EXPECT_NEAR(signed_volume(adult().lumen) / signed_volume(adult().fine), 1.0, 0.01);
    EXPECT_EQ(adult().centreline.nodes.size(), adult().centreline.edges.size() + 1);
}

TEST(Adult, TenEdgesGoRoundEveryLumen) {
    const TriMesh& mesh = adult().lumen;
    for (const CentrelineNode& n : adult().centreline.nodes) {
        double sum = 0.0;
        int count = 0;
        for (const Triangle& t : mesh.triangles) {
            for (int k = 0; k < 3; ++k) {
                const Vec3& a = mesh.vertices[static_cast<std::size_t>(t[k])];
                const Vec3& b = mesh.vertices[static_cast<std::size_t>(t[(k + 1) % 3])];
                if ((0.5 * (a + b) - n.position).norm() > 1.5 * n.radius) continue;
                sum += (a - b).norm();
                ++count;
            }
        }
        if (count == 0) continue;
        EXPECT_GE(2.0 * pi * n.radius / (sum / count), 10.0) << n.position.transpose();
    }
}

TEST(Adult, NeedsFewerThanTwentyThousandParticlesWithEightRoundEveryLumen) {
    double particles = 0.0;
    for (const Triangle& t : adult().fine.triangles) {
        const auto& v = adult().fine.vertices;
        const Vec3& a = v[static_cast<std::size_t>(t[0])];
        const double area =
            0.5 * (v[static_cast<std::size_t>(t[1])] - a).cross(v[static_cast<std::size_t>(t[2])] - a).norm();
        const Index r = adult().fine_region[static_cast<std::size_t>(t[0])];
        const double s = adult().regions[static_cast<std::size_t>(r)].particle_spacing_mm;
        particles += area / (0.87 * s * s);
    }
    EXPECT_LT(particles, 19500.0);
    for (const CentrelineNode& n : adult().centreline.nodes) {
        const double s = adult().regions[static_cast<std::size_t>(n.region)].particle_spacing_mm;
        EXPECT_GE(2.0 * pi * n.radius / s, 8.0);
    }
}

TEST(Adult, TheCentrelineRunsInTheMiddleOfTheLumen) {
    std::vector<Vec3> ends;
    const auto adjacency = adult().centreline.adjacency();
    for (std::size_t i = 0; i < adjacency.size(); ++i) {
        if (adjacency[i].size() == 1) ends.push_back(adult().centreline.nodes[i].position);
    }
    for (std::size_t i = 0; i < adult().centreline.nodes.size(); i += 5) {
        const CentrelineNode& n = adult().centreline.nodes[i];
        double wall = 1e300;
        for (const Vec3& p : adult().fine.vertices) wall = std::min(wall, (p - n.position).norm());
        bool near_end = false;  // there the closing cap is nearer than the side
        for (const Vec3& e : ends) near_end = near_end || (e - n.position).norm() < n.radius;
        if (near_end) continue;
        EXPECT_TRUE(inside(adult().lumen, n.position)) << n.position.transpose();
        EXPECT_GT(wall, 0.5 * n.radius) << n.position.transpose();
        EXPECT_LT(wall, 1.25 * n.radius + 0.2) << n.position.transpose();
    }
}

TEST(Adult, DevicesEnterInsideTheLumenAndLookIntoIt) {
    ASSERT_EQ(adult().entries.size(), 3U);
    for (const EntrySite& e : adult().entries) {
        EXPECT_TRUE(inside(adult().lumen, e.pose.position)) << e.name;
        EXPECT_TRUE(inside(adult().lumen, e.pose.to_world(Vec3(0.0, 0.0, 8.0)))) << e.name;
        EXPECT_LT((adult().centreline.nodes[static_cast<std::size_t>(e.node)].position - e.pose.position).norm(), 1.5);
    }
}

TEST(Adult, ARouteLeadsFromTheGroinToTheArchWithoutSharpBends) {
    const EntrySite& groin = adult().entries[0];
    ASSERT_EQ(groin.name, "right_femoral");
    const auto& graph = adult().centreline;
    const auto path = graph.path(groin.node, landmark("arch_top").node);
    EXPECT_GT(graph.length(path), 450.0);
    EXPECT_LT(graph.length(path), 900.0);
    for (std::size_t i = 8; i + 8 < path.size(); ++i) {  // radius of the circle through points about 20 mm apart
        const Vec3& a = graph.nodes[static_cast<std::size_t>(path[i - 8])].position;
        const Vec3& b = graph.nodes[static_cast<std::size_t>(path[i])].position;
        const Vec3& c = graph.nodes[static_cast<std::size_t>(path[i + 8])].position;
        const double area = 0.5 * (b - a).cross(c - a).norm();
        EXPECT_GT((b - a).norm() * (c - b).norm() * (a - c).norm() / (4.0 * area), 25.0) << b.transpose();
    }
}

TEST(Adult, CoronariesAreLongerThanSixtyMillimetresBeyondTheLeftMain) {
    for (const char* name : {"left_anterior_descending", "left_circumflex", "right_coronary"}) {
        double length = 0.0;
        for (const auto& [a, b] : adult().centreline.edges) {
            const CentrelineNode& p = adult().centreline.nodes[static_cast<std::size_t>(a)];
            const CentrelineNode& q = adult().centreline.nodes[static_cast<std::size_t>(b)];
            if (p.region == region(name) && q.region == region(name)) length += (p.position - q.position).norm();
        }
        EXPECT_GT(length, 60.0) << name;
    }
}

TEST(Adult, FixedEndsHoldOnlyTheirOwnVessel) {
    ASSERT_GE(adult().fixed.size(), 12U);
    std::map<std::string, std::map<Index, int>> held;
    for (std::size_t i = 0; i < adult().fine.vertices.size(); ++i) {
        for (const FixedZone& z : adult().fixed) {
            if (z.contains(adult().fine.vertices[i])) ++held[z.name][adult().fine_region[i]];
        }
    }
    EXPECT_EQ(held.size(), adult().fixed.size());
    for (const auto& [name, regions] : held) EXPECT_EQ(regions.size(), 1U) << name;
    EXPECT_TRUE(held.count("right_common_femoral_end") == 1 && held.count("left_internal_iliac_end") == 1);
}

TEST(Adult, TheSolidsOfTheTorsoNestAndDoNotMeet) {
    std::size_t triangles = 0;
    std::map<std::string, const ContextSolid*> by_name;
    for (const ContextSolid& s : adult().context) {
        EXPECT_TRUE(find_faults(s.mesh).sound()) << s.name;
        EXPECT_GT(signed_volume(s.mesh), 0.0) << s.name;
        EXPECT_TRUE(by_name.emplace(s.name, &s).second);
        triangles += s.mesh.triangles.size();
    }
    EXPECT_LT(triangles, 8000U);
    for (const ContextSolid& s : adult().context) {
        if (s.inside.empty()) continue;
        ASSERT_EQ(by_name.count(s.inside), 1U) << s.name;
        for (const Vec3& p : s.mesh.vertices) {
            ASSERT_TRUE(inside(by_name[s.inside]->mesh, p)) << s.name << " " << p.transpose();
        }
        for (const ContextSolid& other : adult().context) {
            if (&other == &s || other.inside != s.inside) continue;
            Vec3 low = Vec3::Constant(1e300);
            Vec3 high = Vec3::Constant(-1e300);
            for (const Vec3& p : other.mesh.vertices) {
                low = low.cwiseMin(p);
                high = high.cwiseMax(p);
            }
            for (const Vec3& p : s.mesh.vertices) {
                if ((p - low).minCoeff() < 0.0 || (high - p).minCoeff() < 0.0) continue;
                ASSERT_FALSE(inside(other.mesh, p)) << s.name << " in " << other.name << " " << p.transpose();
            }
        }
    }
    for (const Vec3& p : adult().lumen.vertices) ASSERT_TRUE(inside(by_name["body"]->mesh, p)) << p.transpose();
}

TEST(AnatomyFile, FaultsAreNamedWithTheirLine) {
    const std::string path =
        (std::filesystem::path(testing::TempDir()) / ("cathlab-anatomy-fault-" + std::to_string(getpid()) + ".toml"))
            .string();
    auto error = [&](const std::string& text) -> std::string {
        std::ofstream(path) << text;
        try {
            load_anatomy(path);
        } catch (const UserError& e) {
            return e.what();
        }
        return "no error";
    };
    const std::string head = "schema = 1\n[[region]]\nname = \"a\"\n[[vessel]]\nname = \"v\"\nregion = \"a\"\n";
    EXPECT_EQ(error(head + "points = [[0, 0, 0, 3], [0, 0, 40, 3]]\n"), "no error");
    EXPECT_NE(error(head + "points = [[0, 0, 0, 3], [0, 0, 40, -3]]\n").find("radius"), std::string::npos);
    EXPECT_NE(error(head + "points = [[0, 0, 0, 3], [0, 0, 0, 3]]\n").find("needs a length"), std::string::npos);
    EXPECT_NE(error(head + "points = [[0, 0, 0, 3], [0, 0, nan, 3]]\n").find(":7"), std::string::npos);
    EXPECT_NE(error(head + "pionts = []\n").find("points"), std::string::npos);
    EXPECT_NE(error("schema = 1\nname = 3\n").find(":2"), std::string::npos);
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace cathlab
