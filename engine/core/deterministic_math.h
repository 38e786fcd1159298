// sin, cos, exp and their kin from +, -, *, / and sqrt alone.  The C library picks another variant on another processor
// (fused multiply-add or not), and the last bit of such a result would reach a state hash; these give the same bits
// anywhere.
// Accuracy for |x| < 1e5: 2 ulp (sin, cos, exp, log, atan), 4 ulp (tan, asin, acos, atan2), 1e-14 (pow); next to its
// far zeros the error of sin and cos is absolute, 4e-16. Arguments that are not finite give NaN (exp: +inf gives +inf,
// -inf gives 0).
#pragma once

#include "core/types.h"

namespace cathlab::det {

double sin(double x);
double cos(double x);
double tan(double x);
double exp(double x);
double log(double x);            ///< natural logarithm; x <= 0 gives NaN (0 gives -inf)
double pow(double x, double y);  ///< exp(y log x), x > 0; pow(0, y > 0) = 0
double atan(double x);
double atan2(double y, double x);
double acos(double x);  ///< x is clamped to [-1, 1]
double asin(double x);

/// The rotation by |v| radians about v; exact for v = 0.
Quat rotation_from_vector(const Vec3& v);

/// The vector v with rotation_from_vector(v) = q, |v| <= pi.
Vec3 vector_from_rotation(const Quat& q);

/// The smallest rotation that turns unit vector `from` into unit vector `to` (any axis where they oppose).
Quat rotation_between(const Vec3& from, const Vec3& to);

}  // namespace cathlab::det
