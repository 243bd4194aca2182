#include "robot/depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace fettle {

namespace {

using Eigen::Vector3d;

constexpr int kMostSteps = 500;
// Upper and lower bound of a depth agree to within this, mm: between curved solids every halving costs a few faces.
constexpr double kDepthTolerance = 1e-7;
// A point that is no farther before a face lies in its plane, mm: roundings of a body 1 m away are a thousandth of it.
constexpr double kSeen = kDepthTolerance / 1000;
// A tetrahedron flatter than this share of its size has no inside.
constexpr double kFlat = 1e-12;

struct Face {
    int corner[3];
    Vector3d normal;     // unit, outwards
    double distance = 0; // of its plane from the origin
};

// A convex polytope inside the difference of the cores, around the origin, that grows.
class Polytope {
  public:
    Polytope(const PlacedSolid& a, const PlacedSolid& b) : a_(a), b_(b) {}

    DifferencePoint farthest(const Vector3d& direction) const { return farthest_difference(a_, b_, direction); }

    /// A direction in which the difference is flat, if it has no inside; else the polytope is a tetrahedron.
    std::optional<Vector3d> begin(const Simplex& simplex)
    {
        for (int i = 0; i < simplex.count; ++i) points_.push_back(simplex.point[static_cast<std::size_t>(i)]);
        const double size =
            std::max({1.0, extent(Vector3d::UnitX()), extent(Vector3d::UnitY()), extent(Vector3d::UnitZ())});
        while (points_.size() < 4) {
            const std::vector<Vector3d> directions = outwards();
            bool grown = false;
            for (const Vector3d& direction : directions) {
                for (const double sign : {1.0, -1.0}) {
                    const DifferencePoint p = farthest(sign * direction);
                    if (std::abs((p.w - points_[0].w).dot(direction)) <= kFlat * size) continue;
                    points_.push_back(p);
                    grown = true;
                    break;
                }
                if (grown) break;
            }
            if (!grown) return directions.front();
        }
        const Vector3d u = points_[1].w - points_[0].w, v = points_[2].w - points_[0].w,
                       w = points_[3].w - points_[0].w;
        if (u.cross(v).dot(w) < 0) std::swap(points_[1], points_[2]);
        for (const auto& f : {std::array<int, 3>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}) add_face(f[0], f[1], f[2]);
        return std::nullopt;
    }

    const Face& nearest_face() const { return faces_[nearest_index()]; }

    /// Takes in a point beyond the nearest face. The faces that it sees are one connected patch about that face, also
    /// where roundings say otherwise. @return  false if it is in it already, to the last digits
    bool grow(const DifferencePoint& p)
    {
        std::vector<bool> seen(faces_.size(), false);
        std::vector<std::size_t> patch = {nearest_index()};
        if (!sees(p.w, faces_[patch.front()])) return false;
        seen[patch.front()] = true;
        std::vector<std::pair<int, int>> rim;
        for (std::size_t k = 0; k < patch.size(); ++k) {
            const Face face = faces_[patch[k]];
            for (int side = 0; side < 3; ++side) {
                const int from = face.corner[side], to = face.corner[(side + 1) % 3];
                const std::size_t beside = face_with_side(to, from);
                if (beside == faces_.size() || (!seen[beside] && !sees(p.w, faces_[beside]))) {
                    rim.emplace_back(from, to);
                } else if (!seen[beside]) {
                    seen[beside] = true;
                    patch.push_back(beside);
                }
            }
        }
        std::size_t kept = 0;
        for (std::size_t i = 0; i < faces_.size(); ++i)
            if (!seen[i]) faces_[kept++] = faces_[i];
        faces_.resize(kept);
        points_.push_back(p);
        for (const auto& [from, to] : rim) add_face(from, to, static_cast<int>(points_.size()) - 1);
        return true;
    }

