#pragma once

#include "robot/arm.h"
#include "robot/externals.h"
#include "robot/robot.h"
#include "robot/workpiece.h"

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <vector>

namespace fettle {

/// Two bodies of a cell that are held against each other; `b` is the robot's number of bodies for the workpiece.
struct CellPair {
    std::size_t a, b;
    double margin = 0; ///< they must stay that far apart, mm
};

/// All pairs but those of bodies on one link or on neighbouring links, that never move against each other, or that the
/// robot file allows. The workpiece lies on the table, or in the cell if there is none.
std::vector<CellPair> checked_pairs(const Robot& robot);

struct CollisionOptions {
    double tolerance =
        0.01;           ///< what goes no deeper is a contact, no collision, mm (Chen & Wei: the accuracy of machining)
    double beyond = 50; ///< clearances are told up to here, mm
    double resolution =
        0.1; ///< between poses the bodies move no farther from one look to the next, mm, where it matters
};

/// The least clearance of a cell, its margin taken off.
struct CellClearance {
    double clearance = std::numeric_limits<double>::quiet_NaN(); ///< mm; NaN: not looked at
    std::size_t pair = 0;                                        ///< of checked_pairs()
    Eigen::Vector3d point =
        Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()); ///< on body a, cell frame
};

/// Where the frame of each link stands, by link + 1 (robot.h: cell, base, 1 to 6, tool, table).
std::vector<Eigen::Isometry3d> link_frames(const Robot& robot, const CellJoints& joints);

/// A cell as it stands with given joints.
struct Stance {
    std::vector<Eigen::Isometry3d> T_cell_body; ///< the workpiece's after the bodies'
    std::vector<CellClearance> pairs;           ///< those that were asked for
};

/// Of all pairs that were looked at.
CellClearance least_of(const Stance& stance);

/// A robot's bodies and the workpiece, to be looked at with any joints. Thread-safe.
class Cell {
  public:
    /// All three must outlive it. @param workpiece  nullptr: none
    Cell(const Robot& robot, const Workpiece* workpiece, const CollisionOptions& options);

    const std::vector<CellPair>& pairs() const { return pairs_; }
    /// Numbers of the pairs: without a workpiece not all.
    const std::vector<std::size_t>& looked_at() const { return looked_at_; }

    /// Nothing is looked at yet.
    Stance stand(const CellJoints& joints) const;
    /// Looks at one pair.
    void look(Stance& stance, std::size_t pair) const;
    Stance look_at_all(const CellJoints& joints) const;

    /// The least clearance on the way between two stances, joints moving evenly, for the pairs of `some`: see
    /// check_path(). @param looks  is counted up
    CellClearance between(const CellJoints& q0, const Stance& s0, const CellJoints& q1, const Stance& s1,
                          const std::vector<std::size_t>& some, std::size_t& looks) const
    {
        return between(q0, s0, q1, s1, some, 0, looks);
    }

  private:
    CellClearance between(const CellJoints& q0, const Stance& s0, const CellJoints& q1, const Stance& s1,
                          const std::vector<std::size_t>& some, int halvings, std::size_t& looks) const;
    double motion(std::size_t body, const CellJoints& q0, const Stance& s0, const CellJoints& q1,
                  const Stance& s1) const;

    const Robot& robot_;
    const Workpiece* workpiece_;
    const CollisionOptions& options_;
    std::vector<CellPair> pairs_;
    std::vector<std::size_t> looked_at_;
    std::vector<Eigen::Matrix3Xd> corners_; ///< of boxes around the bodies, in their own frames
};

} // namespace fettle
