#include "surface/delaunay.h"

#include "core/error.h"

#include <boost/polygon/voronoi.hpp>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>

namespace fettle {

namespace {

// Boost.Polygon computes on 32-bit integers, exactly: this is the largest span that its predicates allow.
constexpr double kLargestCoordinate = (1u << 30) - 1;
// What counts as on one circle or on one line, relative to the figure's size. Rounding to the integers above moves a
// point by 5e-10 of the span; figures are at least a thousandth of it.
constexpr double kRoundingAllowance = 1e-6;

using Triangle = std::array<int, 3>;
using Edge = std::pair<int, int>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Twice the area over the square of the longest side.
double thickness(const Eigen::Matrix2Xd& points, const Triangle& t)
{
    const Eigen::Vector2d a = points.col(t[1]) - points.col(t[0]);
    const Eigen::Vector2d b = points.col(t[2]) - points.col(t[0]);
    return cross(a, b) / std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
}

/// The cells that meet at each Voronoi vertex, counter-clockwise, cut into triangles.
std::vector<Triangle> triangles_of_voronoi(const Eigen::Matrix2Xd& points)
{
    const Eigen::Vector2d least = points.rowwise().minCoeff();
    const Eigen::Vector2d size = points.rowwise().maxCoeff() - least;
    const double scale = kLargestCoordinate / size.maxCoeff();
    std::vector<boost::polygon::point_data<std::int32_t>> sites;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const Eigen::Vector2d site = (points.col(i) - least) * scale;
        sites.emplace_back(static_cast<std::int32_t>(std::lround(site.x())),
                           static_cast<std::int32_t>(std::lround(site.y())));
    }
    boost::polygon::voronoi_diagram<double> diagram;
    boost::polygon::construct_voronoi(sites.begin(), sites.end(), &diagram);

    std::vector<Triangle> triangles;
    for (const auto& vertex : diagram.vertices()) {
        std::vector<int> around;
        const auto* edge = vertex.incident_edge();
        do {
            around.push_back(static_cast<int>(edge->cell()->source_index()));
            edge = edge->rot_next();
        } while (edge != vertex.incident_edge());
        for (std::size_t k = 2; k < around.size(); ++k) triangles.push_back({around[0], around[k - 1], around[k]});
    }
    return triangles;
}

/// Which triangle has the directed edge.
std::map<Edge, int> edges_of(const std::vector<Triangle>& triangles)
{
    std::map<Edge, int> edges;
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) edges[{triangles[t][k], triangles[t][(k + 1) % 3]}] = static_cast<int>(t);
    return edges;
}

/// Takes flat triangles off the hull until there are none: points that lie on a line but for rounding.
void drop_flat(const Eigen::Matrix2Xd& points, std::vector<Triangle>& triangles)
{
    const auto flat = [&](const Triangle& t) { return thickness(points, t) < kRoundingAllowance; };
    for (bool dropped = true; dropped;) {
        const std::map<Edge, int> edges = edges_of(triangles);
        const auto at_hull = [&](const Triangle& t) {
            for (int k = 0; k < 3; ++k)
                if (!edges.contains({t[(k + 1) % 3], t[k]})) return true;
            return false;
        };
        const std::size_t before = triangles.size();
        std::erase_if(triangles, [&](const Triangle& t) { return flat(t) && at_hull(t); });
        dropped = triangles.size() != before;
    }
}

/// Is d on the circle through the corners of t, within rounding? The incircle determinant with d as origin is twice the
/// signed area times the power of d; both are measured against the circle.
bool on_circle(const Eigen::Matrix2Xd& points, const Triangle& t, int d)
{
    Eigen::Matrix3d rows;
    double largest = 0;
    for (int k = 0; k < 3; ++k) {
        const Eigen::Vector2d side = points.col(t[k]) - points.col(d);
        rows.row(k) << side.x(), side.y(), side.squaredNorm();
        largest = std::max(largest, side.squaredNorm());
    }
    return std::abs(rows.determinant()) < kRoundingAllowance * largest * largest;
}

/// Divides every polygon of points on one circle anew, by the diagonals from its least index.
std::vector<Triangle> with_equal_diagonals(const Eigen::Matrix2Xd& points, const std::vector<Triangle>& triangles)
{
    const std::map<Edge, int> edges = edges_of(triangles);
    std::vector<int> polygon(triangles.size());
    std::iota(polygon.begin(), polygon.end(), 0);
    const auto root = [&](int t) {
        while (polygon[t] != t) t = polygon[t];
        return t;
    };
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
            if (on_circle(points, triangles[t], o[0] + o[1] + o[2] - sum))
                polygon[root(other)] = root(static_cast<int>(t));
        }

    std::map<int, std::map<int, int>> outlines; // polygon -> from corner to corner
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const int own = root(static_cast<int>(t));
            const int other = across(triangles[t], k);
            if (other < 0 || root(other) != own) outlines[own][triangles[t][k]] = triangles[t][(k + 1) % 3];
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
    const Eigen::Vector2d size = points.cols() < 3
                                     ? Eigen::Vector2d::Zero()
                                     : Eigen::Vector2d(points.rowwise().maxCoeff() - points.rowwise().minCoeff());
    if (size.maxCoeff() <= 0)
        throw InputError("a surface needs at least 3 points, there are " + std::to_string(points.cols()));
    std::vector<Triangle> triangles = triangles_of_voronoi(points);
    drop_flat(points, triangles);
    if (triangles.empty()) throw InputError("the points lie on a line");
    triangles = with_equal_diagonals(points, triangles);
    std::ranges::sort(triangles);

    Triangulation result;
    result.points = points;
    result.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
    result.neighbours.resizeLike(result.triangles);
    const std::map<Edge, int> edges = edges_of(triangles);
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const auto found = edges.find({triangles[t][(k + 2) % 3], triangles[t][(k + 1) % 3]});
            result.triangles(k, static_cast<Eigen::Index>(t)) = triangles[t][k];
            result.neighbours(k, static_cast<Eigen::Index>(t)) = found == edges.end() ? -1 : found->second;
        }
    return result;
}

std::vector<int> hull(const Triangulation& triangulation)
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

} // namespace fettle
