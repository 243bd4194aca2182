#include "robot/hull_points.h"

#include "geometry/bounding_box.h"
#include "robot/simplex.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace fettle::robot {

namespace {

using Eigen::Index, Eigen::Vector3d;

// Points this near to the hull of the others count as on it, as a fraction of the extent.
constexpr double kHullTolerance = 1e-9;
// Steps of a search among some thousand points: a dozen is usual.
constexpr int kMaxSteps = 100;
// Number of points on the hull up to which the others are looked for: the time is their number times that of all.
constexpr std::size_t kMaxHullPoints = 1000;

class HullPoints {
  public:
    explicit HullPoints(const Eigen::Matrix3Xd& points)
        : points_(points), tolerance_(kHullTolerance * geometry::bounding_box(points).diagonal().norm())
    {
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z)
                    if (const Vector3d direction(x, y, z); !direction.isZero()) add(farthest(direction));
    }

    /// Adds points until the hull of those so far contains this one.
    void cover(Index point)
    {
        while (!is_full()) {
            const std::optional<Vector3d> outwards = separating_direction(points_.col(point));
            if (!outwards) return;
            const std::size_t before = indices_.size();
            add(farthest(*outwards));
            if (indices_.size() == before) add(point); // equal to rounding to one that is there
            if (indices_.size() == before) return;
        }
    }

    bool is_full() const { return indices_.size() > kMaxHullPoints; }

    Eigen::Matrix3Xd result()
    {
        std::ranges::sort(indices_);
        return points_(Eigen::all, indices_);
    }

  private:
    Index farthest(const Vector3d& direction) const
    {
        Index best = 0;
        (direction.transpose() * points_).maxCoeff(&best);
        return best;
    }

    void add(Index point)
    {
        if (std::ranges::find(indices_, point) == indices_.end()) indices_.push_back(point);
    }

    // The point of the hull so far, relative to p, that is farthest along a direction.
    DifferencePoint support(const Vector3d& p, const Vector3d& direction) const
    {
        Index best = indices_.front();
        for (const Index i : indices_)
            if (points_.col(i).dot(direction) > points_.col(best).dot(direction)) best = i;
        return {points_.col(best) - p, p, points_.col(best)};
    }

    // A direction in which p lies beyond the hull so far; nothing if it does not. The algorithm of Gilbert, Johnson &
    // Keerthi, as in clearance(), for a point.
    std::optional<Vector3d> separating_direction(const Vector3d& p) const
    {
        Simplex simplex;
        simplex.add(support(p, p - points_.col(indices_.front())));
        reduce(simplex);
        for (int step = 0; step < kMaxSteps; ++step) {
            const Vector3d v = simplex.nearest();
            const double length = v.norm();
            if (length <= tolerance_) return std::nullopt;
            const DifferencePoint next = support(p, -v);
            const double distance = v.dot(next.w) / length; // of a plane between p and the hull
            if (distance > tolerance_) return -v;
            Simplex larger = simplex;
            larger.add(next);
            if (reduce(larger)) return std::nullopt;
            if (!(larger.nearest().squaredNorm() < v.squaredNorm())) return std::nullopt; // as near as rounding allows
            simplex = larger;
        }
        return std::nullopt;
    }

    const Eigen::Matrix3Xd& points_;
    double tolerance_; ///< mm
    std::vector<Index> indices_;
};

} // namespace

Eigen::Matrix3Xd hull_points(const Eigen::Matrix3Xd& points)
{
    if (points.cols() == 0 || !points.allFinite()) return points;
    HullPoints hull(points);
    for (Index i = 0; i < points.cols() && !hull.is_full(); ++i) hull.cover(i);
    return hull.is_full() ? points : hull.result();
}

} // namespace fettle::robot
