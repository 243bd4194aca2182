#pragma once

// For the files of this module alone.

#include <Adaptor3d_Curve.hxx>
#include <Adaptor3d_Surface.hxx>

#include <Eigen/Core>

namespace fettle::cad {

/// The point of a surface closest to a point, near where the search starts.
struct SurfaceFoot {
    Eigen::Vector2d uv;
    Eigen::Vector3d point;    ///< of the surface, mm
    bool is_at_limit = false; ///< of the surface's parameters: the distance is not stationary there
};

/// Newton's method on half the squared distance (Hu & Wallner 2005, with second derivatives), damped so that each step
/// lessens it, within the limits of the parameters of a surface that is not periodic.
/// @param start  u and v to begin with
SurfaceFoot foot_on_surface(const Adaptor3d_Surface& surface, const Eigen::Vector2d& start,
                            const Eigen::Vector3d& point);

/// The point of a curve closest to a point, near where the search starts, between the ends of the curve.
struct CurveFoot {
    double t = 0;
    Eigen::Vector3d point;  ///< of the curve, mm
    bool is_at_end = false; ///< of the curve
};

/// Newton's method, as foot_on_surface().
CurveFoot foot_on_curve(const Adaptor3d_Curve& curve, double start, const Eigen::Vector3d& point);

} // namespace fettle::cad
