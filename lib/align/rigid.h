#pragma once

#include "cloud/cloud.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <iosfwd>
#include <string>

namespace fettle {

/// A rigid motion as it stands in a file: p_reference = matrix · p_scan, lengths in the unit of the file.
/// @throws InputError unless it is four lines of four numbers, a rotation and a translation over 0 0 0 1
Eigen::Matrix4d read_transform(const std::string& path);

/// Four lines of four numbers with 17 digits: they read back as the same bits.
void write_transform(std::ostream& out, const Eigen::Matrix4d& matrix);

/// The cloud with its points, normals and viewpoint moved. Row by row x' = ((m00 x + m01 y) + m02 z) + m03 in double,
/// so that anybody who applies the matrix gets the same bits.
/// @param matrix  in units of `mm` millimetres
Cloud moved(Cloud cloud, const Eigen::Matrix4d& matrix, double mm);

/// Which components of a motion are held: shifts along x, y, z of M, turns about them.
using HeldAxes = std::array<bool, 6>;

using Twist = Eigen::Matrix<double, 6, 1>;
using TwistMatrix = Eigen::Matrix<double, 6, 6>;

/// Small rigid motions about a centre, all measured in mm, so that they are of one size: shifts, and turns · radius.
struct TwistFrame {
    Eigen::Vector3d centre; ///< mm
    double radius;          ///< mm

    /// By how much a motion takes `point` along `direction`: g·x, to first order.
    Twist gradient(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;
    Eigen::Isometry3d motion(const Twist& x) const;
};

/// About the points' centroid, with their root mean square distance from it. @param points  3xN, mm
TwistFrame twist_frame(const Eigen::Matrix3Xd& points);

/// The step -A⁺b in the axes that are not held and in those of its directions that the points determine.
/// @param A  sum of weighted g gᵀ, @param b  sum of weighted g r   @param least  eigenvalues below it say nothing
Twist solve_step(const TwistMatrix& A, const Twist& b, const HeldAxes& held, double least);

/// The nearest rotation in place of one that rounding has bent.
Eigen::Isometry3d straightened(const Eigen::Isometry3d& motion);

} // namespace fettle
