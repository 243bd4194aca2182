#pragma once

#include "mesh/mesh.h"
#include "robot/clearance.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fettle {

/// Formulas that Chen & Wei print and that are wrong are kept beside right ones.
enum class Formulas { right, published };

/// A rectangle in the plane of a grid, mm.
struct Footprint {
    Eigen::Vector2d centre;
    Eigen::Vector2d along; ///< unit
    double half_along, half_across;
};

/// Chen & Wei's grid height array (eq. 8) over the plane across the tool's direction: each cell has the height of what
/// projects onto it and the triangles that do (eq. 12).
struct HeightGrid {
    /// @param up  unit, from the tip to the holder, in the part's frame
    /// @param cell  its side, mm
    /// @param formulas  right: a triangle occupies each cell that it touches. Published: those with a corner in it, or,
    ///                  if there are none, those of its box; so it misses cells that only an edge crosses
    /// @throws InputError if that were more than 2^24 cells
    HeightGrid(const Mesh& mesh, const Eigen::Vector3d& up, double cell, Formulas formulas);

    Eigen::Isometry3d T_grid_part; ///< z is up, and 0 where the mesh is lowest; cell (0, 0) begins at the origin
    double cell = 0;
    Eigen::Index columns = 0, rows = 0;               ///< along x and y
    std::vector<double> heights;                      ///< column + columns * row; negative: nothing is there
    std::vector<std::vector<std::uint32_t>> cells_of; ///< of each triangle
    /// No point of a cuboid's top is farther from the surface, mm; nor are others, where the surface can be seen from
    /// above.
    double accuracy = 0;

    std::size_t index(Eigen::Index column, Eigen::Index row) const
    {
        return static_cast<std::size_t>(column + columns * row);
    }
    /// Where a solid projects to: the smallest rectangle along its axis, of a tilted cylinder 2 R wide and
    /// L sin(tilt) + 2 R cos(tilt) long. Published (eq. 21, 22): of a cylinder (L + R) sin(tilt) long, upright a
    /// square.
    Footprint footprint(const Solid& solid, const Eigen::Isometry3d& T_part_body, Formulas formulas) const;
    /// Marks the cells that a rectangle touches.
    void mark(const Footprint& footprint, std::span<char> cells) const;
    /// A box for each cell, from the floor to its height: triangles 12 i to 12 i + 11 are those of occupied()[i].
    Mesh cuboids() const;
    /// Cells that have a height.
    std::vector<std::size_t> occupied() const;
};

/// Chen & Wei, eq. 19: spheres of radius R no farther apart leave of a cylinder's side no more than a tolerance.
double sphere_spacing(double radius, double tolerance);
/// Eq. 20: of spheres along a length. Published: rounded to the nearest number, and none where the length is small.
int sphere_count(double length, double spacing, Formulas formulas);
/// The spheres of a cylinder, at (i + 1/2) L / k.
std::vector<solid::Sphere> sphere_row(const solid::Cylinder& cylinder, double tolerance, Formulas formulas);

} // namespace fettle
