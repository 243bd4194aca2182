#include "robot/round_solid.h"

#include "core/constants.h"

#include <algorithm>
#include <cmath>

namespace fettle::robot {

namespace {

using Eigen::Vector2d, Eigen::Vector3d;

// Tangents find kinks, secants of the slope find smooth minima: in turns they take some six steps.
constexpr int kMaxMinimisationSteps = 60;

/// The point nearest to the axis in a horizontal slice of the triangle.
struct Slice {
    double value; ///< signed distance of the point, mm
    double slope; ///< derivative of the value with respect to t
    ProfileDistance profile;
    Vector3d point; ///< in the solid's frame
};

/// A part of a triangle between two sides, with horizontal slices between them from t = 0 to 1.
struct Strip {
    Vector3d left, right;             ///< start points of the sides
    Vector3d along_left, along_right; ///< from these to the end points

    Slice at(const RoundSolid& solid, double t) const
    {
        const Vector3d p = left + t * along_left, across = right + t * along_right - p;
        const double width2 = across.head<2>().squaredNorm();
        const double u = width2 > 0 ? std::clamp(-p.head<2>().dot(across.head<2>()) / width2, 0.0, 1.0) : 0.0;
        const Vector3d point = p + u * across, tangent = along_left + u * (along_right - along_left);
        const double r = point.head<2>().norm();
        const ProfileDistance profile = profile_distance(solid, r, point.z());
        const double dr_dt = r > 0 ? tangent.head<2>().dot(point.head<2>()) / r : 0.0;
        return {profile.value, profile.gradient_r * dr_dt + profile.gradient_z * tangent.z(), profile, point};
    }
};

/// The slice with the minimum distance among those that were offered.
class MinimumSearch {
  public:
    MinimumSearch(const RoundSolid& solid, double upper_bound) : solid_(solid), min_(upper_bound) {}

    void offer(const Slice& slice)
    {
        if (!(slice.value < min_)) return;
        min_ = slice.value;
        best_ = slice;
    }

    /// Minimises over a strip between the slices `a` at t = 0 and `b` at t = 1, which have been offered.
    void minimise(const Strip& strip, Slice a, Slice b)
    {
        double from = 0, to = 1;
        for (int step = 0; step < kMaxMinimisationSteps; ++step) {
            // A convex function without a change of the slope's sign has its minimum at an end.
            if (!(a.slope < 0 && b.slope > 0)) return;
            const double tangents_meet = (b.value - a.value + a.slope * from - b.slope * to) / (a.slope - b.slope);
            if (a.value + a.slope * (tangents_meet - from) >= min_ - kFootAccuracy) return;
            const double secant_zero = from + (to - from) * a.slope / (a.slope - b.slope);
            const double t = step % 2 == 0 ? tangents_meet : secant_zero;
            if (!(t > from && t < to)) return; // the interval is down to rounding
            const Slice c = strip.at(solid_, t);
            offer(c);
            if (c.slope > 0) {
                b = c;
                to = t;
            } else {
                a = c;
                from = t;
            }
        }
    }

    const std::optional<Slice>& best() const { return best_; }

  private:
    const RoundSolid& solid_;
    double min_;
    std::optional<Slice> best_;
};

// Gradient in space at a point of the solid's frame; `on_axis` is the radial direction for a point on the axis.
Vector3d gradient_at(const ProfileDistance& profile, const Vector3d& point, const Vector3d& on_axis)
{
    const double r = point.head<2>().norm();
    const Vector3d radial = r > 0 ? Vector3d(point.x() / r, point.y() / r, 0) : on_axis;
    return profile.gradient_r * radial + profile.gradient_z * Vector3d::UnitZ();
}

// The slice at a corner is a point. Its slope is the steeper descent of those along the two sides.
Slice corner_slice(const RoundSolid& solid, const Vector3d& corner, const Vector3d& side, const Vector3d& other_side,
                   double sign)
{
    const ProfileDistance profile = profile_distance(solid, corner.head<2>().norm(), corner.z());
    const Vector3d gradient = gradient_at(profile, corner, Vector3d::Zero());
    const double slope = sign * std::min(sign * gradient.dot(side), sign * gradient.dot(other_side));
    return {profile.value, slope, profile, corner};
}

/// The points of a segment and of a triangle that are nearest to each other, among those that were offered.
class SegmentSearch {
  public:
    SegmentSearch(const Vector3d& from, const Vector3d& to, const mesh::Triangle& triangle)
        : from_(from), along_(to - from), triangle_(triangle), e1_(triangle.col(1) - triangle.col(0)),
          e2_(triangle.col(2) - triangle.col(0)), normal_(e1_.cross(e2_))
    {
    }

