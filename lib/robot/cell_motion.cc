// How far bodies may move between two states of a cell: bounds for conservative advancement.

#include "robot/cell.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::robot {

namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

} // namespace

// The displacement of the ball's centre, and the chord of the rotation at the ball's radius: the spectral norm of
// R1 - R0 is its Frobenius norm over root 2.
double Cell::displacement_bound(const BoundingBall& ball, const Isometry3d& T0, const Isometry3d& T1)
{
    const Eigen::Matrix3d turn = T1.linear() - T0.linear();
    const Vector3d displacement = turn * ball.centre + (T1.translation() - T0.translation());
    return displacement.norm() + ball.radius * turn.norm() * std::numbers::sqrt2 / 2;
}

double Cell::displacement_bound(std::size_t body, const CellState& s0, const CellState& s1) const
{
    if (link_of(body) == link::kCell) return 0;
    return displacement_bound(bounding_balls_[body], s0.T_cell_body[body], s1.T_cell_body[body]);
}

// With turns the sum of the joints' turns and R the distance from their axes it is turns² R / 2.
double Cell::arm_arc_excess(const CellJoints& change, double extent) const
{
    double turns = change.head<6>().cwiseAbs().sum(); // with a parallelogram joint 3 turns by at most both, 2 and 3
    if (robot_.coupling == Coupling::parallelogram) turns += std::abs(change[1]);
    return turns * turns * (extent + reach_) / 2;
}

double Cell::table_arc_excess(const CellJoints& change, double extent) const
{
    return robot_.table ? change[7] * change[7] * (extent + robot_.table->point.norm()) / 2 : 0;
}

double Cell::arc_excess(std::size_t body, const CellJoints& change) const
{
    const int on = link_of(body);
    const double extent = bounding_balls_[body].extent;
    if (on == link::kTable) return table_arc_excess(change, extent);
    return on <= link::kBase ? 0 : arm_arc_excess(change, extent);
}

double Cell::max_arc_excess(const CellJoints& change) const
{
    return std::max(arm_arc_excess(change, max_arm_extent_), table_arc_excess(change, max_table_extent_));
}

// Bound of the second derivative of the paths of a body's points along a motion of the arm, the motion being 1, mm. Of
// a point p behind axes z_m at o_m it is the sum of z_m x (z_n x (p - o_n)) dq_m dq_n over all m and n, n being the one
// nearer to p. Joints before the first one rest.
double Cell::acceleration_bound(std::size_t body, const CellJoints& change, int first_joint) const
{
    const Eigen::Array<double, 6, 1>& distances = axis_distances_[body];
    double sum = 0, turns = 0; // turns of the joints so far
    for (int joint = first_joint; joint <= 6; ++joint) {
        double turn = change[joint - 1];
        if (joint == 3 && robot_.coupling == Coupling::parallelogram) turn -= change[1];
        turn = std::abs(turn);
        sum += distances[joint - 1] * turn * (turn + 2 * turns);
        turns += turn;
    }
    return sum;
}

// A point p(t) of a body whose acceleration is at most A is no farther than t |p1 - p0| + t (1 - t) A / 2 from p0, and
// than (1 - t) |p1 - p0| + t (1 - t) A / 2 from p1. The sum of both is at most |p1 - p0| + A / 4.
double Cell::relative_motion_bound(std::size_t index, const CellJoints& q0, const CellState& s0, const CellJoints& q1,
                                   const CellState& s1) const
{
    const CellJoints change = q1 - q0;
    std::size_t near = pairs_[index].a, far = pairs_[index].b; // from the base
    if (link_of(near) > link_of(far)) std::swap(near, far);
    if (link::is_on_arm(link_of(near)) && link::is_on_arm(link_of(far))) {
        const Isometry3d T0 = s0.T_cell_body[near].inverse() * s0.T_cell_body[far];
        const Isometry3d T1 = s1.T_cell_body[near].inverse() * s1.T_cell_body[far];
        return displacement_bound(bounding_balls_[far], T0, T1) +
               acceleration_bound(far, change, link_of(near) + 1) / 4;
    }
    double bound = 0;
    for (const std::size_t body : {near, far}) {
        bound += displacement_bound(body, s0, s1) + acceleration_bound(body, change, 1) / 4;
        if (link_of(body) == link::kTable) bound += table_arc_excess(change, bounding_balls_[body].extent) / 2;
    }
    return bound;
}

// The centre's path departs from its chord by at most A / 8, A being the bound of its acceleration. A ball that is
// outside at an end is not wholly inside between unless it meets the surface.
std::optional<double> Cell::swept_ball_clearance(std::size_t index, const CellJoints& q0, const CellState& s0,
                                                 const CellJoints& q1, const CellState& s1, double at_ends) const
{
    // Triangles that come nearer than the ends by less than this share of the tolerance need not be measured exactly.
    constexpr double kSlackTolerances = 0.1;
    const CellPair& pair = pairs_[index];
    const CellJoints change = q1 - q0;
    if (!is_of_workpiece(index) || options_.model != nullptr || change[7] != 0 || robot_.holds_workpiece)
        return std::nullopt;
    const auto* ball = std::get_if<solid::Sphere>(&robot_.bodies[pair.a].solid);
    if (ball == nullptr) return std::nullopt;
    const auto centre = [&](const CellState& state) {
        return Vector3d(state.T_cell_body.back().inverse() * (state.T_cell_body[pair.a] * ball->centre));
    };
    const PlacedSolid swept(solid::Capsule{centre(s0), centre(s1), ball->radius}, Isometry3d::Identity());
    const double max_distance = at_ends + pair.margin - kSlackTolerances * options_.tolerance;
    const double distance =
        workpiece_->nearest_of_surface(swept, max_distance, s0.start_leaves[index].b).clearance.distance;
    return distance - pair.margin - acceleration_bound(pair.a, change, 1) / 8;
}

} // namespace fettle::robot
