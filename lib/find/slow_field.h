#pragma once

#include "compare/signed_distance.h"

#include <Eigen/Core>

namespace fettle::find {

/// Slow displacement of a part from its reference: warp, shrinkage, and what a registration leaves. Each of its three
/// components is a polynomial of degree 5 in the coordinates. Frame: the reference's, mm.
struct SlowField {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double scale = 1;              ///< mm: half of the part's longest side
    Eigen::Matrix3Xd coefficients; ///< a column for each monomial; none: no displacement
    Eigen::MatrixXd root;          ///< L of the normal equations L Lᵀ: rows for x of all monomials, y, z
    double sd = 0;                 ///< of the distances that it leaves, mm

    Eigen::Vector3d at(const Eigen::Vector3d& point) const;
    /// Standard deviation of the field at a point along a direction, mm. It is large where hardly any surface faced
    /// that way: across a plate, only the walls of its few holes determine how far it lies sideways.
    double sd_along(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;
};

/// Prior of the field: metal hardly strains, or any slow form.
enum class Stiffness { metal, none };

/// Fits the field so that points minus the field lie on the reference: weighted least squares of the distances along
/// the normals, and of strains, iterated with Tukey's weights, so that anomalies do not bend it (a smooth non-rigid
/// ICP; compare Amberg, Romdhani & Vetter 2007, who hold neighbours together where here the polynomial does).
/// @param points  3xN, mm, registered; some thousands, evenly over the part
SlowField fit_slow_field(const Eigen::Matrix3Xd& points, const compare::Reference& reference,
                         Stiffness stiffness = Stiffness::metal);

} // namespace fettle::find
