#include "robot/urdf_model.h"

#include "core/constants.h"
#include "core/error.h"
#include "core/text.h"
#include "robot/arm.h"
#include "robot/body_json.h"
#include "robot/dh_from_axes.h"
#include "robot/mesh_body.h"
#include "robot/srdf.h"
#include "robot/urdf_shapes.h"

#include <urdf_model/model.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

namespace fettle::robot {

namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

// A joint without limits that turns for ever, degrees either way: what cables stand.
constexpr double kContinuousDegrees = 360;
// Shapes of a robot or its cell are smaller, mm: the largest arms reach 4.7 m, a mesh in mm taken as m is 1000 times as
// large as it should be.
constexpr double kMaxLinkSize = 3e4;

// Diagonal of the bounding box of a mesh, mm; 0 of other solids, whose lengths the URDF itself states.
double mesh_size(const Solid& solid)
{
    const auto diagonal = [](const Eigen::Matrix3Xd& points) {
        return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
    };
    if (const auto* hull = std::get_if<solid::Hull>(&solid)) return diagonal(hull->points);
    const auto* triangles = std::get_if<solid::Triangles>(&solid);
    return triangles != nullptr ? diagonal(triangles->body->hull) : 0;
}

std::string of_joint(const urdf::Joint& joint) { return "joint '" + joint.name + "': "; }

bool moves(const urdf::Joint& joint) { return joint.type != urdf::Joint::FIXED; }

class UrdfReader {
  public:
    UrdfReader(const urdf::ModelInterface& model, std::string source, const UrdfOptions& options)
        : model_(model), source_(std::move(source)), options_(options)
    {
    }

    Robot read()
    {
        check_tree();
        find_chain();
        read_kinematics();
        read_controller_frames();
        for (const auto& [name, link] : model_.links_) read_bodies(*link);
        if (!options_.srdf.empty()) read_srdf(options_.srdf, links_of_bodies_, robot_);
        return std::move(robot_);
    }

  private:
    // Every link but the root hangs on it: liburdfdom sees a second root, but no loop apart from the root, and of two
    // joints that carry one link it takes the last by name.
    void check_tree() const
    {
        std::map<std::string, std::string> carriers;
        for (const auto& [name, joint] : model_.joints_)
            if (const auto [other, is_first] = carriers.emplace(joint->child_link_name, name); !is_first)
                throw core::InputError("link '" + joint->child_link_name + "' hangs on two joints, '" + other->second +
                                       "' and '" + name + "'");
        for (const auto& [name, link] : model_.links_) {
            const urdf::Link* at = link.get();
            for (std::size_t steps = 0; at->getParent() != nullptr; at = at->getParent().get())
                if (++steps > model_.links_.size()) throw core::InputError("link '" + name + "' is part of a loop");
        }
    }

    const urdf::Link& find_tip() const
    {
        const std::string wanted = options_.tip.empty() ? "tool0" : options_.tip;
        if (const auto found = model_.links_.find(wanted); found != model_.links_.end()) return *found->second;
        if (!options_.tip.empty()) throw core::InputError("--tip: no link is called '" + options_.tip + "'");
        // The link with the most moving joints before it, of equal ones the last by name.
        const urdf::Link* tip = nullptr;
        std::size_t most = 0;
        for (const auto& [name, link] : model_.links_) {
            std::size_t count = 0;
            for (const urdf::Link* at = link.get(); at->parent_joint != nullptr; at = at->getParent().get())
                count += moves(*at->parent_joint) ? 1 : 0;
            if (tip == nullptr || count >= most) {
                tip = link.get();
                most = count;
            }
        }
        return *tip;
    }

