#include "geometry/point_index.h"

#include <nanoflann.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

namespace fettle::geometry {

namespace {

using Candidate = std::pair<double, Eigen::Index>; ///< squared distance and column of a finite point

/// The next larger number. std::nextafter() takes as long as a search's other steps.
/// @param x  >= 0; infinity stays
double next_above(double x)
{
    return x < std::numeric_limits<double>::infinity() ? std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) + 1) : x;
}

/// The nearest points so far, nearest first, equally near ones by column. nanoflann's own sets drop some of these.
class NearestSet {
  public:
    NearestSet(std::size_t count, const std::vector<Eigen::Index>& column) : count_(count), column_(column)
    {
        found.reserve(count);
    }

    bool full() const { return found.size() == count_; }
    /// nanoflann offers only points that are nearer: not those that are equally near.
    double worstDist() const { return worst_; }
    bool addPoint(double squared, std::uint32_t number)
    {
        const Candidate candidate{squared, column_[number]};
        if (full()) {
            if (!(candidate < found.back())) return true;
            found.pop_back();
        }
        found.insert(std::ranges::upper_bound(found, candidate), candidate);
        if (full()) worst_ = next_above(found.back().first);
        return true;
    }

    std::vector<Candidate> found;

  private:
    std::size_t count_;
    const std::vector<Eigen::Index>& column_; ///< by number of the point in the tree
    double worst_ = std::numeric_limits<double>::infinity();
};

/// The nearest point no farther than a radius.
struct NearestWithin {
    double worst;                            ///< the smallest number above the squared distance
    const std::vector<Eigen::Index>& column; ///< by number of the point in the tree

    bool full() const { return true; }
    double worstDist() const { return worst; }
    bool addPoint(double squared, std::uint32_t number)
    {
        const Candidate candidate{squared, column[number]};
        if (!found || candidate < *found) {
            found = candidate;
            worst = next_above(squared);
        }
        return true;
    }

    std::optional<Candidate> found;
};

/// The points no farther than a radius.
struct RadiusSet {
    double worst;                            ///< the smallest number above the squared radius
    const std::vector<Eigen::Index>& column; ///< by number of the point in the tree

    bool full() const { return true; }
    double worstDist() const { return worst; }
    bool addPoint(double, std::uint32_t number)
    {
        found.push_back(column[number]);
        return true;
    }

    std::vector<Eigen::Index> found;
};

} // namespace

template <int Dim>
struct PointIndex<Dim>::Tree {
    std::vector<Eigen::Index> column; ///< of the points
    Points points;                    ///< the finite points, in the order of the tree's leaves
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Tree, double, std::uint32_t>, Tree, Dim,
                                        std::uint32_t>
        tree;

    Tree(const Points& all, std::vector<Eigen::Index> finite)
        : column(std::move(finite)), points(all(Eigen::all, column)), tree(Dim, *this)
    {
        // A search goes through leaves: with the points of a leaf side by side it waits less for the memory.
        std::vector<Eigen::Index> ordered(column.size());
        for (std::size_t k = 0; k < ordered.size(); ++k) ordered[k] = column[tree.vAcc[k]];
        column = std::move(ordered);
        points = all(Eigen::all, column);
        std::iota(tree.vAcc.begin(), tree.vAcc.end(), std::uint32_t{0});
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
    NearestSet nearest(count, tree_->column);
    if (count > 0) tree_->search(query, nearest);
    std::vector<Eigen::Index> columns;
    columns.reserve(nearest.found.size());
    for (const Candidate& candidate : nearest.found) columns.push_back(candidate.second);
    return columns;
}

template <int Dim>
std::optional<Eigen::Index> PointIndex<Dim>::nearest_within(const Point& query, double radius) const
{
    NearestWithin within{next_above(radius * radius), tree_->column, {}};
    tree_->search(query, within);
    if (!within.found) return std::nullopt;
    return within.found->second;
}

template <int Dim>
std::vector<Eigen::Index> PointIndex<Dim>::radius_search(const Point& query, double radius) const
{
    RadiusSet within{next_above(radius * radius), tree_->column, {}};
    tree_->search(query, within);
    std::sort(within.found.begin(), within.found.end());
    return std::move(within.found);
}

template class PointIndex<2>;
template class PointIndex<3>;

} // namespace fettle::geometry
