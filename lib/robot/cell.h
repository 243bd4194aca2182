#pragma once

#include "core/constants.h"
#include "robot/arm.h"
#include "robot/externals.h"
#include "robot/heterogeneous.h"
#include "robot/robot.h"
#include "robot/workpiece.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
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
    /// What goes no deeper is a contact, no collision, mm (Chen & Wei: the accuracy of machining).
    double tolerance = 0.01;
    /// Clearances are told up to here, mm.
    double beyond = 50;
    /// Between poses the bodies move no farther from one look to the next, mm, where it matters.
    double resolution = 0.1;
    /// How the workpiece is seen; else by all of its triangles.
    const Heterogeneous* model = nullptr;
};

/// The least clearance of a cell, its margin taken off.
struct CellClearance {
    double clearance = kNaN;                                 ///< mm; NaN: not looked at
    std::size_t pair = 0;                                    ///< of checked_pairs()
    Eigen::Vector3d point = Eigen::Vector3d::Constant(kNaN); ///< on body a, cell frame
};

/// Where the frame of each link stands, by link + 1 (robot.h: cell, base, 1 to 6, tool, table).
std::array<Eigen::Isometry3d, 10> link_frames(const Robot& robot, const Arm& arm, const CellJoints& joints);

/// A cell as it stands with given joints.
struct Stance {
    std::vector<Eigen::Isometry3d> T_cell_body; ///< the workpiece's after the bodies'
    std::vector<CellClearance> pairs;           ///< those that were asked for
    std::vector<std::uint32_t> leaf;            ///< of the pairs: where in the workpiece to begin
    ToolZone zone;                              ///< if the workpiece is seen by a model
};

/// A robot's bodies and the workpiece, to be looked at with any joints. Thread-safe.
class Cell {
  public:
    /// Robot, workpiece and model must outlive it. @param workpiece  nullptr: none
    Cell(const Robot& robot, const Workpiece* workpiece, const CollisionOptions& options);

    const CollisionOptions& options() const { return options_; }
    const std::vector<CellPair>& pairs() const { return pairs_; }
    /// Numbers of the pairs: without a workpiece not all.
    const std::vector<std::size_t>& looked_at() const { return looked_at_; }
    /// How many: the workpiece is the last one, if there is one.
    std::size_t bodies() const { return around_.size(); }

    /// Nothing is looked at yet.
    Stance stand(const CellJoints& joints) const;
    /// The same, where there is room already.
    void stand(const CellJoints& joints, Stance& stance) const;

    /// Looks at one pair.
    void look(Stance& stance, std::size_t pair) const { look(stance, pair, options_.beyond); }
    /// The same, but clearances from `beyond` on need not be told apart. @return  a lower bound of the clearance
    double look(Stance& stance, std::size_t pair, double beyond) const;

    /// No point of the body is farther from where it was.
    double chord(std::size_t body, const Stance& s0, const Stance& s1) const;
    /// No point of the body moves farther on the way between two stances, joints moving evenly.
    double motion(std::size_t body, const CellJoints& q0, const Stance& s0, const CellJoints& q1,
                  const Stance& s1) const;

  private:
    /// A ball around a body, in its own frame. One about the centre of a ball turns in its place.
    struct Around {
        Eigen::Vector3d centre;
        double radius; ///< 0 of a ball
        double extent; ///< from the frame's origin
    };
    static Around around(const Eigen::AlignedBox3d& box);

    const Robot& robot_;
    const Workpiece* workpiece_;
    CollisionOptions options_;
    const Arm arm_;
    double reach_; ///< of the links, joint by joint, and the tool
    std::vector<CellPair> pairs_;
    std::vector<std::size_t> looked_at_;
    std::vector<Around> around_;
};

} // namespace fettle
