#pragma once

#include <Eigen/Core>

#include <vector>

namespace fettle::belt {

/// Adjacency of the elements of a surface (facets, points) in compressed rows: the neighbours of element i are
/// next[first[i]] to next[first[i + 1] - 1].
struct Adjacency {
    std::vector<int> first; ///< elements + 1
    std::vector<int> next;
};

/// A connected piece of a surface whose normals lie within kChartCone of `axes`.col(2). Projected along that axis it
/// covers its plane once, and its lengths are at most 1 / cos kChartCone of those in the plane.
struct Chart {
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity(); ///< unit; columns u, v, outward
    std::vector<int> elements;                          ///< ascending
    double min_cosine = 1;                              ///< of the angle between a normal and the outward axis
};

/// Cuts a surface into charts by region growing: first from arbitrary seeds, then again about the mean normals found.
/// @param normals  3xN, unit; zero where an element has no direction: it joins its neighbours' chart
/// @param areas    of the elements
/// @return every element in one chart; axes.col(2) is set, u and v are arbitrary
std::vector<Chart> segment_into_charts(const Adjacency& adjacency, const Eigen::Matrix3Xd& normals,
                                       const Eigen::VectorXd& areas);

/// Axes of the minimum-area rectangle around the projected points: the third is `outward`, u the longer side, v the
/// shorter one. One side lies along an edge of the convex hull (Freeman & Shapira 1975).
/// @param points  3xN
Eigen::Matrix3d min_rectangle_axes(const Eigen::Matrix3Xd& points, const Eigen::Vector3d& outward);

} // namespace fettle::belt
