#include "robot/workpiece.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace fettle {

namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kLeaf = 4; // triangles; a distance to one costs about as much as a few boxes

// Distances are told to this, mm.
constexpr double kDistanceTolerance = 1e-9;
// Depths inside cylinders, cones, boxes and hulls are told to this, mm, a tenth of what machining asks for: where the
// way out changes sides, every halving costs twice as many pieces.
constexpr double kDepthTolerance = 1e-3;

// No point of the box is nearer: the distance from a convex body lies above its tangent planes.
double lower_bound(const PlacedSolid& body, const Eigen::AlignedBox3d& box)
{
    const PointDistance at = body.distance(box.center());
    return at.value - at.gradient.cwiseAbs().dot(box.sizes()) / 2;
}

void take(const PlacedSolid& body, const Vector3d& point, Clearance& best, bool& nearer)
{
    const PointDistance at = body.distance(point);
    if (!(at.value < best.distance)) return;
    best = {at.value, at.gradient, point - at.value * at.gradient, point};
    nearer = true;
}

// No point of the triangle is nearer, by the tangent plane at its middle. The corner that is nearest by it is tried.
double lower_bound(const PlacedSolid& body, const Triangle& t, Clearance& best, bool& nearer)
{
    const Vector3d middle = t.rowwise().mean();
    const PointDistance at = body.distance(middle);
    Eigen::Index corner = 0;
    const double slope = (at.gradient.transpose() * (t.colwise() - middle)).minCoeff(&corner);
    if (at.value + slope < best.distance) take(body, t.col(corner), best, nearer);
    return at.value + slope;
}

// The deepest point of a triangle, by halving its sides where a tangent plane leaves room for a deeper one than is
// known.
void find_deepest(const PlacedSolid& body, const Triangle& whole, Clearance& best, bool& nearer)
{
    std::vector<Triangle> waiting = {whole};
    while (!waiting.empty()) {
        const Triangle t = waiting.back();
        waiting.pop_back();
        if (lower_bound(body, t, best, nearer) >= best.distance - kDepthTolerance) continue;
        const Vector3d a = (t.col(1) + t.col(2)) / 2, b = (t.col(2) + t.col(0)) / 2, c = (t.col(0) + t.col(1)) / 2;
        Triangle part;
        for (const auto& corners :
             {std::array<Vector3d, 3>{t.col(0), c, b}, {c, t.col(1), a}, {b, a, t.col(2)}, {a, b, c}}) {
            part << corners[0], corners[1], corners[2];
            waiting.push_back(part);
        }
    }
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

Workpiece::Workpiece(const Mesh& mesh) : mesh_(&mesh), closed_(is_closed(mesh)), rays_(mesh)
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

// A ray out of a closed mesh first meets a triangle from behind. One that only grazes it is drawn again.
bool Workpiece::holds(const Vector3d& point) const
{
    constexpr double kGrazing = 1e-6;
    for (const Vector3d& direction : {Vector3d::UnitZ().eval(), Vector3d(0.8, 0, 0.6), Vector3d(-0.36, 0.48, 0.8)}) {
        const auto hit = rays_.cast(point, direction);
        if (!hit) return false;
        const Eigen::Vector3i t = mesh_->triangles.col(hit->triangle);
        const Vector3d a = mesh_->vertices.col(t[0]), b = mesh_->vertices.col(t[1]), c = mesh_->vertices.col(t[2]);
        const Vector3d normal = (b - a).cross(c - a);
        const double along = normal.dot(direction);
        if (std::abs(along) > kGrazing * normal.norm()) return along > 0;
    }
    return false;
}

void Workpiece::look_at(const PlacedSolid& body, std::uint32_t place, Nearest& best) const
{
    const Triangle t = corners(place);
    bool nearer = false;
    const double bound = lower_bound(body, t, best.clearance, nearer);
    if (bound < best.clearance.distance - kDistanceTolerance) {
        // Outside the core the distance to the triangle is exact, also where the solid about the core overlaps it.
        const bool beside_core = best.clearance.distance > -body.radius();
        const Clearance c = beside_core ? clearance(body, PlacedSolid(t), best.clearance.distance) : Clearance{};
        if (!beside_core || c.distance <= -body.radius()) {
            find_deepest(body, t, best.clearance, nearer);
        } else if (c.distance < best.clearance.distance) {
            best.clearance = c;
            nearer = true;
        }
    }
    if (nearer) best.triangle = order_[place];
}

Workpiece::Nearest Workpiece::nearest(const PlacedSolid& body, double beyond) const
{
    Nearest best;
    best.clearance.distance = beyond;
    const Eigen::AlignedBox3d around = body.box();
    std::vector<std::pair<double, std::uint32_t>> waiting = {{lower_bound(body, nodes_[0].box), 0}};
    while (!waiting.empty()) {
        const auto [bound, index] = waiting.back();
        waiting.pop_back();
        if (bound >= best.clearance.distance) continue;
        const Node& node = nodes_[index];
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) look_at(body, i, best);
        if (node.count > 0) continue;
        std::pair<double, std::uint32_t> child[2];
        for (std::uint32_t k = 0; k < 2; ++k)
            child[k] = {lower_bound(body, nodes_[node.first + k].box), node.first + k};
        if (child[0].first < child[1].first) std::swap(child[0], child[1]); // the nearer one is visited first
        for (const auto& c : child)
            if (c.first < best.clearance.distance) waiting.push_back(c);
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
