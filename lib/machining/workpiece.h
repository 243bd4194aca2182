#pragma once

#include "machining/part_mesh.h"
#include "mesh/mesh.h"
#include "removal/height_field.h"
#include "sampling/scan.h"

#include <functional>
#include <iosfwd>
#include <limits>
#include <optional>
#include <string>

namespace fettle::machining {

class Refinement; // refinement.h

/// The stock to be milled, as a height field whose axes are those of M.
struct Workpiece {
    removal::HeightField stock;
    double floor = -std::numeric_limits<double>::infinity();   ///< bottom of the stock, mm
    std::function<void(removal::HeightField&)> rasterize = {}; ///< samples the uncut stock on another grid
    Eigen::Vector3d size = Eigen::Vector3d::Zero();            ///< along x, y, z of the grid, mm
    std::string warning = {};                                  ///< about the file; empty: none
};

/// Stock in the shape of a box. A cell has material if its centre is inside the box. A tilted box is the surface of its
/// upper sides, without a floor.
/// @param corners  "x0,y0,z0,x1,y1,z1", mm, frame M; z0 is the floor   @param cell  side of a cell, mm
/// @throws InputError if there are not six numbers, the box is empty, or there are too many cells (height_field.h)
Workpiece box_workpiece(const std::string& corners, double cell,
                        const Eigen::Matrix3d& rotation_tilted_machine = Eigen::Matrix3d::Identity());

/// Stock from a mesh or a cloud: everything below its upper surface is material.
/// @throws InputError if there are too many cells
Workpiece scanned_workpiece(sampling::Scan scan, double cell);

/// Stock from the value of --stock: "box:" and the corners of a box, or the file of a mesh or a cloud.
/// @param unit  of the file; nothing: mm
/// @throws InputError as box_workpiece(), read_shape() and repair_warning()
Workpiece read_workpiece(const std::string& stock, const std::optional<units::Units::Length>& unit, double cell,
                         const Eigen::Matrix3d& rotation_tilted_machine);

/// A machined surface from a mesh: the mesh itself, or its surface seen from above on a grid with `step`, mm.
/// @param unit  of the file; nothing: mm   @throws InputError as read_part_mesh() and scanned_workpiece()
PartMesh read_machined_surface(const std::string& path, const std::optional<units::Units::Length>& unit,
                               const std::optional<double>& step, const Eigen::Matrix3d& rotation_tilted_machine);

/// Triangulates the surface between the centres of neighbouring cells in the rows first to last. The vertices are the
/// centres; those without material have z NaN and no triangles.
/// @param refinement  of this field, if any: refined squares have smaller triangles, their neighbours are fans about
/// the centre of the square, so that there are no gaps
mesh::Mesh triangulate_rows(const removal::HeightField& field, Eigen::Index first, Eigen::Index last,
                            const Refinement* refinement = nullptr);

/// Writes the triangles of the whole field as binary STL, mm, frame M.
/// @param tilted  rotation_tilted_machine of the field   @return  number of triangles
std::size_t write_stl(std::ostream& out, const removal::HeightField& field, const Refinement* refinement = nullptr,
                      const Eigen::Matrix3d& tilted = Eigen::Matrix3d::Identity());

} // namespace fettle::machining
