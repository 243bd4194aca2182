#pragma once

#include "mesh/mesh.h"
#include "robot/clearance.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fettle::robot {

/// Chen & Wei's formulas as published, some of which are wrong, or corrected.
enum class Formulas { corrected, published };

/// A rectangle in the plane of a grid, mm.
struct Footprint {
    Eigen::Vector2d centre;
    Eigen::Vector2d along; ///< unit
    double half_along, half_across;
};

/// Chen & Wei's grid height array (eq. 8) in the plane perpendicular to the tool's axis: each cell has the largest
/// height of the mesh over it, and each triangle the cells that it projects to (eq. 12).
struct HeightGrid {
    /// @param up  unit, from the tip to the holder, in the part's frame
    /// @param side  of a cell, mm
    /// @param formulas  corrected: a triangle occupies each cell that it touches. Published: those with a corner in it,
    ///                  or, if there are none, those of its bounding box; this misses cells that only an edge crosses
    /// @throws InputError for more than 2^24 cells
    HeightGrid(const mesh::Mesh& mesh, const Eigen::Vector3d& up, double side, Formulas formulas);

    Eigen::Isometry3d T_grid_part;      ///< z is up, and 0 where the mesh is lowest; cell (0, 0) begins at the origin
    double cell_size = 0;               ///< side of a cell, mm
    Eigen::Index columns = 0, rows = 0; ///< along x and y
    std::vector<double> heights;        ///< by index(), mm; negative for an empty cell
    std::vector<std::vector<std::uint32_t>> triangle_cells; ///< by triangle: indices of its cells
    /// Bound of the distance of a cuboid's top from the surface, mm; where the surface is visible from above, of all
    /// points of the cuboid.
    double accuracy = 0;

    std::size_t index(Eigen::Index column, Eigen::Index row) const { return column + columns * row; }
    /// The projection of a solid: the smallest rectangle along its axis. For a tilted cylinder it is 2 R wide and
    /// L sin(tilt) + 2 R cos(tilt) long. Published (eq. 21, 22): (L + R) sin(tilt) long, and a square if it is upright.
    Footprint footprint(const Solid& solid, const Eigen::Isometry3d& T_part_body, Formulas formulas) const;
    /// Sets `cells` to 1 where a rectangle touches the cell.
    void mark(const Footprint& footprint, std::span<char> cells) const;
    /// A box for each occupied cell, from z = 0 to its height: triangles 12 i to 12 i + 11 belong to occupied()[i].
    mesh::Mesh cuboids() const;
    /// Indices of the cells that are not empty.
    std::vector<std::size_t> occupied() const;
};

/// Chen & Wei, eq. 19: the largest spacing at which spheres of a cylinder's radius leave out no more of its side than a
/// tolerance. All in mm.
double sphere_spacing(double radius, double tolerance);
/// Chen & Wei, eq. 20: the number of spheres along a length. Published: rounded to the nearest number, 0 for a short
/// one.
int sphere_count(double length, double spacing, Formulas formulas);
/// The spheres that replace a cylinder, at (i + 1/2) L / k along its axis.
std::vector<solid::Sphere> sphere_row(const solid::Cylinder& cylinder, double tolerance, Formulas formulas);

} // namespace fettle::robot
