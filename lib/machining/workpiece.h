#pragma once

#include "mesh/mesh.h"
#include "removal/height_field.h"
#include "sampling/scan.h"

#include <functional>
#include <iosfwd>
#include <limits>
#include <string>

namespace fettle {

class Refinement; // refinement.h

/// What is milled: heights over cells that lie along M.
struct Workpiece {
    HeightField stock;
    double floor = -std::numeric_limits<double>::infinity(); ///< there is no material below it, mm
    std::function<void(HeightField&)> lay = {};              ///< puts its heights into any map
};

/// A box: "x0,y0,z0,x1,y1,z1", mm; floor z0. A cell has material if its centre lies in the box. A tilted box is its
/// upper sides, without a floor.
/// @throws InputError if that is not six numbers, the box has no inside, or the cells are too many (height_field.h)
Workpiece box_workpiece(const std::string& corners, double cell,
                        const Eigen::Matrix3d& rotation_tilted_machine = Eigen::Matrix3d::Identity());

/// A mesh or a cloud as it is seen from above; below its surface everything is material.
/// @throws InputError if the cells are too many
Workpiece scanned_workpiece(Scan scan, double cell);

/// The surface as triangles between the centres of neighbouring cells of rows first to last, where they have material:
/// the vertices lie on the grid; those without material are NaN.
/// @param refinement  of this map, if there is one: its squares are made of smaller triangles, those beside them of a
/// fan about their middle, so that all meet
Mesh surface_between(const HeightField& field, Eigen::Index first, Eigen::Index last,
                     const Refinement* refinement = nullptr);

/// All of these triangles as binary STL, mm. @param tilted  rotation_tilted_machine of the map: the triangles are in M
/// @return  how many
std::size_t write_stl(std::ostream& out, const HeightField& field, const Refinement* refinement = nullptr,
                      const Eigen::Matrix3d& tilted = Eigen::Matrix3d::Identity());

} // namespace fettle
