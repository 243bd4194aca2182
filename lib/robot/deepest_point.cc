#include "robot/deepest_point.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace fettle::robot {

namespace {

using Eigen::Vector3d;

// Accuracy of depths inside boxes and hulls, mm: a tenth of that of clearances.
constexpr double kDepthAccuracy = kClearanceAccuracy / 10;

// The values at the corners of a triangle of a function that is linear on it.
using CornerValues = Vector3d;

// Keeps the part of a polygon, in barycentric coordinates, in which a linear function is not positive.
std::vector<Vector3d> clip_polygon(const std::vector<Vector3d>& polygon, const CornerValues& function)
{
    std::vector<Vector3d> kept;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vector3d &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
        const double at_p = function.dot(p), at_q = function.dot(q);
        if (at_p <= 0) kept.push_back(p);
        if ((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0)) kept.emplace_back((at_q * p - at_p * q) / (at_q - at_p));
    }
    return kept;
}

// Barycentric coordinates of the point where the largest of some linear functions is lowest. The newest function is to
// exceed the others where these alone were lowest: then it is among the largest there, too.
Vector3d lowest_point(const std::vector<CornerValues>& functions)
{
    const CornerValues& newest = functions.back();
    std::vector<Vector3d> polygon = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
    for (std::size_t i = 0; i + 1 < functions.size(); ++i) {
        std::vector<Vector3d> kept = clip_polygon(polygon, functions[i] - newest);
        if (kept.empty()) break; // by rounding
        polygon = std::move(kept);
    }
    return *std::ranges::min_element(polygon, {}, [&](const Vector3d& p) { return newest.dot(p); });
}

} // namespace

bool find_deepest(const PlacedSolid& body, const mesh::Triangle& triangle, Clearance& best)
{
    constexpr int kMaxPlanes = 500; // a dozen are usual; a round hull of thousands of facets takes some fifty
    bool improved = false;
    std::vector<CornerValues> planes;
    Vector3d at = Vector3d::Constant(1.0 / 3);
    for (int k = 0; k < kMaxPlanes; ++k) {
        const Vector3d point = triangle * at;
        const PointDistance d = body.signed_distance(point);
        if (d.value < best.distance) {
            best = {d.value, d.gradient, point - d.value * d.gradient, point};
            improved = true;
        }
        planes.emplace_back((triangle.colwise() - point).transpose() * d.gradient + Vector3d::Constant(d.value));
        at = lowest_point(planes);
        if (planes.back().dot(at) >= best.distance - kDepthAccuracy) break;
    }
    return improved;
}

} // namespace fettle::robot
