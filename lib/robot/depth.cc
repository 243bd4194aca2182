#include "robot/depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace fettle::robot {

namespace {

using Eigen::Vector3d;

constexpr int kMaxExpansions = 500;
// The expansion ends when the upper and lower bound of the depth differ by no more, mm: between curved solids every
// halving costs a few faces.
constexpr double kDepthTolerance = 1e-7;
// A point no farther in front of a face counts as in its plane, mm: rounding of a body 1 m away is a thousandth of it.
constexpr double kCoplanarTolerance = kDepthTolerance / 1000;
// A tetrahedron flatter than this fraction of its size has no inside. Also the smallest step of a descent, rad.
constexpr double kFlatnessTolerance = 1e-12;

struct Face {
    int corner[3];
    Vector3d normal;     // unit, outward
    double distance = 0; // of its plane from the origin, mm
};

// A growing convex polytope that contains the origin and is part of the Minkowski difference of the cores.
class Polytope {
  public:
    Polytope(const PlacedSolid& a, const PlacedSolid& b) : a_(a), b_(b) {}

    DifferencePoint support(const Vector3d& direction) const { return difference_support(a_, b_, direction); }

    /// Completes a simplex to a tetrahedron.
    /// @return  if the difference has no inside, a direction in which it is flat
    std::optional<Vector3d> initialise(const Simplex& simplex)
    {
        points_.assign(simplex.point.begin(), simplex.point.begin() + simplex.count);
        const double size =
            std::max({1.0, extent(Vector3d::UnitX()), extent(Vector3d::UnitY()), extent(Vector3d::UnitZ())});
        while (points_.size() < 4) {
            const std::vector<Vector3d> directions = independent_directions();
            if (!std::ranges::any_of(directions, [&](const Vector3d& d) { return add_point_along(d, size); }))
                return directions.front();
        }
        const Vector3d u = points_[1].w - points_[0].w, v = points_[2].w - points_[0].w,
                       w = points_[3].w - points_[0].w;
        if (u.cross(v).dot(w) < 0) std::swap(points_[1], points_[2]);
        for (const auto& f : {std::array<int, 3>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}) add_face(f[0], f[1], f[2]);
        return std::nullopt;
    }

    const Face& nearest_face() const { return faces_[nearest_index()]; }

    /// Adds a point in front of the nearest face: replaces the visible faces by faces from their horizon to the point.
    /// The visible faces are taken as one connected patch about the nearest face even where rounding says otherwise.
    /// @return  false if the point is in the polytope already, to rounding
    bool expand(const DifferencePoint& p)
    {
        std::vector<bool> is_visible(faces_.size(), false);
        std::vector<std::size_t> visible = {nearest_index()};
        if (!is_in_front(p.w, faces_[visible.front()])) return false;
        is_visible[visible.front()] = true;
        std::vector<std::pair<int, int>> horizon;
        for (std::size_t k = 0; k < visible.size(); ++k) {
            const Face face = faces_[visible[k]];
            for (int side = 0; side < 3; ++side) {
                const int from = face.corner[side], to = face.corner[(side + 1) % 3];
                const std::size_t neighbour = face_with_side(to, from);
                if (neighbour == faces_.size() || (!is_visible[neighbour] && !is_in_front(p.w, faces_[neighbour]))) {
                    horizon.emplace_back(from, to);
                } else if (!is_visible[neighbour]) {
                    is_visible[neighbour] = true;
                    visible.push_back(neighbour);
                }
            }
        }
        std::size_t kept = 0;
        for (std::size_t i = 0; i < faces_.size(); ++i)
            if (!is_visible[i]) faces_[kept++] = faces_[i];
        faces_.resize(kept);
        points_.push_back(p);
        for (const auto& [from, to] : horizon) add_face(from, to, points_.size() - 1);
        return true;
    }

    /// The point of the surface that is nearest to the origin. It lies in one of the faces in the nearest face's plane.
    Simplex foot() const
    {
        const double max_distance = nearest_face().distance + kDepthTolerance;
        Simplex best;
        double min = std::numeric_limits<double>::infinity();
        for (const Face& face : faces_) {
            if (face.distance > max_distance) continue;
            Simplex simplex;
            for (const int corner : face.corner) simplex.add(points_[corner]);
            reduce(simplex);
            const double squared = simplex.nearest().squaredNorm();
            if (squared < min) {
                min = squared;
                best = simplex;
            }
        }
        return best;
    }

  private:
    std::size_t nearest_index() const { return std::ranges::min_element(faces_, {}, &Face::distance) - faces_.begin(); }

