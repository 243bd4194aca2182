#pragma once

#include "core/constants.h"
#include "robot/arm.h"
#include "robot/externals.h"
#include "robot/heterogeneous.h"
#include "robot/mesh_clearance.h"
#include "robot/robot.h"
#include "robot/workpiece.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace fettle::robot {

/// Two bodies of a cell whose clearance is checked, by their index in Robot::bodies. `b` may be bodies.size(), the
/// workpiece.
struct CellPair {
    std::size_t a, b;
    double margin = 0; ///< required minimum distance, mm
};

/// All pairs except those of bodies on one link or on neighbouring links, those that never move against each other, and
/// those that the robot file allows to touch. The workpiece is on workpiece_link().
std::vector<CellPair> checked_pairs(const Robot& robot);

/// The link that carries the workpiece: the tool, if the robot holds it; else the table, or the cell if there is none.
int workpiece_link(const Robot& robot);

struct CollisionOptions {
    /// An overlap no deeper is a contact and no collision, mm (Chen & Wei: the accuracy of machining).
    double tolerance = 0.01;
    /// Larger clearances are reported as this one, mm.
    double max_clearance = 50;
    /// Largest relative motion of two bodies between checked configurations where it decides about a collision, mm.
    double resolution = 0.1;
    /// Model that replaces the triangles of the workpiece; nullptr: all triangles count.
    const HeterogeneousModel* model = nullptr;
};

/// A clearance in a cell with the pair that it belongs to. Its margin is subtracted.
struct CellClearance {
    double clearance = core::kNaN;                                 ///< mm; NaN: not measured
    std::size_t pair = 0;                                          ///< index in checked_pairs()
    Eigen::Vector3d point = Eigen::Vector3d::Constant(core::kNaN); ///< on body a, cell frame, mm
};

/// The frame of each link in the cell frame, by link + 1 (robot.h: cell, base, 1 to 6, tool, table).
std::array<Eigen::Isometry3d, 10> link_frames(const Robot& robot, const Arm& arm, const CellJoints& joints);

/// The part's frame in the cell frame. @param frames  link_frames()
Eigen::Isometry3d workpiece_frame(const Robot& robot, const std::array<Eigen::Isometry3d, 10>& frames);

/// The placements of all bodies for some joints, and the clearances measured there.
struct CellState {
    std::vector<Eigen::Isometry3d> T_cell_body; ///< by body; the workpiece's is the last one
    std::vector<CellClearance> clearances;      ///< by pair; NaN until measured
    std::vector<LeafPair> start_leaves;         ///< by pair: where the search in the trees of meshes starts
    ToolZone tool_zone;                         ///< only with CollisionOptions::model
};

/// The robot's bodies and the workpiece for distance queries with any joints. Thread-safe.
class Cell {
  public:
    /// Robot, workpiece and model must outlive it. @param workpiece  nullptr: none
    Cell(const Robot& robot, const Workpiece* workpiece, const CollisionOptions& options);

    const CollisionOptions& options() const { return options_; }
    const std::vector<CellPair>& pairs() const { return pairs_; }
    /// Indices of the pairs that exist: without a workpiece not all do.
    const std::vector<std::size_t>& active_pairs() const { return active_pairs_; }
    /// Number of bodies, including the workpiece if there is one.
    std::size_t body_count() const { return bounding_balls_.size(); }

    /// The placements of all bodies; no clearance is measured yet.
    CellState place_bodies(const CellJoints& joints) const;
    /// Reuses the memory of `state`; its clearances stay what they were until they are measured.
    void place_bodies(const CellJoints& joints, CellState& state) const;

