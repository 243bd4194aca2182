#pragma once

#include "surface/surface.h"

#include <Eigen/Core>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace fettle::fit {

/// Indices of touches, the columns of TouchSet::xyz.
using TouchIndices = std::vector<Eigen::Index>;

/// The touches that the families are fitted to.
struct TouchSet {
    Eigen::Matrix3Xd xyz;         ///< M, mm
    double sigma = 0;             ///< standard deviation of a touch, mm
    double direction = 0;         ///< of the rulings, from X_m, rad
    bool given_direction = false; ///< the rulings of round surfaces run along it (swept jobs)
    double freedom = std::numeric_limits<double>::infinity(); ///< degrees of freedom of sigma, if it is an estimate
};

/// A local minimum of a round family's sum of squares.
struct RoundMinimum {
    Eigen::Vector3d first_axis; ///< of the parameters' frame, M
    Eigen::VectorXd theta;      ///< RevolutionParameters, mm
};

/// The least-squares member of a family.
struct FamilySolution {
    surface::Shape shape;
    Eigen::MatrixXd gradients;       ///< ∂z/∂θ at all touches, columns
    Eigen::MatrixXd free_directions; ///< columns span the allowed changes of θ; empty: all changes
    bool converged = true;
    int iterations = 0;
    std::vector<RoundMinimum> minima =
        {}; ///< of a round family: those that may be the least one of almost the same touches
};

/// plane, sphere, cylinder, cone, torus, ellipsoid, quadric; quadratic, cubic, quartic (polynomials); swept.
const std::vector<std::string>& family_names();

/// Least squares of the vertical errors of the kept touches. The round families use the orthogonal distances over n_z
/// of the quadratic through them instead, which are the same to first order.
/// @param near  minima of the same family for almost the same touches, to start from; none: the quadratic's curvatures
/// @return  nothing if the touches do not determine a surface
std::optional<FamilySolution> solve_family(const std::string& name, const TouchSet& touches, const TouchIndices& kept,
                                           const std::vector<RoundMinimum>& near = {});

} // namespace fettle::fit