    bool is_in_front(const Vector3d& w, const Face& face) const
    {
        return face.normal.dot(w - points_[face.corner[0]].w) > kCoplanarTolerance;
    }

    /// The face with that directed side; faces_.size() if there is none.
    std::size_t face_with_side(int from, int to) const
    {
        const auto has = [&](const Face& face) {
            for (int side = 0; side < 3; ++side)
                if (face.corner[side] == from && face.corner[(side + 1) % 3] == to) return true;
            return false;
        };
        return std::ranges::find_if(faces_, has) - faces_.begin();
    }

    double extent(const Vector3d& direction) const
    {
        return (support(direction).w - support(-direction).w).dot(direction);
    }

    /// Adds the support point along a direction or against it, if it is off the plane through the first point.
    bool add_point_along(const Vector3d& direction, double size)
    {
        for (const double sign : {1.0, -1.0}) {
            const DifferencePoint p = support(sign * direction);
            if (std::abs((p.w - points_[0].w).dot(direction)) <= kFlatnessTolerance * size) continue;
            points_.push_back(p);
            return true;
        }
        return false;
    }

    /// Directions at right angles to the point, line or plane of one to three points.
    std::vector<Vector3d> independent_directions() const
    {
        if (points_.size() == 1) return {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
        const Vector3d u = points_[1].w - points_[0].w;
        if (points_.size() == 2) {
            const Vector3d across = u.unitOrthogonal();
            return {across, u.normalized().cross(across)};
        }
        return {u.cross(points_[2].w - points_[0].w).normalized()};
    }

    void add_face(int i, int j, int k)
    {
        const Vector3d &p = points_[i].w, &q = points_[j].w, &r = points_[k].w;
        const Vector3d n = (q - p).cross(r - p);
        const double length = n.norm();
        // A needle has no plane; its neighbours bound the polytope there.
        const Vector3d normal = length > 0 ? Vector3d(n / length) : Vector3d::Zero();
        faces_.push_back({{i, j, k}, normal, length > 0 ? normal.dot(p) : std::numeric_limits<double>::infinity()});
    }

    const PlacedSolid &a_, &b_;
    std::vector<DifferencePoint> points_;
    std::vector<Face> faces_;
};

Clearance touching(const Simplex& simplex, const Vector3d& normal)
{
    return {0, normal, simplex.on_a(), simplex.on_b()};
}

// A local minimum of the support function of the difference near a direction, by gradient descent. Needed where so many
// directions are equally good that each would need a face (an axis about which both solids are round).
Vector3d minimise_support(const Polytope& polytope, Vector3d normal)
{
    constexpr int kMaxDescents = 200;
    DifferencePoint p = polytope.support(normal);
    double step = 1;
    for (int k = 0; k < kMaxDescents && step > kFlatnessTolerance; ++k) {
        const Vector3d gradient = p.w - normal.dot(p.w) * normal;
        const double steepness = gradient.norm();
        if (steepness == 0) break;
        const Vector3d candidate = (normal - step * gradient / steepness).normalized();
        const DifferencePoint q = polytope.support(candidate);
        if (candidate.dot(q.w) < normal.dot(p.w)) {
            normal = candidate;
            p = q;
        } else {
            step /= 2;
        }
    }
    return normal;
}

} // namespace

// The nearest face bounds the depth from below, the supporting plane along its normal from above.
Clearance core_depth(const PlacedSolid& a, const PlacedSolid& b, const Simplex& around_origin)
{
    Polytope polytope(a, b);
    if (const auto flat = polytope.initialise(around_origin)) return touching(around_origin, *flat);
    for (int step = 0;; ++step) {
        const Face face = polytope.nearest_face();
        const DifferencePoint next = polytope.support(face.normal);
        const double upper = std::max(face.normal.dot(next.w), 0.0);
        const bool converged = upper - face.distance <= kDepthTolerance;
        if (!converged && step < kMaxExpansions && polytope.expand(next)) continue;
        // b - a reaches as far as `upper` along the normal: b leaves a when moved against the normal by as much.
        const Simplex foot = polytope.foot();
        if (converged) return {-upper, -face.normal, foot.on_a(), foot.on_b()};
        const Vector3d normal = minimise_support(polytope, face.normal);
        const double depth = std::max(normal.dot(polytope.support(normal).w), 0.0);
        return {-depth, -normal, foot.on_a(), foot.on_a() + depth * normal};
    }
}

} // namespace fettle::robot
