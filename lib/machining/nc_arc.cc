#include "machining/nc_arc.h"

#include "core/error.h"
#include "core/text.h"
#include "machining/nc_program.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::machining {
namespace {

/// Largest difference of the radii at both ends, mm: half a thousandth of an inch, the rounding of words in inches.
constexpr double kRadiusTolerance = 0.0127;
/// If the centre is off the perpendicular bisector of the ends by more than this, the arc is a spiral, mm: a tenth of
/// the last digit of programs in mm.
constexpr double kCircleTolerance = 1e-4;
/// A smaller angle between both ends means a full circle, rad.
constexpr double kMinArcAngle = 1e-9;
/// Limit of the chords of one arc: a full circle with a radius of 8 m has as many.
constexpr double kMaxChords = 20000;
constexpr double kTurn = 2 * std::numbers::pi;

using Eigen::Vector2d;

Vector2d in_plane(const NcArc& arc, const Eigen::Vector3d& p) { return {p[arc.axes[0]], p[arc.axes[1]]}; }

Vector2d centre_by_radius(const NcArc& arc, const Vector2d& p, const Vector2d& q)
{
    const double chord = (q - p).norm(), radius = std::abs(*arc.radius);
    if (chord == 0) throw core::InputError("R: an arc that ends where it begins has no centre; give I, J or K");
    if (radius + kRadiusTolerance < chord / 2)
        throw core::InputError("R " + core::to_short_text(radius) + " mm is less than half the distance of " +
                               core::to_short_text(chord) + " mm");
    const double height = std::sqrt(std::max((radius - chord / 2) * (radius + chord / 2), 0.0));
    const Vector2d left = Vector2d(p.y() - q.y(), q.x() - p.x()) / chord;
    return (p + q) / 2 + (arc.counter_clockwise == (*arc.radius > 0) ? height : -height) * left;
}

/// Signed angle from the vector p to the vector q, rad.
double angle_between(const Vector2d& p, const Vector2d& q, bool counter_clockwise)
{
    double turn = std::atan2(p.x() * q.y() - p.y() * q.x(), p.dot(q));
    if (!counter_clockwise) turn = -turn;
    if (turn < kMinArcAngle) turn += kTurn; // rounding may put the end of a full circle before its start
    return counter_clockwise ? turn : -turn;
}

std::vector<CutterMove> chords(const NcArc& arc, const Vector2d& centre, double turn)
{
    const Vector2d start = in_plane(arc, arc.from) - centre;
    const double first = start.norm(), last = (in_plane(arc, arc.to) - centre).norm();
    const double largest = std::max(first, last);
    // A chord over the angle α has the sag r (1 − cos α/2).
    const double max_angle = kArcChordTolerance < largest ? 2 * std::acos(1 - kArcChordTolerance / largest) : kTurn / 2;
    const double needed = std::ceil(std::abs(turn) / max_angle);
    if (!(needed <= kMaxChords))
        throw core::InputError("an arc with a radius of " + core::to_short_text(largest) +
                               " mm that is not a horizontal circle takes more than " +
                               core::to_short_text(kMaxChords) + " chords");
    const int count = std::max(1, static_cast<int>(needed));
    const double begin = std::atan2(start.y(), start.x());
    std::vector<CutterMove> moves;
    Eigen::Vector3d at = arc.from;
    for (int k = 1; k <= count; ++k) {
        const double t = static_cast<double>(k) / count, angle = begin + t * turn;
        const double radius = first + t * (last - first);
        Eigen::Vector3d next = arc.from + t * (arc.to - arc.from); // linear along the plane's normal: a helix
        next[arc.axes[0]] = centre.x() + radius * std::cos(angle);
        next[arc.axes[1]] = centre.y() + radius * std::sin(angle);
        if (k == count) next = arc.to;
        moves.push_back({.from = at, .to = next});
        at = next;
    }
    return moves;
}

} // namespace

std::vector<CutterMove> arc_moves(const NcArc& arc)
{
    const Vector2d p = in_plane(arc, arc.from), q = in_plane(arc, arc.to);
    Vector2d centre = arc.radius ? centre_by_radius(arc, p, q) : p + arc.centre_offset;
    const double first = (p - centre).norm(), last = (q - centre).norm();
    if (!(first > 0)) throw core::InputError("an arc needs a radius");
    if (std::abs(first - last) > kRadiusTolerance)
        throw core::InputError("the arc begins " + core::to_short_text(first) + " mm and ends " +
                               core::to_short_text(last) + " mm from its centre");
    const double turn = angle_between(p - centre, q - centre, arc.counter_clockwise);
    const bool horizontal = arc.axes[2] == 2 && arc.from.z() == arc.to.z();
    const double chord = (q - p).norm();
    const double off = chord > 0 ? ((p + q) / 2 - centre).dot(q - p) / chord : 0;
    if (!horizontal || std::abs(off) > kCircleTolerance) return chords(arc, centre, turn);
    if (chord > 0) centre += off / chord * (q - p);
    const double sweep = angle_between(p - centre, q - centre, arc.counter_clockwise);
    return {{arc.from, arc.to, sweep, centre}};
}

} // namespace fettle::machining
