#pragma once

#include <Eigen/Core>

#include <vector>

namespace fettle {

/// Which elements of a surface (facets, points) lie side by side: those next to i are next[first[i]] and on, to
/// next[first[i + 1]].
struct Adjacency {
    std::vector<int> first; ///< elements + 1
    std::vector<int> next;
};

/// A connected piece of a surface whose normals lie within kChartCone of `axes`.col(2): seen along it, it covers its
/// plane once, and lengths in it are at most 1 / cos kChartCone of those in the plane.
struct Chart {
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity(); ///< unit; columns u, v, outward
    std::vector<int> elements;                          ///< ascending
    double steepest = 1;                                ///< least cosine of a normal with the outward axis
};

/// Cuts a surface into charts: pieces are grown from seeds, and once more about the mean normals of those found.
/// @param normals  3xN, unit; zero where an element has no direction: it goes with its neighbours
/// @param areas    of the elements
/// @return every element in one chart; axes.col(2) is set, u and v are any
std::vector<Chart> charts_of(const Adjacency& adjacency, const Eigen::Matrix3Xd& normals, const Eigen::VectorXd& areas);

/// Axes of which the third is `outward` and the others are the sides of the least rectangle about the points seen along
/// it (one side lies along an edge of their convex hull: Freeman & Shapira 1975), u along the longer one.
/// @param points  3xN
Eigen::Matrix3d rectangle_axes(const Eigen::Matrix3Xd& points, const Eigen::Vector3d& outward);

} // namespace fettle