    // The moving joints from the root to the tip.
    void find_chain()
    {
        tip_ = &find_tip();
        for (const urdf::Link* at = tip_; at->parent_joint != nullptr; at = at->getParent().get())
            if (moves(*at->parent_joint)) chain_.insert(chain_.begin(), at->parent_joint.get());
        const bool has_track = chain_.size() == 7 && chain_[0]->type == urdf::Joint::PRISMATIC;
        if (has_track) track_ = chain_[0];
        const auto arm = chain_.begin() + (has_track ? 1 : 0);
        for (auto joint = arm; joint != chain_.end(); ++joint) {
            const auto type = (*joint)->type;
            if (type != urdf::Joint::REVOLUTE && type != urdf::Joint::CONTINUOUS)
                throw core::InputError(of_joint(**joint) + "neither turns nor is fixed, and is not the first of seven");
            if ((*joint)->mimic != nullptr)
                throw core::InputError(of_joint(**joint) + "mimics '" + (*joint)->mimic->joint_name +
                                       "': a joint of the arm must move by itself");
        }
        if (chain_.end() - arm != 6)
            throw core::InputError("from the root '" + model_.getRoot()->name + "' to '" + tip_->name + "' " +
                                   std::to_string(chain_.end() - arm) + " joints turn, expected 6");
        arm_.assign(arm, chain_.end());
        for (const auto& [name, joint] : model_.joints_)
            if (joint->mimic != nullptr)
                robot_.notes.push_back("joint '" + name + "' mimics '" + joint->mimic->joint_name +
                                       "': it stays where it is at 0");
    }

    Vector3d direction_of(const urdf::Joint& joint, const Isometry3d& T_root_joint) const
    {
        const Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
        if (!(axis.norm() > 0) || !axis.allFinite()) throw core::InputError(of_joint(joint) + "its axis is 0");
        return T_root_joint.linear() * axis.normalized();
    }

    void read_kinematics()
    {
        std::array<JointAxis, 6> axes;
        for (std::size_t k = 0; k < 6; ++k) {
            const Isometry3d T = place(*model_.getLink(arm_[k]->child_link_name));
            axes[k] = {T.translation(), direction_of(*arm_[k], T)};
        }
        const DhFromAxes table = dh_from_axes(axes);
        robot_.dh = table.dh;
        robot_.arm_kind = table.kind;
        robot_.T_cell_base = table.T_base_0;
        if (table.kind == ArmKind::general)
            robot_.notes.push_back(
                "the arm has neither a spherical wrist nor parallel axes 2 to 4: its joints are found "
                "numerically, and branches may be missing");
        for (std::size_t k = 0; k < 6; ++k) read_limits(*arm_[k], robot_.dh[k]);
        if (track_ != nullptr) read_track();
        frames_ = Arm(robot_).frames(Joints::Zero());
        const Eigen::AngleAxisd half_turn(std::numbers::pi, Vector3d::UnitX());
        robot_.T_flange_tool = (robot_.T_cell_base * frames_[6]).inverse() * place(*tip_) * half_turn;
    }

    void read_limits(const urdf::Joint& joint, DhRow& row) const
    {
        row.range = {-kContinuousDegrees * core::kRadPerDegree, kContinuousDegrees * core::kRadPerDegree};
        if (joint.limits == nullptr) return; // it is continuous: of all others liburdfdom demands them
        if (joint.type == urdf::Joint::REVOLUTE) row.range = {joint.limits->lower, joint.limits->upper};
        const double max = kMaxJointDegrees * core::kRadPerDegree;
        if (!(row.range.min < row.range.max) || row.range.min < -max || row.range.max > max)
            throw core::InputError(of_joint(joint) + "its limits, " + core::to_short_text(joint.limits->lower) +
                                   " and " + core::to_short_text(joint.limits->upper) + " rad, are no range within " +
                                   core::to_short_text(kMaxJointDegrees) + " degrees");
        if (joint.limits->velocity > 0) row.max_speed = joint.limits->velocity;
    }

    void read_track()
    {
        const Isometry3d T = place(*model_.getLink(track_->child_link_name));
        const JointRange range = {track_->limits->lower * kMmPerMetre, track_->limits->upper * kMmPerMetre};
        if (!(range.min <= range.max) || std::max(std::abs(range.min), std::abs(range.max)) > kMaxLength)
            throw core::InputError(of_joint(*track_) + "its limits are no range within 100 m");
        robot_.track = Track{direction_of(*track_, T), range, std::nullopt};
        if (track_->limits->velocity > 0) robot_.track->max_speed = track_->limits->velocity * kMmPerMetre;
    }