    /// A lower bound of the distance from the triangle's plane; 0 if the segment crosses it.
    double plane_distance() const
    {
        const double a = height(from_), b = height(from_ + along_), length = normal_.norm();
        return a * b > 0 && length > 0 ? std::min(std::abs(a), std::abs(b)) / length : 0;
    }

    /// The nearest points are an end of the segment and its foot on the face, the point where the segment pierces the
    /// face, or lie on an edge.
    void search()
    {
        const double a = height(from_), b = height(from_ + along_);
        offer_face(0);
        offer_face(1);
        if (a * b < 0) offer_face(a / (a - b));
        for (int k = 0; k < 3; ++k) offer_edge(triangle_.col(k), triangle_.col((k + 1) % 3));
    }

    double squared_distance() const { return min_; }
    const Vector3d& on_segment() const { return on_segment_; }
    const Vector3d& on_triangle() const { return on_triangle_; }

  private:
    double height(const Vector3d& p) const { return (p - triangle_.col(0)).dot(normal_); } // times the normal's length

    void offer(double t, const Vector3d& on_triangle)
    {
        const Vector3d on_segment = from_ + t * along_;
        const double squared = (on_triangle - on_segment).squaredNorm();
        if (!(squared < min_)) return;
        min_ = squared;
        on_segment_ = on_segment;
        on_triangle_ = on_triangle;
    }

    // The foot of a point of the segment, if it lies on the face. It is composed of the corners, so that it is a point
    // of the triangle even where the normal of a needle is rounding alone.
    void offer_face(double t)
    {
        const Vector3d w = from_ + t * along_ - triangle_.col(0);
        const double squared = normal_.squaredNorm();
        const double u = w.cross(e2_).dot(normal_) / squared, v = e1_.cross(w).dot(normal_) / squared;
        if (u >= 0 && v >= 0 && u + v <= 1) offer(t, triangle_.col(0) + u * e1_ + v * e2_);
    }

    // Nearest points of two segments (Ericson 2005, 5.1.9). Of parallel ones any pair that faces each other will do.
    void offer_edge(const Vector3d& p, const Vector3d& q)
    {
        const Vector3d edge = q - p, r = from_ - p;
        const double aa = along_.squaredNorm(), ee = edge.squaredNorm(), ae = along_.dot(edge);
        const double ar = along_.dot(r), er = edge.dot(r), denominator = aa * ee - ae * ae;
        const auto along_share = [&](double s) { return aa > 0 ? std::clamp((s * ae - ar) / aa, 0.0, 1.0) : 0.0; };
        double t = denominator > 0 ? std::clamp((ae * er - ar * ee) / denominator, 0.0, 1.0) : 0.0;
        const double s = ee > 0 ? std::clamp((er + t * ae) / ee, 0.0, 1.0) : 0.0;
        t = along_share(s);
        offer(t, p + s * edge);
    }

