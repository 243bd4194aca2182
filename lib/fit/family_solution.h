#pragma once

#include "surface/surface.h"

#include <Eigen/Core>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace fettle {

using Columns = std::vector<Eigen::Index>;

/// What every family is fitted to.
struct Touched {
    Eigen::Matrix3Xd xyz;                                     ///< M, mm
    double sigma = 0;                                         ///< standard deviation of a touch, mm
    double direction = 0;                                     ///< of the rulings, from X_m, rad
    bool given_direction = false;                             ///< are round surfaces straight along it? (swept jobs)
    double freedom = std::numeric_limits<double>::infinity(); ///< of sigma, where it is an estimate
};

/// The least-squares member of a family.
struct FamilySolution {
    Shape shape;
    Eigen::MatrixXd gradients; ///< ∂z/∂θ at all touches, columns
    Eigen::MatrixXd free;      ///< directions in which θ may change, columns; empty: all
    bool converged = true;
    int iterations = 0;
};

/// plane, sphere, cylinder, cone, torus, quadric; quadratic, cubic, quartic (polynomials); swept.
const std::vector<std::string>& family_names();

/// Least squares of the vertical errors of some touches; for the round families of the orthogonal distances over n_z of
/// the quadratic through them, which is the same to first order. Nothing if they do not determine a surface.
std::optional<FamilySolution> solve_family(const std::string& name, const Touched& touched, const Columns& kept);

} // namespace fettle
