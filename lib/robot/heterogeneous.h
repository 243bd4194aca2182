#pragma once

#include "robot/cuboid_search.h"
#include "robot/externals.h"
#include "robot/height_grid.h"
#include "robot/robot.h"
#include "robot/workpiece.h"

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace fettle::robot {

/// Directions of the tool's axis along a path, from tip to holder, unit, part frame; poses that are NaN are left out.
std::vector<Eigen::Vector3d> tool_axes(const cloud::PosePath& poses);

struct HeterogeneousOptions {
    double cell_size = 1; ///< side of the cells of the grids, mm
    Formulas formulas =
        Formulas::corrected; ///< published: against triangles, cylinders are replaced by rows of spheres
    double tolerance = 0.01; ///< largest depth of the cylinder that the spheres leave out, mm (eq. 19)
};

/// The cells of a grid that the tool projects to. These are represented by their triangles, all others by cuboids.
struct ToolZone {
    std::size_t grid = 0;
    std::vector<char> cells;             ///< by cell of the grid: 1 if the tool projects to it
    std::vector<Footprint> footprints{}; ///< of the tool's bodies; all cells that they touch are among these
};

/// A workpiece by Chen & Wei's heterogeneous resolution (section 4): triangles where the tool projects to, cuboids
/// elsewhere. The grids are perpendicular to directions of the tool's axis; a path that turns farther has several.
class HeterogeneousModel {
  public:
    /// @param workpiece  must outlive it
    /// @param axes  of the tool along the path, see tool_axes()
    /// @throws InputError if there is no axis, if a grid would be too large, or for spheres without a tolerance
    HeterogeneousModel(const Workpiece& workpiece, std::span<const Eigen::Vector3d> axes,
                       const HeterogeneousOptions& options = {});

    /// The cells that the tool's bodies project to, in the grid whose normal is nearest to the tool's axis.
    ToolZone tool_zone(const Robot& robot, const Eigen::Isometry3d& T_part_tool) const;
    /// Minimum signed distance of the model from a body, see Workpiece::nearest(). With the corrected formulas it is
    /// never larger than that, and, where the surface is visible along the tool's axis, smaller by no more than
    /// accuracy(). In the zone it is the same. The depth in a cuboid is the shortest shift that leaves it.
    Workpiece::Nearest nearest(const Solid& solid, const Eigen::Isometry3d& T_part_body, const ToolZone& zone,
                               double max_distance) const;

    /// The geometry that represents the workpiece for a zone, in the part's frame, for drawing (Chen & Wei, figure 6).
    struct Geometry {
        mesh::Mesh triangles; ///< of the workpiece
        mesh::Mesh cuboids;
    };
    Geometry geometry(const ToolZone& zone) const;

    std::size_t grid_count() const { return grids_.size(); }
    double cell_size() const { return options_.cell_size; } ///< mm
    double accuracy() const;                                ///< the largest HeightGrid::accuracy, mm

  private:
    struct Grid {
        std::unique_ptr<HeightGrid> heights;
        std::unique_ptr<CuboidSearch> cuboids;
        Eigen::Vector3d normal; ///< unit, part frame
    };
    static bool touches_zone(const Grid& grid, std::size_t triangle, const ToolZone& zone);
    Workpiece::Nearest nearest_triangle(const Solid& solid, const Eigen::Isometry3d& T_part_body, const ToolZone& zone,
                                        double max_distance) const;

    const Workpiece& workpiece_;
    HeterogeneousOptions options_;
    std::vector<Grid> grids_;
};

} // namespace fettle::robot
