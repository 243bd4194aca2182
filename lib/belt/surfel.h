#pragma once

#include "cloud/cloud.h"
#include "cloud/pcd.h"

#include <Eigen/Core>

#include <optional>
#include <string>

namespace fettle::belt {

/// Surface elements of a workpiece (Ren et al. 2006): discs on the design surface, and the displacement of the stock's
/// surface from each along its normal. Part frame, mm. Grinding changes only the displacement.
struct Surfels {
    Eigen::Matrix3Xd position;    ///< on the design surface
    Eigen::Matrix3Xd normal;      ///< unit, of the design surface, out of the metal
    Eigen::VectorXd radius;       ///< of the disc
    Eigen::VectorXd displacement; ///< > 0: stock is left; NaN: no stock along the normal
    Eigen::Matrix2Xd uv;          ///< parameters on the patch
    Eigen::VectorXi patch;        ///< number of the patch, from 0
    Eigen::VectorXd area;         ///< of the piece of the design that the surfel represents, mm²; empty: unknown

    Eigen::Index size() const { return position.cols(); }
};

/// Points on the surface of the stock, 3xN.
Eigen::Matrix3Xd displaced_positions(const Surfels& surfels);

/// The outer of the design's and the stock's surface at each surfel, 3xN: nothing of the workpiece stands beyond it.
Eigen::Matrix3Xd outer_positions(const Surfels& surfels);

/// Surfels from the fields normal_x normal_y normal_z radius u v patch displacement area. A missing radius, u, v, patch
/// or displacement is 0, so that the points of an ordinary cloud are the surface of the stock.
/// @param source  name of the cloud for messages
/// @throws InputError without normals, or if a normal is zero
Surfels surfels_from_cloud(const cloud::Cloud& cloud, const std::string& source);

/// Surfels of a file, with the cloud that they came from.
struct SurfelFile {
    cloud::CloudFile file;
    Surfels surfels;
};
/// Reads a PCD or a PLY. @param unit  of the file; nothing: as its header says, else mm
/// @throws InputError as read_cloud() and surfels_from_cloud()
SurfelFile read_surfels(const std::string& path, const std::optional<units::Units::Length>& unit = std::nullopt);

/// Cloud with the fields that surfels_from_cloud() reads.
cloud::Cloud to_cloud(const Surfels& surfels);

} // namespace fettle::belt
