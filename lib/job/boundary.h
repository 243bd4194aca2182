#pragma once

#include "job/job.h"

#include <Eigen/Core>

#include <string>
#include <utility>
#include <vector>

namespace fettle {

/// A simple polygon, 2xN, counter-clockwise, not closed (the last corner is not the first).
using Polygon = Eigen::Matrix2Xd;

/// The polygons of a job in the working frame W, checked (Wang 2007, 4.4.4): B the anomaly, S the sampling boundary.
struct Boundaries {
    Polygon anomaly;  ///< B
    Polygon sampling; ///< S; empty for a plane without one
};

/// Clockwise input is turned; points that repeat their neighbour (a closed list) are dropped.
/// @throws InputError for fewer than 3 points, a self-intersecting or flat polygon, B not inside S (free-form: not
///         inside the convex hull of S), S \ B empty; the message names the polygon and the place, in M
Boundaries boundaries(const Job& job);

bool contains(const Polygon& polygon, const Eigen::Vector2d& point); ///< the edge belongs to it
double area(const Polygon& polygon);
Polygon convex_hull(const Polygon& points);

/// Where the line origin + t · direction (unit) is inside the polygon: intervals of t, ascending, disjoint. Touching at
/// a corner only gives no interval; an edge along the line counts as inside.
using Interval = std::pair<double, double>;
std::vector<Interval> inside(const Polygon& polygon, const Eigen::Vector2d& origin, const Eigen::Vector2d& direction);

/// a \ b and a ∩ b for sorted disjoint intervals; parts shorter than `least` are dropped.
std::vector<Interval> subtract(const std::vector<Interval>& a, const std::vector<Interval>& b, double least = 0);
std::vector<Interval> intersect(const std::vector<Interval>& a, const std::vector<Interval>& b, double least = 0);

/// "(1.5, 2) in": a place in messages. @param xy  frame M, mm
std::string place(const Eigen::Vector2d& xy, const Units& units);

/// Distance of a point to the polygon's edge, mm.
double distance_to_edge(const Polygon& polygon, const Eigen::Vector2d& point);

} // namespace fettle
