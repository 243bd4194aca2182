#include "robot/workpiece.h"

#include "mesh/box_tree.h"
#include "mesh/closed.h"

#include <cmath>

namespace fettle::robot {

namespace {

using Eigen::Vector3d;

// Six times the volume that the triangles enclose, about a point near them; negative if they are inside out.
double enclosed_volume(const mesh::Mesh& mesh)
{
    double volume = 0;
    if (mesh.triangles.cols() == 0) return volume;
    const Vector3d origin = mesh::triangle_of(mesh, 0).col(0);
    for (Eigen::Index i = 0; i < mesh.triangles.cols(); ++i) {
        const mesh::Triangle t = mesh::triangle_of(mesh, i).colwise() - origin;
        volume += t.col(0).cross(t.col(1)).dot(t.col(2));
    }
    return volume;
}

} // namespace

Workpiece::Workpiece(const mesh::Mesh& mesh)
    : closed_(mesh::is_closed(mesh)), outwards_(enclosed_volume(mesh) < 0 ? -1 : 1), index_(mesh)
{
}

// A ray from inside a closed mesh first hits a triangle from behind. A grazing hit decides nothing: another ray is
// cast.
bool Workpiece::is_inside(const Nearest& nearest, const Vector3d& point) const
{
    if (nearest.triangle >= 0) {
        // If the nearest point is away from the triangle's edges, the side of its plane decides.
        constexpr double kMinBarycentric = 1e-3;
        const mesh::Triangle t = mesh::triangle_of(mesh(), nearest.triangle);
        const mesh::TrianglePoint foot = mesh::closest_on_triangle(t, nearest.clearance.on_b);
        if (foot.barycentric.minCoeff() > kMinBarycentric)
            return outwards_ * (t.col(1) - t.col(0)).cross(t.col(2) - t.col(0)).dot(nearest.clearance.normal) > 0;
    }
    constexpr double kMinSineToPlane = 1e-6;
    for (const Vector3d& direction : {Vector3d::UnitZ().eval(), Vector3d(0.8, 0, 0.6), Vector3d(-0.36, 0.48, 0.8)}) {
        const auto hit = index_.cast(point, direction);
        if (!hit) return false;
        const mesh::Triangle t = mesh::triangle_of(mesh(), hit->triangle);
        const Vector3d normal = (t.col(1) - t.col(0)).cross(t.col(2) - t.col(0));
        const double along = normal.dot(direction);
        if (std::abs(along) > kMinSineToPlane * normal.norm()) return outwards_ * along > 0;
    }
    return false;
}

bool Workpiece::contains(const Vector3d& point) const
{
    return closed_ && index_.tree().box.contains(point) && is_inside({}, point);
}

Workpiece::Nearest Workpiece::nearest_of(const PlacedSolid& body, double max_distance,
                                         const std::function<bool(Eigen::Index)>& is_selected) const
{
    Nearest best{.clearance = {.distance = max_distance}};
    search(body, &is_selected, best);
    return best;
}

Workpiece::Nearest Workpiece::nearest_of_surface(const PlacedSolid& body, double max_distance,
                                                 std::uint32_t start_leaf) const
{
    Nearest best{.clearance = {.distance = max_distance}, .leaf = start_leaf};
    search(body, nullptr, best);
    return best;
}

Workpiece::LowerBound Workpiece::lower_bound(const PlacedSolid& body, double max_distance,
                                             std::uint32_t start_leaf) const
{
    Nearest best{.clearance = {.distance = max_distance}, .leaf = start_leaf};
    search(body, nullptr, best, true);
    return {best.clearance.distance, best.leaf};
}

Workpiece::Nearest Workpiece::nearest(const PlacedSolid& body, double max_distance, std::uint32_t start_leaf) const
{
    Nearest best = nearest_of_surface(body, max_distance, start_leaf);
    // A body that touches the surface is not completely inside; but a sphere's depth depends on where its centre is.
    const bool touches = best.triangle >= 0 && best.clearance.distance <= 0;
    if (!closed_ || (touches && !body.is_sphere())) return best;
    const Vector3d point = body.support(Vector3d::UnitZ());
    if (!index_.tree().box.contains(point) || !is_inside(best, point)) return best;
    if (best.triangle < 0) return nearest(body); // the depth exceeds max_distance: measured without that bound
    const Vector3d& n = best.clearance.normal;
    const double width = (body.support(n) - body.support(-n)).dot(n) + 2 * body.radius();
    best.inside = true;
    make_penetration(best.clearance, width);
    return best;
}

} // namespace fettle::robot
