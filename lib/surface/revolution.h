#pragma once

#include <Eigen/Core>

namespace fettle::surface {

/// Parameters of a surface of revolution in the frame (a, b, n) of one of its points: small changes of the frame, then
/// its curvatures and lean (see Torus, surface.h).
enum RevolutionParameter {
    kOffset,
    kTiltAcross,
    kTiltAlong,
    kTurn,
    kCurvatureAround,
    kLean,
    kCurvatureAlong,
    kRevolutionParameterCount
};

using RevolutionParameters = Eigen::Matrix<double, kRevolutionParameterCount, 1>;

/// Surface of revolution with a circular profile. Special cases: cone (`along` = 0), cylinder (`along` = 0, `lean` =
/// 0), sphere (`along` = `around`, `lean` = 0), plane (both curvatures 0); in general a torus. w is the axis of
/// revolution, m the radial direction away from it:
///     w = sin(lean) n + cos(lean) a,   m = cos(lean) n - sin(lean) a.
struct Revolution {
    Eigen::Vector3d w, m; ///< unit, in the frame (a, b, n)
    double c = 1, s = 0;  ///< cosine and sine of lean
    double offset = 0, curvature_around = 0, curvature_along = 0;
    Eigen::Matrix<double, 3, kRevolutionParameterCount> w_theta, m_theta; ///< ∂w/∂θ, ∂m/∂θ
};

/// The surface with these parameters, and the derivatives of w and m.
Revolution make_revolution(const RevolutionParameters& theta);

/// Signed orthogonal distance of a point from the surface, mm, in terms of curvatures (Lukács, Martin and Marshall
/// 1998), which is free of cancellation for nearly flat surfaces, and its derivatives. The profile plane has the
/// coordinates w·d and g, the distance from the cylinder about w through the frame's origin; the profile is the circle
/// of curvature `along` through the origin of that plane, with the normal (cos lean, sin lean). All are NaN beyond the
/// centre or axis, where no distance is defined.
struct RevolutionDistance {
    double value = 0;
    Eigen::Vector3d gradient;                ///< derivative by the point
    RevolutionParameters parameter_gradient; ///< derivative by the parameters
};
/// @param point  in the frame (a, b, n), mm
RevolutionDistance distance_with_gradients(const Revolution& surface, const Eigen::Vector3d& point);

/// A column for each parameter, a row for each point.
using RevolutionJacobian = Eigen::Matrix<double, Eigen::Dynamic, kRevolutionParameterCount>;

/// The distances of many points, four at once, with the digits of distance_with_gradients().
/// @param points  one in each row, mm   @param values  as many, to be filled
/// @param by_parameters  is filled with the derivatives as distance_with_gradients() gives them; null: they are not
/// wanted
void distances(const Revolution& surface, const Eigen::MatrixX3d& points, double* values,
               RevolutionJacobian* by_parameters);

} // namespace fettle::surface