    const Vector3d from_, along_;
    const mesh::Triangle& triangle_;
    const Vector3d e1_, e2_, normal_; ///< two sides, and their cross product
    double min_ = core::kInfinity;    ///< squared distance, mm²
    Vector3d on_segment_, on_triangle_;
};

// The nearest point of a capsule or a sphere has a closed form, and most triangles are excluded by their planes.
std::optional<TriangleFoot> nearest_to_capsule(const RoundSolid& capsule, const mesh::Triangle& triangle,
                                               double upper_bound)
{
    const Vector3d axis = capsule.T.linear().col(2), from = capsule.T.translation();
    SegmentSearch nearest(from, from + capsule.length * axis, triangle);
    if (nearest.plane_distance() - capsule.rounding >= upper_bound) return std::nullopt;
    nearest.search();
    const double length = std::sqrt(nearest.squared_distance()), distance = length - capsule.rounding;
    if (!(distance < upper_bound - kFootAccuracy)) return std::nullopt;
    const Vector3d gradient = length > 0 ? Vector3d((nearest.on_triangle() - nearest.on_segment()) / length)
                                         : Vector3d(capsule.T.linear().col(0));
    return TriangleFoot{distance, gradient, nearest.on_triangle()};
}

} // namespace

ProfileDistance profile_distance(const RoundSolid& solid, double r, double z)
{
    const double below = -z, above = z - solid.length; // signed distances from the planes of the ends
    if (solid.radius_from == solid.radius_to) {
        const double from_side = r - solid.radius_from, from_end = std::max(below, above);
        const double sign = above > below ? 1 : -1;
        if (from_end > 0 && from_side > 0) {
            const double value = std::sqrt(from_end * from_end + from_side * from_side);
            return {value - solid.rounding, from_side / value, sign * from_end / value};
        }
        if (from_end > from_side) return {from_end - solid.rounding, 0, sign};
        return {from_side - solid.rounding, 1, 0};
    }
    const double taper = solid.radius_from - solid.radius_to, side = std::hypot(solid.length, taper);
    const Vector2d normal(solid.length / side, taper / side); // outward, of the slanted side
    const double from_side = (r - solid.radius_from) * normal.x() + z * normal.y();
    if (below <= 0 && above <= 0 && from_side <= 0) {
        if (from_side >= below && from_side >= above) return {from_side - solid.rounding, normal.x(), normal.y()};
        return below >= above ? ProfileDistance{below - solid.rounding, 0, -1}
                              : ProfileDistance{above - solid.rounding, 0, 1};
    }
    if (below > 0 && r <= solid.radius_from) return {below - solid.rounding, 0, -1};
    if (above > 0 && r <= solid.radius_to) return {above - solid.rounding, 0, 1};
    const Vector2d along_side(-taper, solid.length), from(r - solid.radius_from, z);
    const Vector2d off = from - std::clamp(from.dot(along_side) / (side * side), 0.0, 1.0) * along_side;
    const double value = off.norm();
    if (!(value > 0)) return {-solid.rounding, normal.x(), normal.y()};
    return {value - solid.rounding, off.x() / value, off.y() / value};
}

std::optional<TriangleFoot> nearest_point_of_triangle(const RoundSolid& solid, const mesh::Triangle& triangle,
                                                      double upper_bound)
{
    if (solid.radius_from == 0 && solid.radius_to == 0) return nearest_to_capsule(solid, triangle, upper_bound);
    const mesh::Triangle local = solid.T.linear().transpose() * (triangle.colwise() - Vector3d(solid.T.translation()));
    int low = 0, high = 0;
    for (int k = 1; k < 3; ++k) {
        if (local(2, k) < local(2, low)) low = k;
        if (local(2, k) >= local(2, high)) high = k;
    }
    const Vector3d a = local.col(low), b = local.col(3 - low - high), c = local.col(high);
    const double rise = c.z() - a.z();
    const double share = rise > 0 ? std::clamp((b.z() - a.z()) / rise, 0.0, 1.0) : 0.0;
    const Vector3d opposite = a + share * (c - a); // on the long side, at the height of the middle corner
    const Strip lower = {a, a, opposite - a, b - a}, upper = {opposite, b, c - opposite, c - b};
    MinimumSearch search(solid, upper_bound);
    const Slice from_below = lower.at(solid, 1), from_above = upper.at(solid, 0);
    search.offer(from_below);
    if (from_below.slope > 0 && from_below.value - from_below.slope < upper_bound - kFootAccuracy) {
        const Slice start = corner_slice(solid, a, lower.along_left, lower.along_right, 1);
        search.offer(start);
        search.minimise(lower, start, from_below);
    }
    if (from_above.slope < 0 && from_above.value + from_above.slope < upper_bound - kFootAccuracy) {
        const Slice end = corner_slice(solid, c, upper.along_left, upper.along_right, -1);
        search.offer(end);
        search.minimise(upper, from_above, end);
    }
    if (!search.best()) return std::nullopt;
    const Slice& best = *search.best();
    const Vector3d gradient = gradient_at(best.profile, best.point, Vector3d::UnitX());
    return TriangleFoot{best.value, solid.T.linear() * gradient, solid.T * best.point};
}

} // namespace fettle::robot
