// A device that does not fit the vessels, or is not long enough, is the user's error before anything moves.
#include "core/errors.h"
#include "scene/temporary_folder.h"
#include "step/rig.h"

namespace cathlab {
namespace {

std::string wire_text(double length_mm, double diameter_mm) {
    return "schema = 1\nkind = 'wire'\nname = 'w'\nlength_mm = " + std::to_string(length_mm) +
           "\nlink_length_mm = 5.0\n[[sections]]\ndiameter_mm = " + std::to_string(diameter_mm) +
           "\nbending_stiffness_n_mm2 = 100.0\ntorsion_stiffness_n_mm2 = 80.0\naxial_stiffness_n = 5000.0\n"
           "density_kg_m3 = 7000.0\nmaterial = 'nitinol'\n";
}

std::string told(const std::string& rig, const std::string& device, double insertion_mm) {
    const TemporaryFolder folder;
    SceneSpec spec = rig_spec(rig);
    spec.wire.device = folder.write("w.toml", device);
    spec.wire.insertion_mm = insertion_mm;
    try {
        build_world(spec, rig_models(rig), 1, 1);
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

TEST(DeviceFit, AWireAsWideAsTheVesselIsRefused) {
    EXPECT_NE(told("fork", wire_text(400.0, 9.9), 50.0).find("mm wide and the vessel"), std::string::npos);
    EXPECT_EQ(told("fork", wire_text(400.0, 2.0), 50.0), "");
}

TEST(DeviceFit, MoreInsertionThanTheDeviceHasIsRefused) {
    EXPECT_NE(told("tube_wire", wire_text(60.0, 0.9), 80.0).find("only 60"), std::string::npos);
    EXPECT_EQ(told("tube_wire", wire_text(90.0, 0.9), 80.0), "");
}

}  // namespace
}  // namespace cathlab
