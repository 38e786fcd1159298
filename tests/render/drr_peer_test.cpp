// Our path lengths against another program's: plastimatch's DRR of the same phantom, cut into voxels.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "render/path_raster.h"
#include "scene.h"

namespace cathlab {
namespace {

using namespace testing_shapes;

constexpr int pixels = 128, voxels = 160;
constexpr double voxel_mm = 0.75, body_cm = 0.2, core_cm = 0.5;  // attenuation, 1/cm
constexpr double in_shadow = 0.001;                              // exponent
const Vec3 body_middle(8, -5, 12), core_middle(24, 2, 28);
constexpr double body_radius = 42, core_radius = 14;

// Attenuation of a point of the phantom: a core within a body.
double attenuation(const Vec3& p) {
    if ((p - core_middle).norm() < core_radius) return core_cm;
    return (p - body_middle).norm() < body_radius ? body_cm : 0.0;
}

// Voxels at a surface hold the mean of 4 x 4 x 4 points.
float voxel_value(const Vec3& middle) {
    const double half_diagonal = 0.87 * voxel_mm;
    const bool mixed = std::fabs((middle - body_middle).norm() - body_radius) < half_diagonal ||
                       std::fabs((middle - core_middle).norm() - core_radius) < half_diagonal;
    if (!mixed) return static_cast<float>(attenuation(middle));
    double sum = 0;
    for (int k = 0; k < 64; ++k) {
        const Vec3 place((k % 4 - 1.5) / 4, (k / 4 % 4 - 1.5) / 4, (k / 16 - 1.5) / 4);
        sum += attenuation(middle + voxel_mm * place);
    }
    return static_cast<float>(sum / 64);
}

void write_phantom(const std::string& folder) {
    const double first = -0.5 * (voxels - 1) * voxel_mm;
    std::vector<float> values;
    values.reserve(static_cast<std::size_t>(voxels) * voxels * voxels);
    for (int z = 0; z < voxels; ++z)
        for (int y = 0; y < voxels; ++y)
            for (int x = 0; x < voxels; ++x)
                values.push_back(voxel_value(Vec3(first + x * voxel_mm, first + y * voxel_mm, first + z * voxel_mm)));
    std::ofstream raw(folder + "/phantom.raw", std::ios::binary);
    raw.write(reinterpret_cast<const char*>(values.data()),
              static_cast<std::streamsize>(values.size() * sizeof(float)));
    std::ofstream header(folder + "/phantom.mhd");
    header << "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
           << "TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = " << first << ' ' << first << ' ' << first
           << "\nElementSpacing = " << voxel_mm << ' ' << voxel_mm << ' ' << voxel_mm << "\nDimSize = " << voxels << ' '
           << voxels << ' ' << voxels << "\nElementType = MET_FLOAT\nElementDataFile = phantom.raw\n";
}

// Exponents, rows from the top, as a viewer who faces the patient sees them.  plastimatch shows the detector as the
// source sees it (its columns run along normal x up, with the normal towards the source), so its rows are read
// backwards.
std::vector<double> by_plastimatch(const std::string& folder, const CArmView& view, const Vec3& isocentre) {
    const Vec3 to_source = (view.source - isocentre).normalized();
    std::ostringstream command;
    command << "cd '" << folder << "' && plastimatch drr --algorithm exact --hu-conversion none --output-format pfm"
            << " --sad " << (view.source - isocentre).norm() << " --sid " << (view.source - view.detector_center).norm()
            << " --dim '" << pixels << ' ' << pixels << "' --detector-size '" << view.height_mm << ' ' << view.width_mm
            << "' --nrm '" << to_source.x() << ' ' << to_source.y() << ' ' << to_source.z() << "' --vup '"
            << -view.down.x() << ' ' << -view.down.y() << ' ' << -view.down.z()
            << "' --isocenter '0 0 0' --output drr phantom.mhd > log.txt 2>&1";
    if (std::system(command.str().c_str()) != 0) return {};
    std::ifstream file(folder + "/drr0000.pfm", std::ios::binary);
    std::string line;
    for (int i = 0; i < 3; ++i) std::getline(file, line);
    std::vector<float> values(static_cast<std::size_t>(pixels) * pixels);
    file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float)));
    if (!file) return {};
    std::vector<double> out;
    for (int row = 0; row < pixels; ++row)
        for (int column = pixels - 1; column >= 0; --column)
            out.push_back(values[static_cast<std::size_t>(row) * pixels + static_cast<std::size_t>(column)]);
    return out;
}

struct Agreement {
    double mean_error = 0;   // of the intensity, relative, within the shadow
    double correlation = 0;  // of the exponents
};

Agreement compare(const std::vector<double>& theirs, const ImageF& body, const ImageF& core) {
    double n = 0, error = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    for (std::size_t i = 0; i < theirs.size(); ++i) {
        const double ours = 0.1 * (body_cm * body.values[i] + (core_cm - body_cm) * core.values[i]);
        if (ours < in_shadow && theirs[i] < in_shadow) continue;  // where there is only air all programs agree
        n += 1;
        error += std::fabs(std::exp(-theirs[i]) / std::exp(-ours) - 1);
        a += ours;
        b += theirs[i];
        aa += ours * ours;
        bb += theirs[i] * theirs[i];
        ab += ours * theirs[i];
    }
    return {error / n, (ab - a * b / n) / std::sqrt((aa - a * a / n) * (bb - b * b / n))};
}

ImageF lengths(const CArmView& view, const TriMesh& mesh) {
    PathRaster raster;
    PathLengths out;
    raster.draw(Projection(view, pixels, pixels), mesh.vertices, mesh.triangles, {}, out);
    return out.length_mm;
}

TEST(Peer, PlastimatchSeesTheSamePhantomAlike) {
    if (std::system("command -v plastimatch > /dev/null 2>&1") != 0)
        GTEST_SKIP() << "plastimatch is not installed (Debian package plastimatch)";
    std::string pattern = (std::filesystem::temp_directory_path() / "cathlab-drr-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    write_phantom(pattern);
    for (const double angle : {0.0, 35.0}) {
        const CArmView from = view(angle, 200);
        const std::vector<double> theirs = by_plastimatch(pattern, from, Vec3::Zero());
        ASSERT_EQ(theirs.size(), static_cast<std::size_t>(pixels) * pixels);
        const Agreement found = compare(theirs, lengths(from, sphere(body_middle, body_radius, 70)),
                                        lengths(from, sphere(core_middle, core_radius, 50)));
        EXPECT_LT(found.mean_error, 0.03) << angle;
        EXPECT_GT(found.correlation, 0.999) << angle;
        RecordProperty("mean_error_" + std::to_string(static_cast<int>(angle)), std::to_string(found.mean_error));
        std::printf(
            "angle %.0f: mean error of the intensity in the shadow %.4f %%, correlation of the exponents %.7f\n", angle,
            100 * found.mean_error, found.correlation);
    }
    std::filesystem::remove_all(pattern);
}

}  // namespace
}  // namespace cathlab