    // T_root_link with all joints at 0.
    Isometry3d place(const urdf::Link& link) const
    {
        Isometry3d T = Isometry3d::Identity();
        for (const urdf::Link* at = &link; at->parent_joint != nullptr; at = at->getParent().get())
            T = urdf_isometry(at->parent_joint->parent_to_joint_origin_transform) * T;
        return T;
    }

    // The index of the frame that a link moves with (robot.h, link).
    int moving_link(const urdf::Link& link) const
    {
        for (const urdf::Link* at = &link; at->parent_joint != nullptr; at = at->getParent().get()) {
            const auto found = std::ranges::find(arm_, at->parent_joint.get());
            if (found != arm_.end()) return static_cast<int>(found - arm_.begin()) + 1;
            if (at->parent_joint.get() == track_) return link::kBase;
        }
        // Fixed to the root: of the robot, if that does not move.
        return track_ != nullptr ? link::kCell : link::kBase;
    }

    // REP 199: the frames of the controller are the links base and tool0. Those of the table are not, where joint 1
    // turns about an axis that points down (KUKA), where the robot is built in turned by half a turn (Universal
    // Robots), and behind the wrist.
    void read_controller_frames()
    {
        const urdf::Link *base = model_.getLink("base").get(), *flange = model_.getLink("tool0").get();
        const auto must = [&](bool is_there, const std::string& what) {
            if (!is_there && robot_.no_controller.empty()) robot_.no_controller = what;
        };
        must(base != nullptr, "no link is called base, the frame that the controller counts from (REP 199)");
        must(flange != nullptr, "no link is called tool0, the frame that the controller counts tools from (REP 199)");
        if (!robot_.no_controller.empty()) return;
        must(moving_link(*base) <= link::kBase, "the link base moves with the arm");
        must(moving_link(*flange) == 6, "the link tool0 is not behind joint 6");
        robot_.controller = {robot_.T_cell_base.inverse() * place(*base),
                             (robot_.T_cell_base * frames_[6]).inverse() * place(*flange)};
    }

    void read_bodies(const urdf::Link& link)
    {
        const int index = moving_link(link);
        const Isometry3d T_root_frame =
            index == link::kCell ? Isometry3d::Identity() : robot_.T_cell_base * frames_[index];
        const UrdfFiles files{source_, link.name, options_.packages, options_.exact_meshes};
        std::size_t count = 0;
        for (const auto& collision : link.collision_array) {
            const Isometry3d T = T_root_frame.inverse() * place(link) * urdf_isometry(collision->origin);
            const std::string name = link.name + (count == 0 ? "" : " " + std::to_string(count + 1));
            ++count;
            if (name == kWorkpieceName) throw core::InputError("link 'workpiece': the name is that of the part");
            links_of_bodies_.push_back(link.name);
            robot_.bodies.push_back({name, index, urdf_solid(*collision->geometry, T, files)});
            const double size = mesh_size(robot_.bodies.back().solid);
            if (size > kMaxLinkSize)
                robot_.notes.push_back("link '" + link.name + "': its mesh is " +
                                       core::to_short_text(size / kMmPerMetre) +
                                       " m long: is it in mm, and its scale missing?");
        }
    }

    const urdf::ModelInterface& model_;
    std::string source_;
    const UrdfOptions& options_;
    Robot robot_;
    const urdf::Link* tip_ = nullptr;
    std::vector<const urdf::Joint*> chain_, arm_;
    const urdf::Joint* track_ = nullptr;
    std::array<Isometry3d, 7> frames_;         ///< of the Denavit-Hartenberg table, all joints at 0
    std::vector<std::string> links_of_bodies_; ///< by body
};

} // namespace

Robot make_robot(const urdf::ModelInterface& model, const std::string& source, const UrdfOptions& options)
{
    return UrdfReader(model, source, options).read();
}

} // namespace fettle::robot
