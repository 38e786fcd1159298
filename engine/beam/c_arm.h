// Where the tube and the detector stand, and where a point falls on the image.  Angles by DICOM's signs.
#pragma once

#include "core/errors.h"
#include "core/types.h"

namespace cathlab {

/// Geometry of the C-arm.  World frame: DICOM patient axes (x to the patient's left, y posterior, z cranial), patient
/// supine.
struct CArmSpec {
    double sid_mm = 1050.0;        ///< source to detector, (0018,1110)
    double sod_mm = 750.0;         ///< source to isocentre, (0018,1111); less than sid_mm
    double field_mm = 200.0;       ///< width of the field at the detector
    int columns = 512;             ///< pixels across the field
    int rows = 512;                ///< pixels down; the pixels are square
    double rotation_deg_s = 25.0;  ///< fastest change of either angle

    double pixel_mm() const { return field_mm / columns; }
};

/// Throws UserError: distances, field or pixels out of range, SOD not below SID.
void validate(const CArmSpec& spec, const SourcePlace& where = {});

/// Primary angle: + = LAO, the detector moves to the patient's left.  Secondary: + = cranial.  [dicom-ps3.3]
struct CArmPose {
    Vec3 source = Vec3::Zero();     ///< focal spot, world, mm
    Vec3 detector = Vec3::Zero();   ///< middle of the detector
    Vec3 right = Vec3::UnitX();     ///< image right; at AP the patient's left, as when facing the patient
    Vec3 down = -Vec3::UnitZ();     ///< image down; at AP caudal
    Vec3 forward = -Vec3::UnitY();  ///< from the source to the detector
};

/// forward = (sin a cos b, -cos a cos b, sin b), right = (cos a, sin a, 0), down = -(forward x right), a = primary, b =
/// secondary.
CArmPose c_arm_pose(const CArmSpec& spec, const Vec3& isocentre, double primary_deg, double secondary_deg);

/// Column and row (whole numbers at pixel centres, 0 0 = upper left) of the shadow of a point; a point behind the
/// source or on its level gives NaN.  A pixel at SOD shows pixel_mm / (SID / SOD) of the patient.
Vec2 project(const CArmSpec& spec, const CArmPose& pose, const Vec3& p_world);

/// The point of the detector under a pixel, world.
Vec3 pixel_on_detector(const CArmSpec& spec, const CArmPose& pose, const Vec2& pixel);

}  // namespace cathlab
