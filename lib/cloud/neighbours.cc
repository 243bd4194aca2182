#include "cloud/neighbours.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <utility>

namespace fettle {

namespace {

constexpr Eigen::Index kLeaf = 12;        // points of a leaf: about as quick to look through as two nodes
constexpr Eigen::Index kParallel = 20000; // smaller halves are not worth a task

using Candidate = std::pair<double, Eigen::Index>; ///< squared distance, column: their order breaks ties

} // namespace

/// The points in an order such that the middle of every range splits it: no nodes to store but the axis.
struct Neighbours::Tree {
    std::vector<Eigen::Index> column; ///< in the cloud
    Eigen::Matrix3Xd points;          ///< in the order of `column`
    std::vector<char> axis;           ///< that splits the range at its middle

    void build(const Eigen::Matrix3Xd& cloud, Eigen::Index first, Eigen::Index last);
    void search(const Eigen::Vector3d& query, std::size_t count, Eigen::Index first, Eigen::Index last,
                std::vector<Candidate>& heap) const;
};

void Neighbours::Tree::build(const Eigen::Matrix3Xd& cloud, Eigen::Index first, Eigen::Index last)
{
    if (last - first <= kLeaf) return;
    Eigen::Array3d least = cloud.col(column[static_cast<std::size_t>(first)]), most = least;
    for (Eigen::Index i = first; i < last; ++i) {
        const Eigen::Array3d p = cloud.col(column[static_cast<std::size_t>(i)]);
        least = least.min(p);
        most = most.max(p);
    }
    int widest = 0;
    (most - least).maxCoeff(&widest);
    const Eigen::Index middle = first + (last - first) / 2;
    axis[static_cast<std::size_t>(middle)] = static_cast<char>(widest);
    std::nth_element(column.begin() + first, column.begin() + middle, column.begin() + last,
                     [&](Eigen::Index a, Eigen::Index b) {
                         return std::pair(cloud(widest, a), a) < std::pair(cloud(widest, b), b);
                     });
    const auto lower = [&] { build(cloud, first, middle); };
    const auto upper = [&] { build(cloud, middle + 1, last); };
    if (last - first > kParallel) {
        tbb::parallel_invoke(lower, upper);
    } else {
        lower();
        upper();
    }
}

// `heap` holds the nearest so far, the farthest of them on top.
void Neighbours::Tree::search(const Eigen::Vector3d& query, std::size_t count, Eigen::Index first, Eigen::Index last,
                              std::vector<Candidate>& heap) const
{
    const auto offer = [&](Eigen::Index i) {
        const Candidate candidate{(points.col(i) - query).squaredNorm(), column[static_cast<std::size_t>(i)]};
        if (heap.size() == count && !(candidate < heap.front())) return;
        if (heap.size() == count) {
            std::pop_heap(heap.begin(), heap.end());
            heap.pop_back();
        }
        heap.push_back(candidate);
        std::push_heap(heap.begin(), heap.end());
    };
    if (last - first <= kLeaf) {
        for (Eigen::Index i = first; i < last; ++i) offer(i);
        return;
    }
    const Eigen::Index middle = first + (last - first) / 2;
    const int k = axis[static_cast<std::size_t>(middle)];
    const double beside = query[k] - points(k, middle);
    const auto near = beside < 0 ? std::pair(first, middle) : std::pair(middle + 1, last);
    const auto far = beside < 0 ? std::pair(middle + 1, last) : std::pair(first, middle);
    search(query, count, near.first, near.second, heap);
    offer(middle);
    if (heap.size() < count || beside * beside <= heap.front().first) search(query, count, far.first, far.second, heap);
}

Neighbours::Neighbours(const Eigen::Matrix3Xd& points)
{
    auto tree = std::make_unique<Tree>();
    for (Eigen::Index i = 0; i < points.cols(); ++i)
        if (points.col(i).allFinite()) tree->column.push_back(i);
    const auto size = static_cast<Eigen::Index>(tree->column.size());
    tree->axis.resize(tree->column.size());
    tree->build(points, 0, size);
    tree->points = points(Eigen::all, tree->column);
    tree_ = std::move(tree);
}

Neighbours::~Neighbours() = default;

Eigen::Index Neighbours::size() const { return tree_->points.cols(); }

std::vector<Eigen::Index> Neighbours::nearest(const Eigen::Vector3d& query, Eigen::Index count) const
{
    std::vector<Candidate> heap;
    heap.reserve(static_cast<std::size_t>(count));
    if (count > 0) tree_->search(query, static_cast<std::size_t>(count), 0, size(), heap);
    std::sort_heap(heap.begin(), heap.end());
    std::vector<Eigen::Index> columns;
    for (const Candidate& candidate : heap) columns.push_back(candidate.second);
    return columns;
}

} // namespace fettle
