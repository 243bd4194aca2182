#include "robot/cell.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

namespace fettle {

namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

bool same_pair(const BodyPair& p, std::size_t a, std::size_t b) { return p.first == a && p.second == b; }

// The links of two bodies that need not be held against each other.
bool never_meet(const Robot& robot, int a, int b)
{
    const auto stands = [&](int on) { return on == link::kCell || (on == link::kBase && !robot.track); };
    if (a == b || (stands(a) && stands(b))) return true;
    const auto on_arm = [](int on) { return on >= link::kBase && on <= link::kTool; };
    return on_arm(a) && on_arm(b) && std::abs(a - b) == 1;
}

double margin_of(const Robot& robot, std::size_t a, std::size_t b)
{
    for (const Robot::Margin& margin : robot.margins)
        if (same_pair(margin.pair, a, b)) return margin.distance;
    return 0;
}

Eigen::AlignedBox3d mesh_box(const Mesh& mesh)
{
    const Eigen::Matrix<double, 3, 2> box = bounding_box(mesh.vertices);
    return {box.col(0), box.col(1)};
}

} // namespace

std::vector<CellPair> checked_pairs(const Robot& robot)
{
    std::vector<CellPair> pairs;
    const std::size_t count = robot.bodies.size();
    for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = a + 1; b <= count; ++b) {
            const int under_part = robot.table ? link::kTable : link::kCell;
            const int on_b = b == count ? under_part : robot.bodies[b].link;
            const bool allowed = std::any_of(robot.allowed.begin(), robot.allowed.end(),
                                             [&](const BodyPair& p) { return same_pair(p, a, b); });
            if (!allowed && !never_meet(robot, robot.bodies[a].link, on_b))
                pairs.push_back({a, b, margin_of(robot, a, b)});
        }
    return pairs;
}

std::array<Isometry3d, 10> link_frames(const Robot& robot, const Arm& arm, const CellJoints& joints)
{
    std::array<Isometry3d, 10> frames;
    frames[0].setIdentity();
    const Isometry3d base = cell_base(robot, joints[6]);
    const std::array<Isometry3d, 7> links = arm.frames(joints.head<6>());
    for (std::size_t k = 0; k < links.size(); ++k) frames[k + 1] = base * links[k];
    frames[8] = frames[7] * robot.T_flange_tool;
    frames[9] = cell_part(robot, joints[7]);
    return frames;
}

Cell::Around Cell::around(const Eigen::AlignedBox3d& box)
{
    const Vector3d farthest = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs());
    return {box.center(), box.diagonal().norm() / 2, farthest.norm()};
}

Cell::Cell(const Robot& robot, const Workpiece* workpiece, const CollisionOptions& options)
    : robot_(robot), workpiece_(workpiece), options_(options), arm_(robot),
      reach_(robot.T_flange_tool.translation().norm()), pairs_(checked_pairs(robot))
{
    for (const DhRow& row : robot.dh) reach_ += std::abs(row.a) + std::abs(row.d);
    for (std::size_t i = 0; i < pairs_.size(); ++i)
        if (workpiece != nullptr || pairs_[i].b < robot.bodies.size()) looked_at_.push_back(i);
    for (const Body& body : robot.bodies) {
        around_.push_back(around(PlacedSolid(body.solid, Isometry3d::Identity()).box()));
        if (std::holds_alternative<solid::Sphere>(body.solid)) around_.back().radius = 0;
    }
    if (workpiece != nullptr) around_.push_back(around(mesh_box(workpiece->mesh())));
}

Stance Cell::stand(const CellJoints& joints) const
{
    Stance stance;
    stand(joints, stance);
    return stance;
}

void Cell::stand(const CellJoints& joints, Stance& stance) const
{
    const std::array<Isometry3d, 10> frames = link_frames(robot_, arm_, joints);
    stance.T_cell_body.resize(bodies());
    for (std::size_t b = 0; b < robot_.bodies.size(); ++b)
        stance.T_cell_body[b] = frames[static_cast<std::size_t>(robot_.bodies[b].link + 1)];
    if (workpiece_ != nullptr) stance.T_cell_body.back() = frames[9];
    stance.pairs.assign(pairs_.size(), CellClearance{});
    stance.leaf.resize(pairs_.size());
    if (workpiece_ != nullptr && options_.model != nullptr)
        stance.zone = options_.model->zone(robot_, frames[9].inverse() * frames[8]);
}

double Cell::look(Stance& stance, std::size_t index, double beyond) const
{
    const CellPair& pair = pairs_[index];
    const Isometry3d& T_a = stance.T_cell_body[pair.a];
    CellClearance& found = stance.pairs[index];
    found.pair = index;
    Clearance c;
    if (pair.b == robot_.bodies.size()) {
        const Isometry3d& T_cell_part = stance.T_cell_body.back();
        const Solid& solid = robot_.bodies[pair.a].solid;
        const Isometry3d T_part_a = T_cell_part.inverse() * T_a;
        const Workpiece::Nearest nearest =
            options_.model != nullptr
                ? options_.model->nearest(solid, T_part_a, stance.zone, beyond + pair.margin)
                : workpiece_->nearest(PlacedSolid(solid, T_part_a), beyond + pair.margin, stance.leaf[index]);
        stance.leaf[index] = nearest.leaf;
        c = nearest.clearance;
        found.point = T_cell_part * c.on_a;
    } else {
        const PlacedSolid a(robot_.bodies[pair.a].solid, T_a);
        const PlacedSolid b(robot_.bodies[pair.b].solid, stance.T_cell_body[pair.b]);
        c = clearance(a, b, beyond + pair.margin);
        found.point = c.on_a;
    }
    found.clearance = std::min(c.distance - pair.margin, beyond);
    return c.distance - pair.margin;
}

// By the centre's way and the turn: |R1 - R0| is the Frobenius norm over root 2.
double Cell::chord(std::size_t body, const Stance& s0, const Stance& s1) const
{
    const Isometry3d &T0 = s0.T_cell_body[body], &T1 = s1.T_cell_body[body];
    const Eigen::Matrix3d turn = T1.linear() - T0.linear();
    const Vector3d way = turn * around_[body].centre + (T1.translation() - T0.translation());
    return way.norm() + around_[body].radius * turn.norm() * std::numbers::sqrt2 / 2;
}

double Cell::motion(std::size_t body, const CellJoints& q0, const Stance& s0, const CellJoints& q1,
                    const Stance& s1) const
{
    const CellJoints move = (q1 - q0).cwiseAbs();
    double turns = move.head<6>().sum(); // of joint 3 with joint 2, if they are coupled, it is at most their sum
    if (robot_.coupling == Coupling::parallelogram) turns += move[1];
    const int on = body == robot_.bodies.size() ? link::kTable : robot_.bodies[body].link;
    double bend = 0; // what an arc is longer than its chord
    if (on == link::kTable && robot_.table)
        bend = move[7] * move[7] * (around_[body].extent + robot_.table->point.norm()) / 2;
    if (on > link::kBase && on <= link::kTool) bend = turns * turns * (around_[body].extent + reach_) / 2;
    return chord(body, s0, s1) + bend;
}

} // namespace fettle
