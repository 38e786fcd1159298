// A finite-element model of a tube that a ball is pushed into from inside, for recordings of kind wall-contact: nothing
// of the engine is in it.  A thin shell without shear across it, its middle surface of quadratic splines round and
// along (smooth, so that curvatures are those of the surface itself), the wall in two layers that each have their law;
// Newton's method, sample by sample.
#pragma once

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace explain_test {

using Eigen::Vector3d;

/// What a layer's law keeps from sample to sample, at one point.
using LayerMemory = std::array<double, 7>;

/// Second Piola-Kirchhoff stress of a layer, kPa, at Green's strain (both 11, 22, 12).  keep: the sample has ended so,
/// and the memory may change.
using LayerLaw = std::function<Vector3d(const Vector3d& green, LayerMemory& memory, bool keep)>;

/// The edges' bond to what holds them: rigid, or a slider (kPa of the section) with a spring beside it (kPa/mm).
struct EdgeBond {
    bool slides = false;
    double threshold_kpa = 0.0, spring_kpa_per_mm = 0.0;
};

struct TubeRig {
    double lumen_radius_mm = 13.0, length_mm = 60.0, thickness_mm = 1.5;
    double ball_radius_mm = 5.0;
    double bed_kpa_per_mm = 500.0;    ///< how the wall resists being pressed through its thickness
    double support_kpa_per_mm = 0.0;  ///< elastic foundation
    EdgeBond edge;
    LayerLaw law;
};

class TubeShell {
public:
    /// Elements are smallest round (angle, z), where the ball will be.
    TubeShell(const TubeRig& rig, double angle, double z);

    /// The wall at rest with the ball's centre there; the ball's force on it, mN.  Throws std::runtime_error where it
    /// comes to none.
    Vector3d press(const Vector3d& ball);

    /// Where what was at (angle, z) on the outside is now.
    Vector3d outside(double angle, double z) const;

private:
    /// Quadratic splines over breaks, closed or clamped.
    struct Splines {
        std::vector<double> breaks;
        bool closed = false;
        int count() const { return static_cast<int>(breaks.size()) - 1 + (closed ? 0 : 2); }
        double knot(int k) const;
        /// Of the three that are not 0 on a span, from number `span` on: value, first and second derivative.
        Eigen::Matrix3d at(int span, double x) const;
        /// Their numbers for a function, given at the places where they sit.
        Eigen::VectorXd fit(const std::function<double(double)>& f) const;
    };
    static constexpr int layers = 2;
    /// One integration point.
    struct Point {
        std::array<int, 9> node{};
        Eigen::Matrix<double, 9, 6> shape;  ///< value, by u, by v, uu, vv, uv
        double area = 0.0;                  ///< mm2
        Vector3d rest;
        Vector3d metric, bend;                     ///< 11, 22, 12 at rest
        std::array<Eigen::Matrix3d, layers> into;  ///< of strains to the layer's orthonormal frame
        std::array<double, layers> volume{};       ///< mm3
        mutable std::array<LayerMemory, layers> memory{};
    };
    using Local = Eigen::Matrix<double, 3, 6>;  ///< place, its first and second derivatives

    Local local(const Point& p, const Eigen::VectorXd& x) const;
    /// What the energy changes by them.
    Local answer(const Point& p, const Local& q, bool keep) const;
    Vector3d press_at(const Point& p, const Vector3d& place, Eigen::Matrix3d* stiffness) const;
    Eigen::VectorXd forces(const Eigen::VectorXd& x, Eigen::SparseMatrix<double>* stiffness) const;
    Point point(int span_u, int span_v, double u, double v) const;
    bool settle();

    TubeRig rig_;
    double radius_ = 0.0;  // of the middle surface
    double turn_ = 0.0;    // of the frame in which the ball pushes along x
    Splines round_, along_;
    std::vector<Point> points_;
    Eigen::VectorXd rest_, x_;
    std::vector<double> edge_mm2_;  // (nodes) section that a node of an edge holds
    std::vector<Vector3d> anchor_;  // (nodes) of the sliders
    Vector3d ball_ = Vector3d::Constant(1e6);
    bool begun_ = false;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
    bool analysed_ = false;
};

}  // namespace explain_test
