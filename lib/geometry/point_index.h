#pragma once

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <vector>

namespace fettle::geometry {

/// Points in space (Dim = 3) or in a plane (2) in a k-d tree, nanoflann's, for the nearest ones and those within a
/// radius. Distances are exact in double; what is found does not depend on the tree. Thread-safe. See PlanarGrid for
/// short searches in a plane.
template <int Dim>
class PointIndex {
  public:
    using Point = Eigen::Matrix<double, Dim, 1>;
    using Points = Eigen::Matrix<double, Dim, Eigen::Dynamic>;

    /// @param points  one in each column; those that are not finite are ignored
    explicit PointIndex(const Points& points);
    ~PointIndex();

    /// Columns of the `count` points nearest to `query`, or of all if there are fewer: nearest first, equally near ones
    /// by column.
    std::vector<Eigen::Index> nearest(const Point& query, Eigen::Index count) const;
    /// Column of the nearest point, of equally near ones the first; nothing if none is within `radius`: where most
    /// queries lie far from all points that takes a fraction of nearest()'s time.
    std::optional<Eigen::Index> nearest_within(const Point& query, double radius) const;
    /// Columns, ascending, of the points no farther than `radius` from `query`.
    std::vector<Eigen::Index> radius_search(const Point& query, double radius) const;
    /// Number of finite points.
    Eigen::Index size() const;

  private:
    struct Tree;
    std::unique_ptr<const Tree> tree_;
};

extern template class PointIndex<2>;
extern template class PointIndex<3>;

} // namespace fettle::geometry
