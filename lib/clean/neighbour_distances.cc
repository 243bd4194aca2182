#include "clean/neighbour_distances.h"

#include "geometry/bounding_box.h"
#include "mesh/lanes.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace fettle::clean {
namespace {

using mesh::Float8;

constexpr std::size_t kBucketPoints = 16; // two registers of eight floats for each coordinate
constexpr float kInfinity = std::numeric_limits<float>::infinity();
// Subtrees of fewer points are built by one thread.
constexpr std::size_t kMinParallelPoints = 20000;

constexpr std::size_t kLanes = 8;

FETTLE_INLINE Float8 load(const float* from)
{
    Float8 value;
    std::memcpy(&value, from, sizeof(value));
    return value;
}

struct Box {
    std::array<float, 3> min{kInfinity, kInfinity, kInfinity}, max{-kInfinity, -kInfinity, -kInfinity};
};

/// Squared distance of two boxes: no more than that of any two points in them.
float squared_distance(const Box& a, const Box& b)
{
    float sum = 0;
    for (int k = 0; k < 3; ++k) {
        const float gap = std::max(0.F, std::max(a.min[k] - b.max[k], b.min[k] - a.max[k]));
        sum += gap * gap;
    }
    return sum;
}

struct Point {
    std::array<float, 3> xyz;
    std::uint32_t column;
};

/// Coordinates of a bucket's points; at infinity what the last bucket lacks.
struct Bucket {
    std::array<std::array<float, kBucketPoints>, 3> xyz;
};

/// A k-d tree whose leaves are full buckets: complete and binary, node 1 is the root, the children of i are 2 i and
/// 2 i + 1, the leaves begin at `first_leaf`.
struct BucketTree {
    std::vector<Point> points; // bucket after bucket
    std::vector<Bucket> buckets;
    std::vector<Box> boxes; // of the nodes
    std::size_t first_leaf = 1;
};

Box box_of(const Point* begin, const Point* end)
{
    Box box;
    for (; begin != end; ++begin)
        for (int k = 0; k < 3; ++k) {
            box.min[k] = std::min(box.min[k], begin->xyz[k]);
            box.max[k] = std::max(box.max[k], begin->xyz[k]);
        }
    return box;
}

/// Sorts the points beneath a node, which has the buckets from `first` to `first + leaves`, as far as there are any.
void build(BucketTree& tree, std::size_t node, std::size_t first, std::size_t leaves)
{
    const std::size_t begin = first * kBucketPoints, end = std::min(tree.points.size(), begin + leaves * kBucketPoints);
    if (begin >= end) return;
    Point* const points = tree.points.data();
    const Box box = tree.boxes[node] = box_of(points + begin, points + end);
    if (leaves == 1) {
        for (std::size_t j = 0; j < kBucketPoints; ++j)
            for (int k = 0; k < 3; ++k)
                tree.buckets[first].xyz[k][j] = begin + j < end ? points[begin + j].xyz[k] : kInfinity;
        return;
    }
    const std::size_t middle = begin + leaves / 2 * kBucketPoints;
    if (middle < end) {
        int axis = 0;
        for (int k = 1; k < 3; ++k)
            if (box.max[k] - box.min[k] > box.max[axis] - box.min[axis]) axis = k;
        // The column makes the order total: the tree does not depend on the library's partition.
        std::nth_element(points + begin, points + middle, points + end, [axis](const Point& a, const Point& b) {
            return a.xyz[axis] < b.xyz[axis] || (a.xyz[axis] == b.xyz[axis] && a.column < b.column);
        });
    }
    const auto left = [&] { build(tree, 2 * node, first, leaves / 2); };
    const auto right = [&] { build(tree, 2 * node + 1, first + leaves / 2, leaves / 2); };
    if (end - begin < kMinParallelPoints)
        left(), right();
    else
        tbb::parallel_invoke(left, right);
}

BucketTree bucket_tree(const Eigen::Matrix3Xd& xyz)
{
    BucketTree tree;
    const Eigen::Vector3d centre = geometry::bounding_box(xyz).center();
    tree.points.resize(static_cast<std::size_t>(xyz.cols()));
    for (std::size_t i = 0; i < tree.points.size(); ++i) {
        const Eigen::Vector3f p = (xyz.col(static_cast<Eigen::Index>(i)) - centre).cast<float>();
        tree.points[i] = {{p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(i)};
    }
    tree.buckets.resize((tree.points.size() + kBucketPoints - 1) / kBucketPoints);
    tree.first_leaf = std::bit_ceil(tree.buckets.size());
    tree.boxes.resize(2 * tree.first_leaf);
    build(tree, 1, 0, tree.first_leaf);
    return tree;
}

/// The least squared distances so far, ascending, then some that are larger, as far as whole registers reach.
class NearestList {
  public:
    explicit NearestList(int count)
        : count_(static_cast<std::size_t>(count)), squared_(1 + (count_ + kLanes - 1) / kLanes * kLanes, kInfinity)
    {
        squared_.front() = -kInfinity;
    }

    void clear() { std::fill(squared_.begin() + 1, squared_.end(), kInfinity); }
    float bound() const { return squared_[count_]; }
    std::span<const float> squared() const { return std::span(squared_).subspan(1, count_); }
    /// Inserts a value without a branch that depends on it: each place takes the middle of it and two old neighbours.
    FETTLE_INLINE void insert(float value)
    {
        for (std::size_t block = squared_.size() / kLanes; block-- > 0;) {
            float* const here = &squared_[1 + block * kLanes];
            const Float8 raised = mesh::cwise_min(load(here), mesh::cwise_max(load(here - 1), mesh::broadcast(value)));
            std::memcpy(here, &raised, sizeof(raised));
        }
    }

  private:
    std::size_t count_;
    std::vector<float> squared_; // -infinity first
};

/// Inserts the distances of a bucket's points, all but point `left_out`, from a query.
FETTLE_CLONES void visit(const Bucket& bucket, const std::array<float, 3>& query, std::size_t left_out,
                         NearestList& nearest)
{
    for (std::size_t part = 0; part < kBucketPoints; part += kLanes) {
        Float8 squared{};
        for (std::size_t k = 0; k < 3; ++k) {
            const Float8 difference = load(&bucket.xyz[k][part]) - query[k];
            squared += difference * difference;
        }
        for (mesh::LaneIterator lane{mesh::lane_bits(squared < nearest.bound())}; lane.any(); lane.next())
            if (part + lane.first() != left_out) nearest.insert(squared[lane.first()]);
    }
}

/// A bucket to search, and its squared distance from the bucket of the queries.
struct NearBucket {
    float squared;
    std::size_t bucket;
};

/// The search for the points of one bucket; what it allocates serves the next one, too.
class BucketSearch {
  public:
    BucketSearch(const BucketTree& tree, int count) : tree_(tree), nearest_(kBucketPoints, NearestList(count)) {}

    void run(std::size_t own, const UseNeighbours& use)
    {
        const std::size_t begin = own * kBucketPoints;
        const std::size_t count = std::min(kBucketPoints, tree_.points.size() - begin);
        search_first(own, count);
        collect_near(own, count);
        for (std::size_t j = 0; j < count; ++j) {
            const Point& query = tree_.points[begin + j];
            const Box box{query.xyz, query.xyz};
            for (const NearBucket& near : near_) {
                if (near.squared >= nearest_[j].bound()) break;
                if (squared_distance(box, tree_.boxes[tree_.first_leaf + near.bucket]) < nearest_[j].bound())
                    visit(tree_.buckets[near.bucket], query.xyz, kBucketPoints, nearest_[j]);
            }
            use(query.column, nearest_[j].squared());
        }
    }

  private:
    /// The queries' bucket and its nearest relatives, until they hold enough points: they bound the search.
    void search_first(std::size_t own, std::size_t count)
    {
        const std::size_t buckets = std::bit_ceil(2 + nearest_[0].squared().size() / kBucketPoints);
        first_ = own / buckets * buckets;
        last_ = std::min(tree_.buckets.size(), first_ + buckets);
        for (std::size_t j = 0; j < count; ++j) {
            nearest_[j].clear();
            for (std::size_t b = first_; b < last_; ++b)
                visit(tree_.buckets[b], tree_.points[own * kBucketPoints + j].xyz, b == own ? j : kBucketPoints,
                      nearest_[j]);
        }
    }

    /// All other buckets that may have a neighbour of any query, nearest first.
    void collect_near(std::size_t own, std::size_t count)
    {
        float bound = 0;
        for (std::size_t j = 0; j < count; ++j) bound = std::max(bound, nearest_[j].bound());
        const Box box = tree_.boxes[tree_.first_leaf + own];
        near_.clear();
        stack_.assign(1, 1);
        while (!stack_.empty()) {
            const std::size_t node = stack_.back();
            stack_.pop_back();
            const float squared = squared_distance(tree_.boxes[node], box);
            if (!(squared < bound)) continue;
            if (node < tree_.first_leaf) {
                stack_.push_back(2 * node);
                stack_.push_back(2 * node + 1);
            } else if (const std::size_t b = node - tree_.first_leaf; b < first_ || b >= last_) {
                near_.push_back({squared, b});
            }
        }
        std::ranges::sort(near_, {}, [](const NearBucket& near) { return std::pair(near.squared, near.bucket); });
    }

    const BucketTree& tree_;
    std::vector<NearestList> nearest_; // of each query
    std::size_t first_ = 0, last_ = 0; // buckets that were searched first
    std::vector<NearBucket> near_;
    std::vector<std::size_t> stack_; // nodes to descend to
};

} // namespace

void for_each_neighbourhood(const Eigen::Matrix3Xd& xyz, int count, const UseNeighbours& use)
{
    const BucketTree tree = bucket_tree(xyz);
    constexpr std::size_t kGrain = 64; // buckets
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tree.buckets.size(), kGrain),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          BucketSearch search(tree, count);
                          for (std::size_t b = range.begin(); b < range.end(); ++b) search.run(b, use);
                      });
}

} // namespace fettle::clean
