#pragma once

#include "cloud/cloud.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <iosfwd>
#include <string>

namespace fettle::align {

/// Reads a rigid transform from a text file: p_reference = matrix · p_scan, lengths in the unit of the file.
/// @throws InputError unless it is four lines of four numbers, a rotation and a translation over 0 0 0 1
Eigen::Matrix4d read_transform(const std::string& path);

/// Writes four lines of four numbers with 17 digits, so that they read back as the same bits.
void write_transform(std::ostream& out, const Eigen::Matrix4d& matrix);

/// Components of a motion that are held fixed: shifts along x, y, z of M, rotations about them.
using HeldAxes = std::array<bool, 6>;

using Twist = Eigen::Matrix<double, 6, 1>;
using TwistMatrix = Eigen::Matrix<double, 6, 6>;

/// Coordinates of small rigid motions about a centre: the shift, then the rotation vector times `radius`. All six are
/// in mm and of similar size.
struct TwistFrame {
    Eigen::Vector3d centre; ///< mm
    double radius;          ///< mm

    /// Derivative g of the displacement of `point` along `direction`: the displacement is g·x to first order.
    Twist gradient(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;
    Eigen::Isometry3d motion(const Twist& x) const;
};

/// Frame at the centroid of the points; its radius is their root mean square distance from it. @param points  3xN, mm
TwistFrame twist_frame(const Eigen::Matrix3Xd& points);

/// Gauss-Newton step -A⁺b, zero along held axes and along eigenvectors of A that the points do not determine.
/// @param A  Σ w g gᵀ   @param b  Σ w g r   @param min_eigenvalue  of A, below which a direction is undetermined
Twist solve_step(const TwistMatrix& A, const Twist& b, const HeldAxes& held, double min_eigenvalue);

/// A with the rows and columns of held axes set to zero.
TwistMatrix without_held_axes(TwistMatrix A, const HeldAxes& held);

/// Replaces the linear part by a rotation, to remove the rounding that products accumulate.
Eigen::Isometry3d orthonormalized(Eigen::Isometry3d motion);

} // namespace fettle::align
