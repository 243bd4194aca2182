#pragma once

#include "robot/arm.h"
#include "robot/cell.h"
#include "robot/solve_path.h"
#include "robot/tilt.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace fettle {

/// Changes of one pose that are known to collide.
class Blocked {
  public:
    /// The change was found to be `depth` mm deeper than allowed in a body whose points are up to `lever` mm from the
    /// pivot, both of them fixed to tool and part or cell: tilts within depth / lever of it are no better, as no point
    /// moves farther, and a retreat takes away at most its own length.
    void add(const PoseChange& change, double depth, double lever) { found_.push_back({change, depth, lever}); }

    bool holds(const PoseChange& change) const
    {
        for (const Found& f : found_)
            if ((change.tilt - f.change.tilt).norm() * f.lever + std::abs(change.retreat - f.change.retreat) < f.depth)
                return true;
        return false;
    }

  private:
    struct Found {
        PoseChange change;
        double depth, lever;
    };
    std::vector<Found> found_;
};

/// Tries changes of poses of a path. Thread-safe.
class Trials {
  public:
    /// All must outlive it.
    /// @param away  3xN, unit, part frame: where a retreat leads
    Trials(const Robot& robot, const Workpiece* workpiece, const CollisionOptions& options, const SolvedPath& solved,
           const Eigen::Matrix3Xd& away);

    Eigen::Isometry3d pose(Eigen::Index i, const PoseChange& change) const;

    /// Joints of a changed pose that lie nearest to others; NaN if none are in range.
    CellJoints joints(Eigen::Index i, const PoseChange& change, const CellJoints& near) const;

    /// Is the changed pose reached with joints near to others, and clear?
    /// @param blocked  what is learnt is added
    /// @return  the joints; NaN: no
    CellJoints look(Eigen::Index i, const PoseChange& change, const CellJoints& near, Blocked& blocked) const;

    /// Joints of the path, or of the pose before that has any; else 0.
    CellJoints near(Eigen::Index i) const;

  private:
    bool clear_of_arm(const CellJoints& joints) const;

    const Robot& robot_;
    const SolvedPath& solved_;
    const Eigen::Matrix3Xd& away_;
    CollisionOptions options_;
    Cell cell_;
    Arm arm_;
    double pivot_;
    std::vector<std::size_t> of_tool_, of_arm_; ///< pairs whose clearance the pose alone tells, and the others
    std::vector<double> lever_;                 ///< of the bodies
};

} // namespace fettle
