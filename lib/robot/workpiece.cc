#include "robot/workpiece.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace fettle {

namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kLeaf = 4; // triangles; a distance to one costs about as much as a few boxes

double squared_apart(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b)
{
    return (a.min() - b.max()).cwiseMax(b.min() - a.max()).cwiseMax(0.0).squaredNorm();
}

// Solid angle of a triangle, seen from a point: van Oosterom & Strackee (1983).
double solid_angle(const Triangle& t, const Vector3d& point)
{
    const Vector3d a = t.col(0) - point, b = t.col(1) - point, c = t.col(2) - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

} // namespace

bool is_closed(const Mesh& mesh)
{
    std::vector<std::pair<int, int>> sides;
    for (const auto t : mesh.triangles.colwise())
        for (int k = 0; k < 3; ++k) sides.emplace_back(t[k], t[(k + 1) % 3]);
    std::sort(sides.begin(), sides.end());
    if (std::adjacent_find(sides.begin(), sides.end()) != sides.end()) return false;
    return std::all_of(sides.begin(), sides.end(), [&](const auto& side) {
        return std::binary_search(sides.begin(), sides.end(), std::pair(side.second, side.first));
    });
}

Workpiece::Workpiece(const Mesh& mesh) : mesh_(&mesh), closed_(is_closed(mesh))
{
    const auto count = static_cast<std::uint32_t>(mesh.triangles.cols());
    order_.resize(count);
    std::iota(order_.begin(), order_.end(), 0u);
    Eigen::Matrix3Xd centres(3, count);
    for (std::uint32_t i = 0; i < count; ++i) centres.col(i) = corners(i).rowwise().mean();
    nodes_.reserve(2 * (count / kLeaf + 1));
    nodes_.emplace_back();
    build(0, 0, count, centres);
}

Triangle Workpiece::corners(std::uint32_t place) const
{
    Triangle t;
    for (int k = 0; k < 3; ++k) t.col(k) = mesh_->vertices.col(mesh_->triangles(k, order_[place]));
    return t;
}

// Halves by the number of triangles, across the longest side of their centres' box.
void Workpiece::build(std::uint32_t node, std::uint32_t first, std::uint32_t count, const Eigen::Matrix3Xd& centres)
{
    Eigen::AlignedBox3d box, of_centres;
    for (std::uint32_t i = first; i < first + count; ++i) {
        const Triangle t = corners(i);
        for (int k = 0; k < 3; ++k) box.extend(t.col(k));
        of_centres.extend(centres.col(order_[i]));
    }
    nodes_[node].box = box;
    if (count <= kLeaf) {
        nodes_[node].first = first;
        nodes_[node].count = count;
        return;
    }
    Eigen::Index axis = 0;
    of_centres.sizes().maxCoeff(&axis);
    const std::uint32_t half = count / 2;
    std::nth_element(order_.begin() + first, order_.begin() + first + half, order_.begin() + first + count,
                     [&](std::uint32_t a, std::uint32_t b) {
                         return std::pair(centres(axis, a), a) < std::pair(centres(axis, b), b);
                     });
    const auto children = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].first = children;
    nodes_.resize(nodes_.size() + 2);
    build(children, first, half, centres);
    build(children + 1, first + half, count - half, centres);
}

// By the winding number: whole turns of the surface around the point.
bool Workpiece::holds(const Vector3d& point) const
{
    if (!nodes_[0].box.contains(point)) return false;
    double angle = 0;
    for (std::uint32_t i = 0; i < order_.size(); ++i) angle += solid_angle(corners(i), point);
    return std::abs(angle) > 2 * std::numbers::pi; // half a turn, 4 pi being a whole one
}

Workpiece::Nearest Workpiece::nearest(const PlacedSolid& body, double beyond) const
{
    Nearest best;
    best.clearance.distance = beyond;
    const Eigen::AlignedBox3d around = body.box();
    std::vector<std::pair<double, std::uint32_t>> waiting = {{0, 0}};
    while (!waiting.empty()) {
        const auto [squared, index] = waiting.back();
        waiting.pop_back();
        const double reach = std::max(best.clearance.distance, 0.0);
        if (squared > reach * reach) continue;
        const Node& node = nodes_[index];
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const Clearance c = clearance(body, PlacedSolid(corners(i)), best.clearance.distance);
            if (c.distance >= best.clearance.distance) continue;
            best.clearance = c;
            best.triangle = order_[i];
        }
        if (node.count > 0) continue;
        std::pair<double, std::uint32_t> child[2];
        for (std::uint32_t k = 0; k < 2; ++k)
            child[k] = {squared_apart(around, nodes_[node.first + k].box), node.first + k};
        if (child[0].first < child[1].first) std::swap(child[0], child[1]); // the nearer one is visited first
        waiting.insert(waiting.end(), std::begin(child), std::end(child));
    }
    if (closed_ && best.clearance.distance > 0 && nodes_[0].box.contains(around) &&
        holds(body.farthest(Vector3d::UnitZ()))) {
        if (best.triangle < 0) return nearest(body); // how far out it is must be told
        best.inside = true;
        best.clearance.distance = -best.clearance.distance;
    }
    return best;
}

} // namespace fettle
