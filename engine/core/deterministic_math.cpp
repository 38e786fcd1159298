#include "core/deterministic_math.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace cathlab::det {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

// pi/2 in three parts with trailing zeros, so that k * part is exact for |k| < 2^20 (Cody and Waite 1980, ch. 8).
constexpr double half_pi_1 = 1.5707963267341256e+00;
constexpr double half_pi_2 = 6.0771005063039660e-11;
constexpr double half_pi_3 = 2.0222662487959506e-21;

// Taylor series on |r| <= pi/4: the first term left out is below 1e-19.
double sin_series(double r) {
    const double r2 = r * r;
    double sum = 0.0;
    for (int n = 17; n >= 3; n -= 2) sum = (1.0 + sum) * (-r2 / static_cast<double>(n * (n - 1)));
    return r + r * sum;
}

double cos_series(double r) {
    const double r2 = r * r;
    double sum = 0.0;
    for (int n = 18; n >= 2; n -= 2) sum = (1.0 + sum) * (-r2 / static_cast<double>(n * (n - 1)));
    return 1.0 + sum;
}

struct Reduced {
    double r;
    int quadrant;
};

Reduced reduce(double x) {
    const double k = std::floor(x * (2.0 / pi) + 0.5);
    const double r = ((x - k * half_pi_1) - k * half_pi_2) - k * half_pi_3;
    const double quadrant = k - 4.0 * std::floor(k / 4.0);
    return {r, static_cast<int>(quadrant)};
}

}  // namespace

double sin(double x) {
    if (!std::isfinite(x) || std::fabs(x) > 1e9) return nan;
    const Reduced a = reduce(x);
    switch (a.quadrant) {
        case 0: return sin_series(a.r);
        case 1: return cos_series(a.r);
        case 2: return -sin_series(a.r);
        default: return -cos_series(a.r);
    }
}

double cos(double x) {
    if (!std::isfinite(x) || std::fabs(x) > 1e9) return nan;
    const Reduced a = reduce(x);
    switch (a.quadrant) {
        case 0: return cos_series(a.r);
        case 1: return -sin_series(a.r);
        case 2: return -cos_series(a.r);
        default: return sin_series(a.r);
    }
}

double tan(double x) {
    return sin(x) / cos(x);
}

double exp(double x) {
    if (std::isnan(x)) return nan;
    if (x > 709.782712893384) return inf;  // log of the largest double
    if (x < -745.0) return 0.0;
    constexpr double ln2_high = 6.93147180369123816490e-01;  // low 32 bits zero
    constexpr double ln2_low = 1.90821492927058770002e-10;
    const double k = std::floor(x * (1.0 / 0.693147180559945309417) + 0.5);
    const double r = (x - k * ln2_high) - k * ln2_low;
    // 1 + r + r^2 (1/2! + r/3! + ...), |r| <= ln(2)/2: the first term left out is below 1e-18.  Terms are summed in
    // pairs and pairs of pairs, since a processor waits for each link of a chain.
    const double r2 = r * r, r4 = r2 * r2;
    const double low = (1.0 / 2 + r * (1.0 / 6)) + r2 * (1.0 / 24 + r * (1.0 / 120));
    const double middle = (1.0 / 720 + r * (1.0 / 5040)) + r2 * (1.0 / 40320 + r * (1.0 / 362880));
    const double high = (1.0 / 3628800 + r * (1.0 / 39916800)) + r2 * (1.0 / 479001600 + r * (1.0 / 6227020800));
    const double sum = 1.0 + (r + r2 * (low + r4 * (middle + r4 * high)));
    const int exponent = static_cast<int>(k);
    if (exponent < -1021 || exponent > 1022) return std::ldexp(sum, exponent);
    return sum * std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52U);
}

double log(double x) {
    if (std::isnan(x) || x < 0.0) return nan;
    if (x == 0.0) return -inf;
    if (x == inf) return inf;
    int exponent = 0;
    double m = 0.0;  // in [0.5, 1)
    if (x >= std::numeric_limits<double>::min()) {
        const auto bits = std::bit_cast<std::uint64_t>(x);
        exponent = static_cast<int>(bits >> 52U) - 1022;
        m = std::bit_cast<double>((bits & 0x000fffffffffffffULL) | (1022ULL << 52U));
    } else {
        m = std::frexp(x, &exponent);
    }
    if (m < 0.70710678118654752440) {
        m *= 2.0;
        --exponent;
    }
    const double s = (m - 1.0) / (m + 1.0);
    const double s2 = s * s, s4 = s2 * s2, s8 = s4 * s4;
    const double low = (1.0 / 3 + s2 * (1.0 / 5)) + s4 * (1.0 / 7 + s2 * (1.0 / 9));
    const double middle = (1.0 / 11 + s2 * (1.0 / 13)) + s4 * (1.0 / 15 + s2 * (1.0 / 17));
    const double high = (1.0 / 19 + s2 * (1.0 / 21)) + s4 * (1.0 / 23);
    const double sum = s2 * (low + s8 * (middle + s8 * high));
    const double k = static_cast<double>(exponent);
    return k * 6.93147180369123816490e-01 + (2.0 * s + (2.0 * s * sum + k * 1.90821492927058770002e-10));
}

