#pragma once

#include <Eigen/Core>

namespace fettle {

/// Parameters of a surface of revolution in the frame (a, b, n) of one of its points: changes of the frame, then its
/// form (Torus, surface.h).
enum RevolutionParameter { kOffset, kTiltAcross, kTiltAlong, kTurn, kAround, kLean, kAlong, kRevolutionParameters };

using RevolutionParameters = Eigen::Matrix<double, kRevolutionParameters, 1>;

/// A surface of revolution with a circular profile: a torus, with `along` = 0 a cone, with `lean` = 0 besides a
/// cylinder, with `lean` = 0 and `along` = `around` a sphere, with neither curvature a plane. With w the axis of
/// revolution and m the direction away from it,
///     w = sin(lean) n + cos(lean) a,   m = cos(lean) n - sin(lean) a.
struct Revolution {
    Eigen::Vector3d w, m; ///< in the frame
    double c = 1, s = 0;  ///< of lean
    double offset = 0, around = 0, along = 0;
    Eigen::Matrix<double, 3, kRevolutionParameters> w_theta, m_theta; ///< ∂w/∂θ, ∂m/∂θ
};

Revolution revolution(const RevolutionParameters& theta);

/// Signed orthogonal distance of a point from it, by curvatures (Lukács, Martin and Marshall 1998), so that nothing
/// cancels as it becomes flat. The profile plane has the coordinates w·d and g, the distance from the cylinder about w
/// through the frame's point; the surface is the circle of curvature `along` through the origin there, with the normal
/// (cos lean, sin lean).
/// @param point  in the frame   @return  NaN where there is no distance: beyond the centre or axis
double distance(const Revolution& surface, const Eigen::Vector3d& point);

struct RevolutionDistance {
    double value = 0;
    Eigen::Vector3d by_point; ///< its gradient
    RevolutionParameters by_theta;
};
/// The same with its derivatives, all NaN where there is no distance.
RevolutionDistance distance_and_slopes(const Revolution& surface, const Eigen::Vector3d& point);

} // namespace fettle
