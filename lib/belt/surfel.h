#pragma once

#include "cloud/cloud.h"

#include <Eigen/Core>

#include <string>

namespace fettle {

/// Surface elements of a workpiece (Ren et al. 2006): discs on the design surface, and how far the stock stands over
/// each of them along its normal. Part frame, mm. Grinding changes the displacement alone.
struct Surfels {
    Eigen::Matrix3Xd position;    ///< on the design surface
    Eigen::Matrix3Xd normal;      ///< unit, of the design surface, out of the metal
    Eigen::VectorXd radius;       ///< of the disc
    Eigen::VectorXd displacement; ///< > 0: stock is left; NaN: there is none along the normal
    Eigen::Matrix2Xd uv;          ///< of the patch
    Eigen::VectorXi patch;        ///< from 0
    Eigen::VectorXd area;         ///< of the piece of the design that it stands for, mm²; empty: not known

    Eigen::Index size() const { return position.cols(); }
};

/// Where the stock is now.
Eigen::Matrix3Xd displaced(const Surfels& surfels);

/// From fields normal_x normal_y normal_z radius u v patch displacement area. Without radius, u, v, patch or
/// displacement, as in an ordinary cloud, they are 0: the points are the stock's surface.
/// @throws InputError without normals, or where one has no direction
Surfels surfels_of(const Cloud& cloud, const std::string& source);

Cloud to_cloud(const Surfels& surfels);

} // namespace fettle