double pow(double x, double y) {
    if (x == 0.0 && y > 0.0) return 0.0;
    return exp(y * log(x));
}

double atan(double x) {
    if (std::isnan(x)) return nan;
    // atan x = atan c + atan((x - c) / (1 + x c)) with c the nearest eighth: the series then runs on |t| <= 1/16.
    // Each atan c is the double next to it and what that leaves out.
    static constexpr double centre[9][2] = {
        {0.0, 0.0},
        {0.12435499454676144, -3.1253241424539383e-18},
        {0.24497866312686414, 1.0698755618734451e-17},
        {0.35877067027057225, -2.4623815582638635e-17},
        {0.4636476090008061, 2.2698777452961687e-17},
        {0.5585993153435624, -5.4556305485916264e-18},
        {0.6435011087932844, 1.5834785051444286e-17},
        {0.7188299996216245, -2.1478388444456983e-17},
        {0.7853981633974483, 3.061616997868383e-17},
    };
    constexpr double half_pi_high = 1.5707963267948966;
    constexpr double half_pi_low = 6.123233995736766e-17;
    const double a = std::fabs(x);
    const bool steep = a > 1.0;
    const double y = steep ? 1.0 / a : a;
    // 0 <= y <= 1, and either neighbour of a tie serves.  NOLINTNEXTLINE(bugprone-incorrect-roundings)
    const int k = static_cast<int>(y * 8.0 + 0.5);
    const double c = 0.125 * static_cast<double>(k);
    const double t = (y - c) / (1.0 + y * c);
    const double t2 = t * t;
    double sum = 0.0;
    for (int n = 15; n >= 3; n -= 2) sum = -(sum + 1.0 / static_cast<double>(n)) * t2;
    const double small = centre[k][1] + (t + t * sum);
    const double angle = steep ? (half_pi_high - centre[k][0]) + (half_pi_low - small) : centre[k][0] + small;
    return x < 0.0 ? -angle : angle;
}

double atan2(double y, double x) {
    if (std::isnan(x) || std::isnan(y)) return nan;
    if (x == 0.0 && y == 0.0) return 0.0;
    if (std::fabs(x) >= std::fabs(y)) {
        const double a = atan(y / x);
        if (x > 0.0) return a;
        return y >= 0.0 ? a + pi : a - pi;
    }
    const double a = atan(x / y);
    return y > 0.0 ? pi / 2.0 - a : -pi / 2.0 - a;
}

double asin(double x) {
    const double c = x > 1.0 ? 1.0 : (x < -1.0 ? -1.0 : x);
    return atan2(c, std::sqrt((1.0 - c) * (1.0 + c)));
}

double acos(double x) {
    const double c = x > 1.0 ? 1.0 : (x < -1.0 ? -1.0 : x);
    return atan2(std::sqrt((1.0 - c) * (1.0 + c)), c);
}

Quat rotation_from_vector(const Vec3& v) {
    const double angle = std::sqrt(v.squaredNorm());
    if (angle < 1e-8) {  // sin(a/2)/a = 1/2 to the last bit here
        Quat q(1.0, 0.5 * v.x(), 0.5 * v.y(), 0.5 * v.z());
        q.normalize();
        return q;
    }
    const double s = sin(0.5 * angle) / angle;
    return {cos(0.5 * angle), s * v.x(), s * v.y(), s * v.z()};
}

Vec3 vector_from_rotation(const Quat& q) {
    const Vec3 v = q.w() < 0.0 ? Vec3(-q.vec()) : Vec3(q.vec());
    const double w = std::fabs(q.w());
    const double n = std::sqrt(v.squaredNorm());
    if (n < 1e-9) return 2.0 * v;
    return (2.0 * atan2(n, w) / n) * v;
}

Quat rotation_between(const Vec3& from, const Vec3& to) {
    const double w = 1.0 + from.dot(to);
    const Vec3 c = from.cross(to);
    if (c.squaredNorm() + w * w <
        1e-16) {  // below this the cross product's rounding turns the axis by more than its angle
        Vec3 axis = std::fabs(from.x()) < 0.9 ? from.cross(Vec3::UnitX()) : from.cross(Vec3::UnitY());
        axis.normalize();
        return {0.0, axis.x(), axis.y(), axis.z()};
    }
    Quat q(w, c.x(), c.y(), c.z());
    q.normalize();
    return q;
}

}  // namespace cathlab::det
