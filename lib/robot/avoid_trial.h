#pragma once

#include "robot/arm.h"
#include "robot/cell.h"
#include "robot/solve_path.h"
#include "robot/tilt.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace fettle::robot {

/// A set of changes of one pose that are known to collide.
class CollidingChanges {
  public:
    /// Adds a change and all others that must collide, too.
    /// @param depth  penetration of two bodies beyond the tolerance, mm; one is fixed to the tool, the other to the
    /// part
    ///               or the cell
    /// @param lever  distance of the tool body's farthest point from the pivot, mm: with a tilt that differs by an
    /// angle
    ///               no point moves farther than lever · angle, and with another retreat no farther than the difference
    void add(const PoseChange& change, double depth, double lever) { colliding_.push_back({change, depth, lever}); }

    bool contains(const PoseChange& change) const
    {
        return std::ranges::any_of(colliding_, [&](const Colliding& c) {
            return (change.tilt - c.change.tilt).norm() * c.lever + std::abs(change.retreat - c.change.retreat) <
                   c.depth;
        });
    }

  private:
    struct Colliding {
        PoseChange change;
        double depth, lever;
    };
    std::vector<Colliding> colliding_;
};

/// Checks changes of a path's poses for reach and collisions. Thread-safe.
class ChangeChecker {
  public:
    /// All arguments must outlive it.
    /// @param retreat_directions  3xN, unit, part frame
    ChangeChecker(const Robot& robot, const Workpiece* workpiece, const CollisionOptions& options,
                  const SolvedPath& solved, const Eigen::Matrix3Xd& retreat_directions);

    /// T_part_tool of the changed pose i.
    Eigen::Isometry3d tool_pose(Eigen::Index i, const PoseChange& change) const;

    /// The joints of a changed pose nearest to `seed`; NaN if no solution is in range.
    CellJoints nearest_joints(Eigen::Index i, const PoseChange& change, const CellJoints& seed) const;

    /// The joints of a changed pose nearest to `seed`, if they are free of collisions; else NaN.
    /// @param blocked  output: if the tool collides, the change is added
    CellJoints find_clear_joints(Eigen::Index i, const PoseChange& change, const CellJoints& seed,
                                 CollidingChanges& blocked) const;

    /// The joints of the unchanged pose i, or of the last pose before it that is reached; else 0.
    CellJoints seed_joints(Eigen::Index i) const;

  private:
    bool arm_is_clear(const CellJoints& joints) const;

    const Robot& robot_;
    const SolvedPath& solved_;
    const Eigen::Matrix3Xd& retreat_directions_;
    CollisionOptions options_;
    Cell cell_;
    Arm arm_;
    double pivot_;
    std::vector<std::size_t> tool_pairs_; ///< pairs whose clearance depends on the pose alone, not on the arm's joints
    std::vector<std::size_t> arm_pairs_;  ///< the other pairs
    std::vector<double> levers_;          ///< by body, see CollidingChanges::add()
};

} // namespace fettle::robot
