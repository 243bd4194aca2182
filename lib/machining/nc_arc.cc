#include "machining/nc_arc.h"

#include "core/error.h"
#include "core/text.h"
#include "machining/nc_program.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle {
namespace {

/// Half a thousandth of an inch: what the rounding of words in inches may put an arc's ends off it, mm.
constexpr double kArcRounding = 0.0127;
/// An arc whose centre must move by no more than this to be as far from both ends is taken for round, mm; else it is
/// a spiral. A tenth of the last digit of programs in mm.
constexpr double kSameArc = 1e-4;
/// Ends that are no farther apart than this turn (rad) are one: a whole turn.
constexpr double kNoTurn = 1e-9;
/// Chords of one arc: a whole turn of 8 m has so many.
constexpr double kMostChords = 20000;
constexpr double kTurn = 2 * std::numbers::pi;

using Eigen::Vector2d;

Vector2d in_plane(const NcArc& arc, const Eigen::Vector3d& p) { return {p[arc.axes[0]], p[arc.axes[1]]}; }

Vector2d centre_by_radius(const NcArc& arc, const Vector2d& p, const Vector2d& q)
{
    const double chord = (q - p).norm(), radius = std::abs(*arc.radius);
    if (chord == 0) throw InputError("R: an arc that ends where it begins has no centre; give I, J or K");
    if (radius + kArcRounding < chord / 2)
        throw InputError("R " + to_short_text(radius) + " mm is less than half the way of " + to_short_text(chord) +
                         " mm");
    const double height = std::sqrt(std::max((radius - chord / 2) * (radius + chord / 2), 0.0));
    const Vector2d left = Vector2d(p.y() - q.y(), q.x() - p.x()) / chord;
    return (p + q) / 2 + (arc.counter_clockwise == (*arc.radius > 0) ? height : -height) * left;
}

/// Turn from p to q about c, rad, with its sign.
double turn_between(const Vector2d& p, const Vector2d& q, bool counter_clockwise)
{
    double turn = std::atan2(p.x() * q.y() - p.y() * q.x(), p.dot(q));
    if (!counter_clockwise) turn = -turn;
    if (turn < kNoTurn) turn += kTurn; // the ends of a whole turn may be a rounding past each other
    return counter_clockwise ? turn : -turn;
}

CutterMove straight(const Eigen::Vector3d& from, const Eigen::Vector3d& to)
{
    CutterMove move;
    move.from = from;
    move.to = to;
    return move;
}

std::vector<CutterMove> chords(const NcArc& arc, const Vector2d& centre, double turn)
{
    const Vector2d start = in_plane(arc, arc.from) - centre;
    const double first = start.norm(), last = (in_plane(arc, arc.to) - centre).norm();
    const double largest = std::max(first, last);
    // a chord over the angle α stands off by r (1 − cos α/2)
    const double most = kArcChord < largest ? 2 * std::acos(1 - kArcChord / largest) : kTurn / 2;
    const double needed = std::ceil(std::abs(turn) / most);
    if (!(needed <= kMostChords))
        throw InputError("an arc with a radius of " + to_short_text(largest) +
                         " mm that is no level circle takes more than " + to_short_text(kMostChords) + " chords");
    const int count = std::max(1, static_cast<int>(needed));
    const double begin = std::atan2(start.y(), start.x());
    std::vector<CutterMove> moves;
    Eigen::Vector3d at = arc.from;
    for (int k = 1; k <= count; ++k) {
        const double share = static_cast<double>(k) / count, angle = begin + share * turn;
        const double radius = first + share * (last - first);
        Eigen::Vector3d next = arc.from + share * (arc.to - arc.from); // across the plane it goes evenly
        next[arc.axes[0]] = centre.x() + radius * std::cos(angle);
        next[arc.axes[1]] = centre.y() + radius * std::sin(angle);
        if (k == count) next = arc.to;
        moves.push_back(straight(at, next));
        at = next;
    }
    return moves;
}

} // namespace

std::vector<CutterMove> moves_along(const NcArc& arc)
{
    const Vector2d p = in_plane(arc, arc.from), q = in_plane(arc, arc.to);
    Vector2d centre = arc.radius ? centre_by_radius(arc, p, q) : p + arc.centre_offset;
    const double first = (p - centre).norm(), last = (q - centre).norm();
    if (!(first > 0)) throw InputError("an arc needs a radius");
    if (std::abs(first - last) > kArcRounding)
        throw InputError("the arc begins " + to_short_text(first) + " mm and ends " + to_short_text(last) +
                         " mm from its centre");
    const double turn = turn_between(p - centre, q - centre, arc.counter_clockwise);
    const bool level = arc.axes[2] == 2 && arc.from.z() == arc.to.z();
    const double chord = (q - p).norm();
    const double off = chord > 0 ? ((p + q) / 2 - centre).dot(q - p) / chord : 0;
    if (!level || std::abs(off) > kSameArc) return chords(arc, centre, turn);
    if (chord > 0) centre += off / chord * (q - p);
    CutterMove move = straight(arc.from, arc.to);
    move.sweep = turn_between(p - centre, q - centre, arc.counter_clockwise);
    move.centre = centre;
    return {move};
}

} // namespace fettle
