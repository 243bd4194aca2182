#pragma once

#include "robot/externals.h"
#include "robot/height_grid.h"
#include "robot/robot.h"
#include "robot/workpiece.h"

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace fettle {

/// The tool's axes along a path, from tip to holder.
std::vector<Eigen::Vector3d> tool_directions(const PosePath& poses);

struct HeterogeneousOptions {
    double cell = 1;                     ///< side of the grids' cells, mm
    Formulas formulas = Formulas::right; ///< published: cylinders are rows of spheres against triangles
    double tolerance = 0.01;             ///< that these may leave, mm (Chen & Wei, eq. 19)
};

/// Where a tool stands over a grid: its cells count by their triangles, all others by their cuboids.
struct ToolZone {
    std::size_t grid = 0;
    std::vector<char> cells; ///< of the grid: 1 for those that the tool projects to
};

/// A workpiece as Chen & Wei's heterogeneous resolution (section 4): triangles where the tool projects to, cuboids
/// elsewhere. Their grids stand across the tool's directions: one more wherever the path turns too far from those there
/// are.
class Heterogeneous {
  public:
    /// @param workpiece  must outlive it
    /// @param ups  unit, from tip to holder, in the part's frame, along the path
    /// @throws InputError if there is none, if a grid would be too large, or for spheres without a tolerance
    Heterogeneous(const Workpiece& workpiece, std::span<const Eigen::Vector3d> ups,
                  const HeterogeneousOptions& options = {});

    /// @param T_part_tool  of the path's tool frame
    ToolZone zone(const Robot& robot, const Eigen::Isometry3d& T_part_tool) const;
    /// As Workpiece::nearest(). By the right formulas it is never farther than that, and, where the surface can be seen
    /// along the tool, nearer by no more than accuracy(); in the zone it is the same.
    Workpiece::Nearest nearest(const Solid& solid, const Eigen::Isometry3d& T_part_body, const ToolZone& zone,
                               double beyond) const;

    /// What counts with the tool there, in the part's frame: to be drawn (Chen & Wei, figure 6).
    struct Parts {
        Mesh triangles; ///< of the workpiece
        Mesh cuboids;
    };
    Parts parts(const ToolZone& zone) const;

    std::size_t grids() const { return grids_.size(); }
    double cell() const { return options_.cell; }
    double accuracy() const; ///< the worst of all grids, mm

  private:
    struct Grid {
        HeightGrid heights;
        std::vector<std::size_t> occupied;
        std::unique_ptr<Mesh> cuboids;
        std::unique_ptr<Workpiece> workpiece; ///< of the cuboids
        Eigen::Vector3d up;
    };
    Workpiece::Nearest to_triangles(const Solid& solid, const Eigen::Isometry3d& T_part_body, const ToolZone& zone,
                                    double beyond) const;

    const Workpiece& workpiece_;
    HeterogeneousOptions options_;
    std::vector<Grid> grids_;
};

} // namespace fettle