    /// Measures the clearance of one pair into `state.pairs`, up to CollisionOptions::max_clearance.
    void measure_clearance(CellState& state, std::size_t pair) const
    {
        measure_clearance(state, pair, options_.max_clearance);
    }
    /// Measures it only up to `max_clearance`, mm. @return  a lower bound of the clearance, mm
    double measure_clearance(CellState& state, std::size_t pair, double max_clearance) const;
    /// Lower bound of a clearance, mm. For the workpiece from its tree in float alone: a third of the time of measuring
    /// it; it holds for a body that is known not to lie wholly inside. For two bodies of which one is a mesh, from
    /// their convex hulls. Other pairs, and a model of the workpiece, are measured.
    double bound_clearance(CellState& state, std::size_t pair, double max_clearance) const;
    /// Lower bound of a clearance from balls around the bodies and a box around the workpiece, mm. A positive one says
    /// that the body does not lie inside the workpiece.
    double ball_clearance(const CellState& state, std::size_t pair) const;
    /// Lower bound of a clearance from the body itself and the box around the workpiece, mm: tighter, at little cost.
    double rough_clearance(const CellState& state, std::size_t pair) const;
    bool is_of_workpiece(std::size_t pair) const { return pairs_[pair].b == robot_.bodies.size(); }
    /// Does every triangle of a body of the pair, or of the workpiece, count?
    bool has_mesh(std::size_t pair) const;

    /// Upper bound of the distance of a body's points in one state from where they are in another, mm.
    double displacement_bound(std::size_t body, const CellState& s0, const CellState& s1) const;
    /// Bound of what the paths of a body's points are longer than their chords, joints moving linearly, mm. With
    /// displacement_bound() it bounds how far they are at any time of a motion from where they were.
    /// @param change  of the joints during the motion
    double arc_excess(std::size_t body, const CellJoints& change) const;
    /// Upper bound of arc_excess() of all bodies, mm.
    double max_arc_excess(const CellJoints& change) const;
    /// Bound of how far a pair's bodies move against each other on such a motion, mm: with clearances c0 and c1 at its
    /// ends the clearance between is at least (c0 + c1 - bound) / 2. Of two bodies on the arm only the joints between
    /// them count, and each joint only with the part of the arm behind it.
    double relative_motion_bound(std::size_t pair, const CellJoints& q0, const CellState& s0, const CellJoints& q1,
                                 const CellState& s1) const;
    /// Lower bound of the clearance of a ball from the workpiece on a motion between two states, mm, from the capsule
    /// that it sweeps on a straight line: however near and long the motion is, one measurement bounds it.
    /// @param at_ends  the smaller of the clearances at the ends, mm: the result is less
    /// @return  nothing for other pairs, for a model of the workpiece, and while the table turns
    std::optional<double> swept_ball_clearance(std::size_t pair, const CellJoints& q0, const CellState& s0,
                                               const CellJoints& q1, const CellState& s1, double at_ends) const;

  private:
    /// A ball around a body, body frame, mm.
    struct BoundingBall {
        Eigen::Vector3d centre;
        double radius; ///< 0 for a sphere: a turn about its centre moves no part of its surface
        double extent; ///< distance of its farthest point from the frame's origin
        double size;   ///< `radius`, but of a sphere its radius
    };
    static BoundingBall bounding_ball(const Eigen::AlignedBox3d& box);
    static double displacement_bound(const BoundingBall& ball, const Eigen::Isometry3d& T0,
                                     const Eigen::Isometry3d& T1);
    int link_of(std::size_t body) const;
    const Workpiece* surface_of(std::size_t body) const;
    double hull_clearance(const CellState& state, std::size_t pair, double max_clearance) const;
    Clearance measure_in_cell(CellState& state, std::size_t pair, double max_clearance) const;
    Eigen::Array<double, 6, 1> axis_distances(std::size_t body) const;
    double arm_arc_excess(const CellJoints& change, double extent) const;
    double table_arc_excess(const CellJoints& change, double extent) const;
    double acceleration_bound(std::size_t body, const CellJoints& change, int first_joint) const;

    const Robot& robot_;
    const Workpiece* workpiece_;
    CollisionOptions options_;
    const Arm arm_;
    Solid workpiece_box_; ///< around the workpiece, part frame
    Eigen::AlignedBox3d workpiece_bounds_;
    double max_arm_extent_ = 0, max_table_extent_ = 0; ///< BoundingBall::extent of the bodies there, mm
    double reach_;                                     ///< length of the stretched chain of links, with the tool, mm
    std::vector<CellPair> pairs_;
    std::vector<std::size_t> active_pairs_;
    std::vector<BoundingBall> bounding_balls_;
    /// By body: bounds of the distances of its points from the axes of joints 1 to 6, mm; 0 where they do not move it.
    std::vector<Eigen::Array<double, 6, 1>> axis_distances_;
};

} // namespace fettle::robot
