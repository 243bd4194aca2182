#pragma once

#include "surface/surface.h"

#include <Eigen/Core>

#include <vector>

namespace fettle {

/// Surfaces of revolution with a circular profile (Torus, surface.h), each within the next but for the sphere.
enum class RoundFamily { sphere, cylinder, cone, torus };

/// A point near the touches, and a frame whose third column points up out of them.
struct RoundFrame {
    Eigen::Vector3d point;
    Eigen::Matrix3d axes; ///< columns a, b, n
};

/// Touches to fit to, seen from a frame.
struct RoundProblem {
    RoundFrame frame;
    Eigen::Matrix3Xd touches;     ///< M, mm
    Eigen::VectorXd weight;       ///< of each touch's orthogonal distance, 1/mm: residuals are weight · distance
    bool given_direction = false; ///< the rulings' direction in the frame's plane is that of a: no turn
};

struct RoundSolution {
    Eigen::VectorXd theta; ///< RevolutionParameters, mm
    double cost = 0;       ///< half the sum of squares; infinite: no solution
    bool converged = false;
    int iterations = 0;
};

/// Least squares of weighted orthogonal distances by Levenberg and Marquardt (Ceres).
/// @param around, along  the curvatures to start with, 1/mm
RoundSolution solve(RoundFamily family, const RoundProblem& problem, double around, double along);

/// How many parameters a family has.
int parameters(RoundFamily family, bool given_direction);

/// The shape: Sphere, Cylinder, Cone or Torus.
Shape round_shape(RoundFamily family, const RoundFrame& frame, const Eigen::VectorXd& theta);

} // namespace fettle
