#pragma once

#include "carrier/arm_follower.h"
#include "cloud/cloud.h"
#include "gantry/virtual_gantry.h"
#include "plan/plan.h"
#include "robot/robot.h"

#include <Eigen/Geometry>

#include <memory>
#include <optional>
#include <vector>

namespace fettle::carrier {

/// A simulated robot that carries the head of a gantry: each straight move of the tool point is one of the arm, within
/// its reach and its joints' ranges, on one branch of its inverse kinematics, and no faster than its joints. The head,
/// its spring and the stock under the wheel are those of a simulated gantry.
///
/// Nothing moves before set_frame() has said where the job lies; that is refused unless all of the plan is reached.
class RobotGantry final : public gantry::Gantry {
  public:
    /// @param robot, plan  must outlive it; the robot does not hold the part   @param head  in the plan's job
    /// @throws InputError as robot::check_arguments(), lengths in mm
    RobotGantry(const robot::Robot& robot, const robot::PathArguments& arguments, const plan::Plan& plan,
                std::unique_ptr<gantry::VirtualGantry> head);

    void set_frame(const Eigen::Isometry3d& T_cell_job) override;
    gantry::GantryStatus travel(const Eigen::Vector3d& tool_point) override;
    gantry::GantryStatus travel_low(const Eigen::Vector3d& tool_point, double over, double free) override;
    gantry::GantryStatus grind(const Eigen::Vector3d& tool_point, double feed) override;
    gantry::GantryStatus lift(double commanded_z) override;
    double touch_off() override;
    void change_wheel() override;
    double probe(const Eigen::Vector2d& xy, double lowest) override;
    void turn_to(double theta) override;
    gantry::GantryStatus status() const override;

    /// Box around all that any job could ask for, and the highest speed of the tip.
    gantry::protocol::Limits limits() const;
    const gantry::VirtualGantry& head() const { return *head_; }
    const std::optional<ArmFollower>& arm() const { return arm_; }

    /// Where the robot was: pose of the tool by the drives, joints, and the time at which it came there.
    struct Moment {
        double time; ///< s
        Eigen::Isometry3d pose;
        robot::CellJoints joints;
        cloud::Motion motion;
    };
    const std::vector<Moment>& moments() const { return moments_; }

  private:
    /// A straight line of the tool point.
    struct Leg {
        Eigen::Vector3d to;
        cloud::Motion motion;
    };
    /// A point of a way, with the shortest time that the joints need to it.
    struct Step {
        Eigen::Vector3d at;
        robot::CellJoints joints;
        double length, min_duration; ///< from the step before, mm, s
        cloud::Motion motion;
    };
    std::vector<Leg> way_over(const Eigen::Vector3d& tool_point, double height) const;
    std::vector<Leg> way_up() const;
    std::vector<Step> steps_of(const std::vector<Leg>& legs) const;
    template <class Move>
    void carry(const std::vector<Leg>& legs, const Move& move);
    void record(const std::vector<Step>& steps, double begin, double duration);
    Eigen::Vector3d at() const { return head_->status().commanded; }
    double safe_height() const { return plan_.job.safe_height; }
    const ArmFollower& arm_or_fault() const;

    const robot::Robot& robot_;
    robot::PathArguments arguments_;
    const plan::Plan& plan_;
    std::unique_ptr<gantry::VirtualGantry> head_;
    std::optional<ArmFollower> arm_; ///< nothing before set_frame()
    robot::CellJoints joints_;
    Eigen::Vector3d recorded_; ///< tool point of the last moment
    double delay_ = 0;         ///< by which the joints are slower than the head's drives would be, s
    std::vector<Moment> moments_;
};

/// The path of a robot: poses in the cell with the table at 0, joints, time `t` and `motion`; fettle-collide reads it.
cloud::Cloud to_cloud(const robot::Robot& robot, const std::vector<RobotGantry::Moment>& moments);

} // namespace fettle::carrier
