#include "surface/delaunay.h"

#include "core/error.h"
#include "geometry/bounding_box.h"
#include "geometry/union_find.h"

#include <boost/polygon/voronoi.hpp>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace fettle::surface {

namespace {

// Boost.Polygon computes exactly on 32-bit integers: this is the largest coordinate that its predicates allow.
constexpr double kMaxSiteCoordinate = (1u << 30) - 1;
// Tolerance for cocircular and collinear points, relative to the size of the triangle. Rounding to the integers above
// moves a point by 5e-10 of the span of all points, and triangles are at least a thousandth of it.
constexpr double kDegeneracyTolerance = 1e-6;

using Triangle = std::array<int, 3>;
using Edge = std::pair<int, int>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Twice the area divided by the square of the longest side.
double thickness(const Eigen::Matrix2Xd& points, const Triangle& t)
{
    const Eigen::Vector2d a = points.col(t[1]) - points.col(t[0]);
    const Eigen::Vector2d b = points.col(t[2]) - points.col(t[0]);
    return cross(a, b) / std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
}

/// Triangles dual to the Voronoi diagram: the sites of the cells at each vertex, counter-clockwise, as a triangle fan.
std::vector<Triangle> voronoi_dual(const Eigen::Matrix2Xd& points)
{
    const Eigen::AlignedBox2d box = geometry::bounding_box(points);
    const double scale = kMaxSiteCoordinate / box.sizes().maxCoeff();
    std::vector<boost::polygon::point_data<std::int32_t>> sites;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const Eigen::Vector2d site = (points.col(i) - box.min()) * scale;
        sites.emplace_back(static_cast<std::int32_t>(std::lround(site.x())),
                           static_cast<std::int32_t>(std::lround(site.y())));
    }
    boost::polygon::voronoi_diagram<double> diagram;
    boost::polygon::construct_voronoi(sites.begin(), sites.end(), &diagram);

    std::vector<Triangle> triangles;
    for (const auto& vertex : diagram.vertices()) {
        std::vector<int> cells;
        const auto* edge = vertex.incident_edge();
        do {
            cells.push_back(edge->cell()->source_index());
            edge = edge->rot_next();
        } while (edge != vertex.incident_edge());
        for (std::size_t k = 2; k < cells.size(); ++k) triangles.push_back({cells[0], cells[k - 1], cells[k]});
    }
    return triangles;
}

/// The triangle to the left of each directed edge.
std::map<Edge, int> triangle_of_edges(const std::vector<Triangle>& triangles)
{
    std::map<Edge, int> edges;
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) edges[{triangles[t][k], triangles[t][(k + 1) % 3]}] = t;
    return edges;
}

/// Removes flat triangles from the hull until there are none; they are due to points that are collinear up to rounding.
void remove_flat_hull_triangles(const Eigen::Matrix2Xd& points, std::vector<Triangle>& triangles)
{
    const auto flat = [&](const Triangle& t) { return thickness(points, t) < kDegeneracyTolerance; };
    for (bool removed = true; removed;) {
        const std::map<Edge, int> edges = triangle_of_edges(triangles);
        const auto at_hull = [&](const Triangle& t) {
            for (int k = 0; k < 3; ++k)
                if (!edges.contains({t[(k + 1) % 3], t[k]})) return true;
            return false;
        };
        removed = std::erase_if(triangles, [&](const Triangle& t) { return flat(t) && at_hull(t); }) > 0;
    }
}

/// Is d on the circumcircle of t, within the tolerance? The incircle determinant with d as origin is twice the signed
/// area times the power of d with respect to the circle.
bool on_circumcircle(const Eigen::Matrix2Xd& points, const Triangle& t, int d)
{
    Eigen::Matrix3d rows;
    double largest = 0;
    for (int k = 0; k < 3; ++k) {
        const Eigen::Vector2d side = points.col(t[k]) - points.col(d);
        rows.row(k) << side.x(), side.y(), side.squaredNorm();
        largest = std::max(largest, side.squaredNorm());
    }
    return std::abs(rows.determinant()) < kDegeneracyTolerance * largest * largest;
}

/// Triangulates every polygon of cocircular points again, as the fan from its lowest index.
std::vector<Triangle> retriangulate_cocircular(const Eigen::Matrix2Xd& points, const std::vector<Triangle>& triangles)
{
    const std::map<Edge, int> edges = triangle_of_edges(triangles);
    geometry::UnionFind polygons(triangles.size());
    const auto across = [&](const Triangle& t, int k) {
        const auto found = edges.find({t[(k + 1) % 3], t[k]});
        return found == edges.end() ? -1 : found->second;
    };
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const int other = across(triangles[t], k);
            if (other < 0) continue;
            const Triangle& o = triangles[other];
            const int sum = triangles[t][k] + triangles[t][(k + 1) % 3];
            if (on_circumcircle(points, triangles[t], o[0] + o[1] + o[2] - sum)) polygons.join_under(other, t);
        }

    std::map<std::uint32_t, std::map<int, int>> outlines; // polygon -> corner -> next corner
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t own = polygons.root(t);
            const int other = across(triangles[t], k);
            if (other < 0 || polygons.root(other) != own) outlines[own][triangles[t][k]] = triangles[t][(k + 1) % 3];
        }
    std::vector<Triangle> result;
    for (const auto& [own, next] : outlines) {
        const int first = next.begin()->first;
        for (int a = next.at(first); next.at(a) != first; a = next.at(a)) result.push_back({first, a, next.at(a)});
    }
    return result;
}

} // namespace

Triangulation delaunay(const Eigen::Matrix2Xd& points)
{
    if (points.cols() < 3 || geometry::bounding_box(points).sizes().maxCoeff() <= 0)
        throw core::InputError("a surface needs at least 3 points, there are " + std::to_string(points.cols()));
    std::vector<Triangle> triangles = voronoi_dual(points);
    remove_flat_hull_triangles(points, triangles);
    if (triangles.empty()) throw core::InputError("the points lie on a line");
    triangles = retriangulate_cocircular(points, triangles);
    std::ranges::sort(triangles);

    Triangulation result;
    result.points = points;
    result.triangles.resize(3, triangles.size());
    result.neighbours.resizeLike(result.triangles);
    const std::map<Edge, int> edges = triangle_of_edges(triangles);
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const auto found = edges.find({triangles[t][(k + 2) % 3], triangles[t][(k + 1) % 3]});
            result.triangles(k, t) = triangles[t][k];
            result.neighbours(k, t) = found == edges.end() ? -1 : found->second;
        }
    return result;
}

std::vector<int> hull_corners(const Triangulation& triangulation)
{
    std::map<int, int> next;
    for (Eigen::Index t = 0; t < triangulation.triangles.cols(); ++t)
        for (int k = 0; k < 3; ++k)
            if (triangulation.neighbours(k, t) < 0)
                next[triangulation.triangles((k + 1) % 3, t)] = triangulation.triangles((k + 2) % 3, t);
    std::vector<int> corners = {next.begin()->first};
    while (next.at(corners.back()) != corners.front()) corners.push_back(next.at(corners.back()));
    return corners;
}

} // namespace fettle::surface