    /// The point of the surface that is nearest to the origin, on both bodies: in one of the faces that lie in the
    /// nearest one's plane.
    Simplex foot() const
    {
        const double most = nearest_face().distance + kDepthTolerance;
        Simplex best;
        double least = std::numeric_limits<double>::infinity();
        for (const Face& face : faces_) {
            if (face.distance > most) continue;
            Simplex simplex;
            for (const int corner : face.corner) simplex.add(points_[static_cast<std::size_t>(corner)]);
            reduce(simplex);
            const double squared = simplex.nearest().squaredNorm();
            if (squared < least) {
                least = squared;
                best = simplex;
            }
        }
        return best;
    }

  private:
    std::size_t nearest_index() const
    {
        const auto nearer = [](const Face& f, const Face& g) { return f.distance < g.distance; };
        return static_cast<std::size_t>(std::min_element(faces_.begin(), faces_.end(), nearer) - faces_.begin());
    }

    bool sees(const Vector3d& w, const Face& face) const
    {
        return face.normal.dot(w - points_[static_cast<std::size_t>(face.corner[0])].w) > kSeen;
    }

    std::size_t face_with_side(int from, int to) const
    {
        const auto has = [&](const Face& face) {
            for (int side = 0; side < 3; ++side)
                if (face.corner[side] == from && face.corner[(side + 1) % 3] == to) return true;
            return false;
        };
        return static_cast<std::size_t>(std::find_if(faces_.begin(), faces_.end(), has) - faces_.begin());
    }

    double extent(const Vector3d& direction) const
    {
        return (farthest(direction).w - farthest(-direction).w).dot(direction);
    }

    // Where the next point of a tetrahedron may lie: across what there is.
    std::vector<Vector3d> outwards() const
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
        const Vector3d &p = points_[static_cast<std::size_t>(i)].w, &q = points_[static_cast<std::size_t>(j)].w,
                       &r = points_[static_cast<std::size_t>(k)].w;
        const Vector3d n = (q - p).cross(r - p);
        const double length = n.norm();
        // A needle bounds nothing; its neighbours do.
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

// The least reach of the difference about a direction, by steps down its slope: where so many directions are as good
// that faces would be needed for all of them (an axis about which both are round).
Vector3d least_reach(const Polytope& polytope, Vector3d normal)
{
    constexpr int kMostDescents = 200;
    DifferencePoint p = polytope.farthest(normal);
    double length = 1;
    for (int k = 0; k < kMostDescents && length > kFlat; ++k) {
        const Vector3d slope = p.w - normal.dot(p.w) * normal;
        const double steepness = slope.norm();
        if (steepness == 0) break;
        const Vector3d tried = (normal - length * slope / steepness).normalized();
        const DifferencePoint there = polytope.farthest(tried);
        if (tried.dot(there.w) < normal.dot(p.w)) {
            normal = tried;
            p = there;
        } else {
            length /= 2;
        }
    }
    return normal;
}

} // namespace

// The nearest face bounds the depth from below, the plane of the farthest point along its normal from above.
Clearance core_depth(const PlacedSolid& a, const PlacedSolid& b, const Simplex& around_origin)
{
    Polytope polytope(a, b);
    if (const auto flat = polytope.begin(around_origin)) return touching(around_origin, *flat);
    for (int step = 0;; ++step) {
        const Face face = polytope.nearest_face();
        const DifferencePoint next = polytope.farthest(face.normal);
        const double upper = std::max(face.normal.dot(next.w), 0.0);
        const bool certain = upper - face.distance <= kDepthTolerance;
        if (!certain && step < kMostSteps && polytope.grow(next)) continue;
        // b - a reaches `upper` along the normal: b shifted against it by as much leaves a.
        const Simplex foot = polytope.foot();
        if (certain) return {-upper, -face.normal, foot.on_a(), foot.on_b()};
        const Vector3d normal = least_reach(polytope, face.normal);
        const double reach = std::max(normal.dot(polytope.farthest(normal).w), 0.0);
        return {-reach, -normal, foot.on_a(), foot.on_a() + reach * normal};
    }
}

} // namespace fettle
