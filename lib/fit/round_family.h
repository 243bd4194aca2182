#pragma once

#include "surface/surface.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::fit {

/// Surfaces of revolution with a circular profile (Torus, surface.h). Cylinders are a subset of cones, cones of tori.
enum class RoundFamily { sphere, cylinder, cone, torus };

/// A frame with its origin near the touches.
struct RoundFrame {
    Eigen::Vector3d point; ///< M, mm
    Eigen::Matrix3d axes;  ///< columns a, b, n; n is the upward normal of the touched surface
};

/// Touches to fit to, and the frame of the parameters.
struct RoundProblem {
    RoundFrame frame;
    Eigen::Matrix3Xd touches;     ///< M, mm
    Eigen::VectorXd weight;       ///< of each touch's orthogonal distance, 1/mm: residuals are weight · distance
    bool given_direction = false; ///< the rulings run along a in the frame's plane: kTurn is fixed
};

struct RoundSolution {
    Eigen::VectorXd theta; ///< RevolutionParameters, mm
    double cost = 0;       ///< half the sum of squares; infinite if there is no solution
    bool converged = false;
    int iterations = 0;
};

/// Least squares of weighted orthogonal distances by Levenberg and Marquardt (Ceres).
/// @param start  RevolutionParameters, mm; those that the family fixes are not read
RoundSolution solve_round(RoundFamily family, const RoundProblem& problem, Eigen::VectorXd start);
/// Refines a solution to rounding accuracy.
void refine_round(RoundFamily family, const RoundProblem& problem, RoundSolution& solution);

/// The number of free parameters of a family.
int parameter_count(RoundFamily family, bool given_direction);

/// The Sphere, Cylinder, Cone or Torus with the parameters theta in a frame.
surface::Shape round_shape(RoundFamily family, const RoundFrame& frame, const Eigen::VectorXd& theta);

} // namespace fettle::fit
