#include "robot/cell.h"

#include "geometry/bounding_box.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

namespace fettle::robot {

namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

// Can bodies on these two links never collide: do the links not move against each other, or are they neighbours?
bool never_collide(const Robot& robot, int a, int b)
{
    const auto is_fixed = [&](int on) { return on == link::kCell || (on == link::kBase && !robot.track); };
    if (a == b || (is_fixed(a) && is_fixed(b))) return true;
    return link::is_on_arm(a) && link::is_on_arm(b) && std::abs(a - b) == 1;
}

double margin_of(const Robot& robot, const BodyPair& pair)
{
    const auto found = std::ranges::find(robot.margins, pair, &Robot::Margin::pair);
    return found == robot.margins.end() ? 0 : found->distance;
}

} // namespace

int workpiece_link(const Robot& robot)
{
    if (robot.holds_workpiece) return link::kTool;
    return robot.table ? link::kTable : link::kCell;
}

Isometry3d workpiece_frame(const Robot& robot, const std::array<Isometry3d, 10>& frames)
{
    const Eigen::AngleAxisd half_turn(std::numbers::pi, Vector3d::UnitX());
    return robot.holds_workpiece ? Isometry3d(frames[link::kTool + 1] * half_turn) : frames[link::kTable + 1];
}

std::vector<CellPair> checked_pairs(const Robot& robot)
{
    std::vector<CellPair> pairs;
    const std::size_t count = robot.bodies.size();
    for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = a + 1; b <= count; ++b) {
            const int link_b = b == count ? workpiece_link(robot) : robot.bodies[b].link;
            const BodyPair pair(a, b);
            const bool allowed = std::ranges::find(robot.allowed, pair) != robot.allowed.end();
            if (!allowed && !never_collide(robot, robot.bodies[a].link, link_b))
                pairs.push_back({a, b, margin_of(robot, pair)});
        }
    return pairs;
}

std::array<Isometry3d, 10> link_frames(const Robot& robot, const Arm& arm, const CellJoints& joints)
{
    std::array<Isometry3d, 10> frames;
    frames[0].setIdentity();
    const Isometry3d base = base_in_cell(robot, joints[6]);
    const std::array<Isometry3d, 7> links = arm.frames(joints.head<6>());
    for (std::size_t k = 0; k < links.size(); ++k) frames[k + 1] = base * links[k];
    frames[8] = frames[7] * robot.T_flange_tool;
    frames[9] = part_in_cell(robot, joints[7]);
    return frames;
}

Cell::BoundingBall Cell::bounding_ball(const Eigen::AlignedBox3d& box)
{
    const Vector3d farthest = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs());
    const double radius = box.diagonal().norm() / 2;
    return {box.center(), radius, farthest.norm(), radius};
}

Cell::Cell(const Robot& robot, const Workpiece* workpiece, const CollisionOptions& options)
    : robot_(robot), workpiece_(workpiece), options_(options), arm_(robot),
      reach_(robot.T_flange_tool.translation().norm()), pairs_(checked_pairs(robot))
{
    for (const DhRow& row : robot.dh) reach_ += std::abs(row.a) + std::abs(row.d);
    for (std::size_t i = 0; i < pairs_.size(); ++i)
        if (workpiece != nullptr || pairs_[i].b < robot.bodies.size()) active_pairs_.push_back(i);
    for (const Body& body : robot.bodies) {
        bounding_balls_.push_back(bounding_ball(PlacedSolid(body.solid, Isometry3d::Identity()).bounding_box()));
        if (const auto* sphere = std::get_if<solid::Sphere>(&body.solid)) {
            bounding_balls_.back().radius = 0;
            bounding_balls_.back().size = sphere->radius;
        }
    }
    if (workpiece != nullptr) {
        const Eigen::AlignedBox3d box = geometry::finite_bounding_box(workpiece->mesh().vertices);
        bounding_balls_.push_back(bounding_ball(box));
        workpiece_bounds_ = box;
        workpiece_box_ = solid::Box{Isometry3d(Eigen::Translation3d(box.center())), box.sizes() / 2};
    }
    for (std::size_t body = 0; body < body_count(); ++body) {
        axis_distances_.push_back(axis_distances(body));
        double& max_extent = link_of(body) == link::kTable ? max_table_extent_ : max_arm_extent_;
        max_extent = std::max(max_extent, bounding_balls_[body].extent);
    }
}

int Cell::link_of(std::size_t body) const
{
    if (body < robot_.bodies.size()) return robot_.bodies[body].link;
    return workpiece_link(robot_);
}

// The links behind an axis, stretched, and the body. Its own link's offset along the axis does not count.
Eigen::Array<double, 6, 1> Cell::axis_distances(std::size_t body) const
{
    Eigen::Array<double, 6, 1> distances = Eigen::Array<double, 6, 1>::Zero();
    const int on = link_of(body);
    if (on <= link::kBase || on > link::kTool) return distances;
    double behind = bounding_balls_[body].extent;
    if (on == link::kTool) behind += robot_.T_flange_tool.translation().norm();
    for (int joint = std::min(on, 6); joint >= 1; --joint) {
        const DhRow& row = robot_.dh[joint - 1];
        distances[joint - 1] = behind + std::abs(row.a);
        behind += std::hypot(row.a, row.d);
    }
    return distances;
}

CellState Cell::place_bodies(const CellJoints& joints) const
{
    CellState state;
    place_bodies(joints, state);
    return state;
}

void Cell::place_bodies(const CellJoints& joints, CellState& state) const
{
    const std::array<Isometry3d, 10> frames = link_frames(robot_, arm_, joints);
    state.T_cell_body.resize(body_count());
    for (std::size_t b = 0; b < robot_.bodies.size(); ++b) state.T_cell_body[b] = frames[robot_.bodies[b].link + 1];
    if (workpiece_ != nullptr) state.T_cell_body.back() = workpiece_frame(robot_, frames);
    state.clearances.resize(pairs_.size());
    state.start_leaves.resize(pairs_.size());
    if (workpiece_ != nullptr && options_.model != nullptr)
        state.tool_zone = options_.model->tool_zone(robot_, frames[9].inverse() * frames[8]);
}

// For the workpiece this is the distance of the body's ball from the box around it.
double Cell::ball_clearance(const CellState& state, std::size_t index) const
{
    const CellPair& pair = pairs_[index];
    const BoundingBall &a = bounding_balls_[pair.a], &b = bounding_balls_[pair.b];
    const Vector3d centre = state.T_cell_body[pair.a] * a.centre;
    const Isometry3d& T_b = state.T_cell_body[pair.b];
    if (!is_of_workpiece(index)) return (centre - T_b * b.centre).norm() - a.size - b.size - pair.margin;
    const Vector3d in_part = T_b.linear().transpose() * (centre - T_b.translation());
    return workpiece_bounds_.exteriorDistance(in_part) - a.size - pair.margin;
}

double Cell::rough_clearance(const CellState& state, std::size_t index) const
{
    const CellPair& pair = pairs_[index];
    const double of_balls = ball_clearance(state, index);
    if (!is_of_workpiece(index))
        return has_mesh(index) ? std::max(of_balls, hull_clearance(state, index, options_.max_clearance)) : of_balls;
    const PlacedSolid body(robot_.bodies[pair.a].solid, state.T_cell_body[pair.a]);
    const Clearance to_box = clearance(body, PlacedSolid(workpiece_box_, state.T_cell_body.back()));
    return to_box.distance > 0 ? std::max(of_balls, to_box.distance - pair.margin) : of_balls;
}

} // namespace fettle::robot
