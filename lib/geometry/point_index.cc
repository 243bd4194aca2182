#include "geometry/point_index.h"

#include <nanoflann.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace fettle::geometry {

namespace {

using Candidate = std::pair<double, std::uint32_t>; ///< squared distance and number of a finite point

/// The nearest points so far, nearest first, equally near ones by number. nanoflann's own sets drop some of these.
class NearestSet {
  public:
    explicit NearestSet(std::size_t count) : count_(count) { found.reserve(count); }

    bool full() const { return found.size() == count_; }
    /// nanoflann offers only points that are nearer: not those that are equally near.
    double worstDist() const { return worst_; }
    bool addPoint(double squared, std::uint32_t number)
    {
        const Candidate candidate{squared, number};
        if (full()) {
            if (!(candidate < found.back())) return true;
            found.pop_back();
        }
        found.insert(std::ranges::upper_bound(found, candidate), candidate);
        if (full()) worst_ = std::nextafter(found.back().first, std::numeric_limits<double>::infinity());
        return true;
    }

    std::vector<Candidate> found;

  private:
    std::size_t count_;
    double worst_ = std::numeric_limits<double>::infinity();
};

/// The points no farther than a radius.
struct RadiusSet {
    double worst; ///< the smallest number above the squared radius

    bool full() const { return true; }
    double worstDist() const { return worst; }
    bool addPoint(double, std::uint32_t number)
    {
        found.push_back(number);
        return true;
    }

    std::vector<std::uint32_t> found;
};

} // namespace

template <int Dim>
struct PointIndex<Dim>::Tree {
    std::vector<Eigen::Index> column; ///< of the finite points, ascending
    Points points;                    ///< the finite points
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Tree, double, std::uint32_t>, Tree, Dim,
                                        std::uint32_t>
        tree;

    Tree(const Points& all, std::vector<Eigen::Index> finite)
        : column(std::move(finite)), points(all(Eigen::all, column)), tree(Dim, *this)
    {
    }

    template <typename Set>
    void search(const Point& query, Set& set) const
    {
        // Relative: boxes that rounding puts beyond the farthest point are searched, too.
        constexpr float kTolerance = 1e-6f;
        tree.findNeighbors(set, query.data(), nanoflann::SearchParams(0, -kTolerance));
    }

    // What nanoflann asks for.
    std::size_t kdtree_get_point_count() const { return column.size(); }
    double kdtree_get_pt(std::uint32_t number, std::size_t axis) const { return points(axis, number); }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const
    {
        return false;
    }
};

template <int Dim>
PointIndex<Dim>::PointIndex(const Points& points)
{
    std::vector<Eigen::Index> finite;
    for (Eigen::Index i = 0; i < points.cols(); ++i)
        if (points.col(i).allFinite()) finite.push_back(i);
    tree_ = std::make_unique<Tree>(points, std::move(finite));
}

template <int Dim>
PointIndex<Dim>::~PointIndex() = default;

template <int Dim>
Eigen::Index PointIndex<Dim>::size() const
{
    return tree_->points.cols();
}

template <int Dim>
std::vector<Eigen::Index> PointIndex<Dim>::nearest(const Point& query, Eigen::Index count) const
{
    NearestSet nearest(count);
    if (count > 0) tree_->search(query, nearest);
    std::vector<Eigen::Index> columns;
    for (const Candidate& candidate : nearest.found) columns.push_back(tree_->column[candidate.second]);
    return columns;
}

template <int Dim>
std::vector<Eigen::Index> PointIndex<Dim>::radius_search(const Point& query, double radius) const
{
    RadiusSet within{std::nextafter(radius * radius, std::numeric_limits<double>::infinity()), {}};
    tree_->search(query, within);
    std::sort(within.found.begin(), within.found.end());
    std::vector<Eigen::Index> columns;
    for (const std::uint32_t number : within.found) columns.push_back(tree_->column[number]);
    return columns;
}

template class PointIndex<2>;
template class PointIndex<3>;

} // namespace fettle::geometry
