#pragma once

#include "job/job.h"

#include <Eigen/Core>

#include <string>
#include <utility>
#include <vector>

namespace fettle::job {

/// A simple polygon, 2xN, counter-clockwise, not closed (the last corner is not the first).
using Polygon = Eigen::Matrix2Xd;

/// The checked polygons of a job in the working frame W, mm (Wang 2007, 4.4.4).
struct Boundaries {
    Polygon anomaly;  ///< B, around the anomaly
    Polygon sampling; ///< S, within which the probe may touch; empty for a plane without one
};

/// Checks the boundaries of a job. Clockwise polygons are reversed, repeated points (of a closed list) are dropped.
/// @throws InputError for fewer than 3 points, a self-intersecting or flat polygon, B not inside S (free-form: not
///         inside the convex hull of S), S \ B empty; the message names the polygon and the place, in M
Boundaries working_boundaries(const Job& job);

/// Does the polygon contain the point? Its edge is part of it.
bool contains(const Polygon& polygon, const Eigen::Vector2d& point);
double area(const Polygon& polygon);
Polygon convex_hull(const Polygon& points);

/// Intervals of t, ascending and disjoint, in which the line origin + t · direction (unit) is inside the polygon. A
/// corner that only touches the line gives no interval; an edge along the line counts as inside.
using Interval = std::pair<double, double>;
std::vector<Interval> intervals_inside(const Polygon& polygon, const Eigen::Vector2d& origin,
                                       const Eigen::Vector2d& direction);

/// a \ b and a ∩ b for sorted disjoint intervals; parts shorter than `min_length` are dropped.
std::vector<Interval> subtract(const std::vector<Interval>& a, const std::vector<Interval>& b, double min_length = 0);
std::vector<Interval> intersect(const std::vector<Interval>& a, const std::vector<Interval>& b, double min_length = 0);

/// The points of a list as the columns of a matrix.
template <typename Point>
auto columns_to_matrix(const std::vector<Point>& points)
{
    Eigen::Matrix<typename Point::Scalar, Point::RowsAtCompileTime, Eigen::Dynamic> matrix;
    matrix.resize(Eigen::NoChange, points.size());
    for (std::size_t i = 0; i < points.size(); ++i) matrix.col(i) = points[i];
    return matrix;
}

/// Adds a job's boundaries to a report: numbers of points, areas, lowest and highest z; in the job's length unit.
void add_report(json::Value& report, const Job& job);

/// Text of a point for messages, "(1.5, 2) in". @param xy  frame M, mm
std::string point_text(const Eigen::Vector2d& xy, const units::Units& units);

/// Distance from a point to the polygon's edge, mm.
double distance_to_edge(const Polygon& polygon, const Eigen::Vector2d& point);

} // namespace fettle::job
