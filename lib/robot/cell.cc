#include "robot/cell.h"

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Between two looks the way is halved at most so often: 1 m to the hundredth of a micrometre.
constexpr int kMostHalvings = 26;

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

Eigen::Matrix3Xd box_corners(const Eigen::AlignedBox3d& box)
{
    Eigen::Matrix3Xd corners(3, 8);
    for (int k = 0; k < 8; ++k) corners.col(k) = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k));
    return corners;
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

std::vector<Isometry3d> link_frames(const Robot& robot, const CellJoints& joints)
{
    std::vector<Isometry3d> frames = {Isometry3d::Identity()};
    const Isometry3d base = cell_base(robot, joints[6]);
    for (const Isometry3d& T : Arm(robot).frames(joints.head<6>())) frames.push_back(base * T);
    frames.push_back(frames.back() * robot.T_flange_tool);
    frames.push_back(cell_part(robot, joints[7]));
    return frames;
}

CellClearance least_of(const Stance& stance)
{
    CellClearance least;
    least.clearance = kInfinity;
    for (const CellClearance& c : stance.pairs)
        if (c.clearance < least.clearance) least = c;
    return least;
}

Cell::Cell(const Robot& robot, const Workpiece* workpiece, const CollisionOptions& options)
    : robot_(robot), workpiece_(workpiece), options_(options), pairs_(checked_pairs(robot))
{
    for (std::size_t i = 0; i < pairs_.size(); ++i)
        if (workpiece != nullptr || pairs_[i].b < robot.bodies.size()) looked_at_.push_back(i);
    for (const Body& body : robot.bodies)
        corners_.push_back(box_corners(PlacedSolid(body.solid, Isometry3d::Identity()).box()));
    if (workpiece != nullptr) corners_.push_back(box_corners(mesh_box(workpiece->mesh())));
}

Stance Cell::stand(const CellJoints& joints) const
{
    const std::vector<Isometry3d> frames = link_frames(robot_, joints);
    Stance stance;
    for (const Body& body : robot_.bodies)
        stance.T_cell_body.push_back(frames[static_cast<std::size_t>(body.link + 1)]);
    if (workpiece_ != nullptr) stance.T_cell_body.push_back(cell_part(robot_, joints[7]));
    stance.pairs.resize(pairs_.size());
    return stance;
}

void Cell::look(Stance& stance, std::size_t index) const
{
    const CellPair& pair = pairs_[index];
    const double beyond = options_.beyond + pair.margin;
    const Isometry3d& T_a = stance.T_cell_body[pair.a];
    CellClearance& found = stance.pairs[index];
    found.pair = index;
    if (pair.b == robot_.bodies.size()) {
        const Isometry3d& T_cell_part = stance.T_cell_body.back();
        const PlacedSolid a(robot_.bodies[pair.a].solid, T_cell_part.inverse() * T_a);
        const Clearance c = workpiece_->nearest(a, beyond).clearance;
        found.clearance = c.distance - pair.margin;
        found.point = T_cell_part * c.on_a;
    } else {
        const PlacedSolid a(robot_.bodies[pair.a].solid, T_a);
        const PlacedSolid b(robot_.bodies[pair.b].solid, stance.T_cell_body[pair.b]);
        const Clearance c = clearance(a, b, beyond);
        found.clearance = std::min(c.distance, beyond) - pair.margin;
        found.point = c.on_a;
    }
}

Stance Cell::look_at_all(const CellJoints& joints) const
{
    Stance stance = stand(joints);
    for (const std::size_t i : looked_at_) look(stance, i);
    return stance;
}

CellClearance Cell::between(const CellJoints& q0, const Stance& s0, const CellJoints& q1, const Stance& s1,
                            const std::vector<std::size_t>& some, int halvings, std::size_t& looks) const
{
    CellClearance least;
    least.clearance = kInfinity;
    std::vector<std::size_t> unclear;
    for (const std::size_t i : some) {
        const double way = motion(pairs_[i].a, q0, s0, q1, s1) + motion(pairs_[i].b, q0, s0, q1, s1);
        const CellClearance &c0 = s0.pairs[i], &c1 = s1.pairs[i];
        const CellClearance& nearer = c1.clearance < c0.clearance ? c1 : c0;
        const double bound = std::min((c0.clearance + c1.clearance - way) / 2, nearer.clearance);
        const bool known = nearer.clearance < -options_.tolerance; // it collides at a look already
        if (bound < -options_.tolerance && !known && way > options_.resolution && halvings < kMostHalvings) {
            unclear.push_back(i);
        } else if (bound < least.clearance) {
            least = nearer;
            // What cannot be resolved further is told as it was seen.
            least.clearance = known || way <= options_.resolution ? nearer.clearance : bound;
        }
    }
    if (unclear.empty()) return least;
    const CellJoints middle = (q0 + q1) / 2;
    Stance half = stand(middle);
    for (const std::size_t i : unclear) look(half, i);
    ++looks;
    for (const CellClearance& c : {between(q0, s0, middle, half, unclear, halvings + 1, looks),
                                   between(middle, half, q1, s1, unclear, halvings + 1, looks)})
        if (c.clearance < least.clearance) least = c;
    return least;
}

// No point of the body moves farther between two stances.
double Cell::motion(std::size_t body, const CellJoints& q0, const Stance& s0, const CellJoints& q1,
                    const Stance& s1) const
{
    const Eigen::Matrix3Xd& corners = corners_[body];
    const Isometry3d &T0 = s0.T_cell_body[body], &T1 = s1.T_cell_body[body];
    const double chord = ((T1 * corners) - (T0 * corners)).colwise().norm().maxCoeff();
    const int on = body == robot_.bodies.size() ? link::kTable : robot_.bodies[body].link;
    const double extent = corners.colwise().norm().maxCoeff();
    if (on == link::kTable) {
        const double turn = robot_.table ? std::abs(q1[7] - q0[7]) : 0;
        return chord + turn * turn * (extent + (robot_.table ? robot_.table->point.norm() : 0)) / 2;
    }
    double turns = std::abs(q1[1] - q0[1]) + std::abs(q1[2] - q0[2]); // of the upper arm and, at most, the forearm
    if (robot_.coupling == Coupling::parallelogram) turns += std::abs(q1[1] - q0[1]);
    for (const Eigen::Index k : {0, 3, 4, 5}) turns += std::abs(q1[k] - q0[k]);
    double reach = extent + robot_.T_flange_tool.translation().norm();
    for (const DhRow& row : robot_.dh) reach += std::abs(row.a) + std::abs(row.d);
    return on <= link::kBase ? chord : chord + turns * turns * reach / 2;
}

} // namespace fettle
