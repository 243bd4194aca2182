#include "robot/round_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle {

namespace {

using Eigen::Vector2d, Eigen::Vector3d;

// Tangents meet at kinks, secants of the slope at smooth minima: by turns they need some six steps.
constexpr int kMostSteps = 60;

/// Of one slice of the triangle the point nearest to the axis, and how fast the distance changes from slice to slice.
struct Slice {
    double value;
    double slope; ///< over t
    ProfileDistance profile;
    Vector3d point; ///< in the solid's frame
};

/// A part of a triangle between two sides that slices run across, from t = 0 to 1.
struct Strip {
    Vector3d left, right;             ///< where the sides begin
    Vector3d along_left, along_right; ///< to where they end

    Slice at(const RoundSolid& solid, double t) const
    {
        const Vector3d p = left + t * along_left, across = right + t * along_right - p;
        const double width2 = across.head<2>().squaredNorm();
        const double u = width2 > 0 ? std::clamp(-p.head<2>().dot(across.head<2>()) / width2, 0.0, 1.0) : 0.0;
        const Vector3d point = p + u * across, way = along_left + u * (along_right - along_left);
        const double r = point.head<2>().norm();
        const ProfileDistance profile = distance(solid, r, point.z());
        const double outwards = r > 0 ? way.head<2>().dot(point.head<2>()) / r : 0.0;
        return {profile.value, profile.along_r * outwards + profile.along_z * way.z(), profile, point};
    }
};

class Search {
  public:
    Search(const RoundSolid& solid, double below) : solid_(solid), least_(below) {}

    void take(const Slice& slice)
    {
        if (!(slice.value < least_)) return;
        least_ = slice.value;
        best_ = slice;
    }

    /// Looks through a strip that ends in slices `a` at t = 0 and `b` at t = 1.
    void look_through(const Strip& strip, Slice a, Slice b)
    {
        double from = 0, to = 1;
        for (int step = 0; step < kMostSteps; ++step) {
            // Falling towards an end, it is least there, and that has been looked at.
            if (!(a.slope < 0 && b.slope > 0)) return;
            const double meet = (b.value - a.value + a.slope * from - b.slope * to) / (a.slope - b.slope);
            if (a.value + a.slope * (meet - from) >= least_ - kFootTolerance) return;
            const double flat = from + (to - from) * a.slope / (a.slope - b.slope);
            const double t = step % 2 == 0 ? meet : flat;
            if (!(t > from && t < to)) return; // neighbouring numbers
            const Slice c = strip.at(solid_, t);
            take(c);
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
    double least_;
    std::optional<Slice> best_;
};

// At a corner, where slices are points: the slope is the lesser of those along the two sides.
Slice at_corner(const RoundSolid& solid, const Vector3d& corner, const Vector3d& one, const Vector3d& other,
                double sign)
{
    const double r = corner.head<2>().norm();
    const ProfileDistance profile = distance(solid, r, corner.z());
    const Vector3d rim = r > 0 ? Vector3d(corner.x() / r, corner.y() / r, 0) : Vector3d::Zero();
    const Vector3d gradient = profile.along_r * rim + profile.along_z * Vector3d::UnitZ();
    return {profile.value, sign * std::min(sign * gradient.dot(one), sign * gradient.dot(other)), profile, corner};
}

} // namespace

ProfileDistance distance(const RoundSolid& solid, double r, double z)
{
    const double below = -z, above = z - solid.length;
    if (solid.radius_from == solid.radius_to) {
        const double beside = r - solid.radius_from, beyond = std::max(below, above), sign = above > below ? 1 : -1;
        if (beyond > 0 && beside > 0) {
            const double value = std::sqrt(beyond * beyond + beside * beside);
            return {value - solid.rounding, beside / value, sign * beyond / value};
        }
        if (beyond > beside) return {beyond - solid.rounding, 0, sign};
        return {beside - solid.rounding, 1, 0};
    }
    const double taper = solid.radius_from - solid.radius_to, side = std::hypot(solid.length, taper);
    const Vector2d out(solid.length / side, taper / side); // of the slanted side
    const double beside = (r - solid.radius_from) * out.x() + z * out.y();
    if (below <= 0 && above <= 0 && beside <= 0) {
        if (beside >= below && beside >= above) return {beside - solid.rounding, out.x(), out.y()};
        return below >= above ? ProfileDistance{below - solid.rounding, 0, -1}
                              : ProfileDistance{above - solid.rounding, 0, 1};
    }
    if (below > 0 && r <= solid.radius_from) return {below - solid.rounding, 0, -1};
    if (above > 0 && r <= solid.radius_to) return {above - solid.rounding, 0, 1};
    const Vector2d way(-taper, solid.length), from(r - solid.radius_from, z);
    const Vector2d off = from - std::clamp(from.dot(way) / (side * side), 0.0, 1.0) * way;
    const double value = off.norm();
    if (!(value > 0)) return {-solid.rounding, out.x(), out.y()};
    return {value - solid.rounding, off.x() / value, off.y() / value};
}

std::optional<TriangleFoot> nearest_of_triangle(const RoundSolid& solid, const Triangle& triangle, double below)
{
    const Triangle local = solid.T.linear().transpose() * (triangle.colwise() - Vector3d(solid.T.translation()));
    int low = 0, high = 0;
    for (int k = 1; k < 3; ++k) {
        if (local(2, k) < local(2, low)) low = k;
        if (local(2, k) >= local(2, high)) high = k;
    }
    const Vector3d a = local.col(low), b = local.col(3 - low - high), c = local.col(high);
    const double rise = c.z() - a.z();
    const double share = rise > 0 ? std::clamp((b.z() - a.z()) / rise, 0.0, 1.0) : 0.0;
    const Vector3d beside = a + share * (c - a); // on the long side, as high as the middle corner
    const Strip lower = {a, a, beside - a, b - a}, upper = {beside, b, c - beside, c - b};
    Search search(solid, below);
    const Slice from_below = lower.at(solid, 1), from_above = upper.at(solid, 0);
    search.take(from_below);
    if (from_below.slope > 0 && from_below.value - from_below.slope < below - kFootTolerance) {
        const Slice start = at_corner(solid, a, lower.along_left, lower.along_right, 1);
        search.take(start);
        search.look_through(lower, start, from_below);
    }
    if (from_above.slope < 0 && from_above.value + from_above.slope < below - kFootTolerance) {
        const Slice end = at_corner(solid, c, upper.along_left, upper.along_right, -1);
        search.take(end);
        search.look_through(upper, from_above, end);
    }
    if (!search.best()) return std::nullopt;
    const Slice& best = *search.best();
    const double r = best.point.head<2>().norm();
    const Vector3d rim = r > 0 ? Vector3d(best.point.x() / r, best.point.y() / r, 0) : Vector3d::UnitX();
    const Vector3d gradient = best.profile.along_r * rim + best.profile.along_z * Vector3d::UnitZ();
    return TriangleFoot{best.value, solid.T.linear() * gradient, solid.T * best.point};
}

} // namespace fettle
