#include "mesh/mesh.h"

#include <Eigen/Geometry>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

namespace fettle {

Eigen::Matrix3Xd triangle_normals(const Mesh& mesh)
{
    Eigen::Matrix3Xd unit(3, mesh.triangles.cols());
    for (Eigen::Index t = 0; t < unit.cols(); ++t) {
        const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, t));
        const Eigen::Vector3d b = mesh.vertices.col(mesh.triangles(1, t));
        const Eigen::Vector3d c = mesh.vertices.col(mesh.triangles(2, t));
        unit.col(t) = (b - a).cross(c - a).stableNormalized(); // tiny triangles would underflow otherwise
    }
    return unit;
}

Eigen::Matrix<double, 3, 2> bounding_box(const Eigen::Matrix3Xd& points)
{
    Eigen::AlignedBox3d box;
    for (const auto& point : points.colwise())
        if (point.allFinite()) box.extend(point);
    Eigen::Matrix<double, 3, 2> corners;
    corners << box.min(), box.max();
    if (box.isEmpty()) corners.setConstant(std::numeric_limits<double>::quiet_NaN());
    return corners;
}

Eigen::Matrix3Xi distinct(const Eigen::Matrix3Xi& triangles)
{
    using Corners = std::array<int, 3>;
    std::vector<std::pair<Corners, Eigen::Index>> order;
    for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
        const int a = triangles(0, t), b = triangles(1, t), c = triangles(2, t); // begun at any corner it is the same
        order.emplace_back(std::min({Corners{a, b, c}, Corners{b, c, a}, Corners{c, a, b}}), t);
    }
    tbb::parallel_sort(order);
    std::vector<Eigen::Index> first;
    for (std::size_t i = 0; i < order.size(); ++i)
        if (i == 0 || order[i].first != order[i - 1].first) first.push_back(order[i].second);
    std::sort(first.begin(), first.end());
    return triangles(Eigen::all, first);
}

} // namespace fettle
