#include "mesh/mesh_index.h"

#include "core/simd.h"
#include "mesh/box_tree.h"
#include "mesh/triangle.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

// The tree and a first look at triangles are in float; whatever a rounding might have hidden is looked at in double.

// Vectors go nowhere but into functions that are inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace fettle {

namespace {

constexpr double kEpsilon = std::numeric_limits<float>::epsilon() / 2; // most of a rounding, relative

// Operations in float on the way to a distance, or to where a ray meets a box, are fewer than this, each off by a
// rounding of numbers no larger than the way.
constexpr double kRoundings = 16;
// Squared sine at a corner below which float tells too little of a triangle: double must. At that sine the direction of
// the normal is 16 times less certain than its parts are.
constexpr float kNarrow = 1.0f / 256;
constexpr float kTriangleRoundings = static_cast<float>(16 * kRoundings * kEpsilon);

// Every visit of a node leaves seven more to visit, and there are at most eleven levels over 2^32 triangles.
constexpr std::size_t kMostWaiting = 7 * 11 + 1;

#define FETTLE_INLINE [[gnu::always_inline]] inline

FETTLE_INLINE Float8 larger(Float8 a, Float8 b) { return a > b ? a : b; }
FETTLE_INLINE Float8 smaller(Float8 a, Float8 b) { return a < b ? a : b; }
FETTLE_INLINE Float8 all(float value) { return Float8{} + value; }

struct Point8 {
    Float8 x, y, z;
};
FETTLE_INLINE Point8 operator-(const Point8& a, const Point8& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
FETTLE_INLINE Float8 dot(const Point8& a, const Point8& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
FETTLE_INLINE Point8 cross(const Point8& a, const Point8& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The lanes in which a mask is set, a bit each.
FETTLE_INLINE unsigned lanes_of(Mask8 mask)
{
    // Pairs of lanes are taken as words: the bits of the even lanes come together in the lower halves.
    using Words = std::uint64_t __attribute__((vector_size(32)));
    const Mask8 bits = mask & Mask8{1, 2, 4, 8, 16, 32, 64, 128};
    const Words words = std::bit_cast<Words>(bits);
    const std::uint64_t word = (words[0] | words[2]) | (words[1] | words[3]);
    return static_cast<unsigned>(word | word >> 32);
}

/// Squared distance of a point to eight boxes; infinite for those that are not there.
FETTLE_INLINE Float8 squared_distance(const Boxes8& boxes, const float (&point)[3])
{
    Float8 sum = {};
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; ++axis) {
        const Float8 p = all(point[axis]);
        const Float8 beside = larger(larger(boxes.least[axis] - p, p - boxes.most[axis]), Float8{});
        sum += beside * beside;
    }
    return sum;
}

/// Squared distance of the origin to the segments from a along ab. Segments without length are points.
FETTLE_INLINE Float8 squared_distance(const Point8& a, const Point8& ab, Float8 squared_length)
{
    Float8 t = -dot(a, ab) / squared_length;
    t = t > 0 ? t : Float8{}; // NaN too
    t = t < 1 ? t : all(1);
    const Point8 foot = {a.x + t * ab.x, a.y + t * ab.y, a.z + t * ab.z};
    return dot(foot, foot);
}

/// A lower bound of the squared distance of a point to eight triangles, exact but for roundings; below 0 for the narrow
/// ones.
FETTLE_INLINE Float8 squared_distance(const Triangles8& triangles, const float (&point)[3])
{
    const auto corner = [&](int k) -> Point8 {
        return {triangles.corner[k][0] - point[0], triangles.corner[k][1] - point[1],
                triangles.corner[k][2] - point[2]};
    };
    const Point8 a = corner(0), b = corner(1), c = corner(2);
    const Point8 ab = b - a, bc = c - b, ca = a - c;
    const Float8 ab2 = dot(ab, ab), bc2 = dot(bc, bc), ca2 = dot(ca, ca);
    const Float8 longest2 = larger(ab2, larger(bc2, ca2));
    const Point8 normal = cross(ab, bc);
    const Float8 normal2 = dot(normal, normal);
    const Float8 height = dot(a, normal);
    const Mask8 over =
        (dot(cross(a, ab), normal) > 0) & (dot(cross(b, bc), normal) > 0) & (dot(cross(c, ca), normal) > 0);
    const Float8 to_edges =
        smaller(squared_distance(a, ab, ab2), smaller(squared_distance(b, bc, bc2), squared_distance(c, ca, ca2)));
    const Float8 nearest = over ? height * height / normal2 : to_edges;
    // The distance d is off by less than k (d + longest), with k = kTriangleRoundings: its square by 3 k d² + k
    // longest².
    const Float8 least = nearest * (1 - 3 * kTriangleRoundings) - kTriangleRoundings * longest2;
    return normal2 > kNarrow * longest2 * longest2 ? least : all(-1);
}

/// A node or, at level -1, a leaf that waits to be visited.
struct Waiting {
    float distance;
    std::int32_t level;
    std::uint32_t index;
};

/// Lanes out of lanes_of(), one by one.
struct Lanes {
    unsigned bits;

    FETTLE_INLINE bool any() const { return bits != 0; }
    FETTLE_INLINE unsigned first() const { return static_cast<unsigned>(std::countr_zero(bits)); }
    FETTLE_INLINE void next() { bits &= bits - 1; }
};

/// Nodes to visit, the nearest of the last visited node's children first.
class Stack {
  public:
    explicit Stack(const BoxTree& tree)
    {
        waiting_[size_++] = {0, static_cast<std::int32_t>(tree.levels.size()) - 1, 0};
    }

    FETTLE_INLINE bool any() const { return size_ > 0; }
    FETTLE_INLINE const Waiting& pop() { return waiting_[--size_]; }

    /// Children of a node.
    FETTLE_INLINE void push(unsigned lanes, const Float8& distances, std::int32_t level, std::uint32_t node)
    {
        const std::size_t first = size_;
        for (Lanes left{lanes}; left.any(); left.next()) {
            const float distance = distances[left.first()];
            std::size_t place = size_++;
            for (; place > first && waiting_[place - 1].distance < distance; --place)
                waiting_[place] = waiting_[place - 1];
            waiting_[place].distance = distance;
            waiting_[place].level = level;
            waiting_[place].index = 8 * node + left.first();
        }
    }

  private:
    std::array<Waiting, kMostWaiting> waiting_;
    std::size_t size_ = 0;
};

Triangle triangle_of(const Mesh& mesh, Eigen::Index index)
{
    Triangle corners;
    for (int k = 0; k < 3; ++k) corners.col(k) = mesh.vertices.col(mesh.triangles(k, index));
    return corners;
}

constexpr Eigen::Index kNone = std::numeric_limits<Eigen::Index>::max(); // any triangle has a lower index

/// The nearest triangle so far, and how near others must be to matter.
struct Nearest {
    const Eigen::Vector3d& point;
    float place[3];  ///< of the point, about the tree's centre
    double rounding; ///< of the way from the point to a box or triangle, mm
    TrianglePoint found;
    Eigen::Index triangle = kNone;
    std::uint32_t leaf = 0;
    float bound = 0; ///< squared

    void set_bound()
    {
        constexpr double kMost = std::numeric_limits<float>::max(); // still nearer than a box that is not there
        const double far = (std::sqrt(found.squared_distance) + rounding) * (1 + kRoundings * kEpsilon);
        bound = static_cast<float>(std::min(far * far, kMost));
    }

    void offer(const Triangle& corners, Eigen::Index index, std::uint32_t in_leaf)
    {
        const TrianglePoint other = closest_on_triangle(corners, point);
        if (other.squared_distance > found.squared_distance) return;
        if (other.squared_distance == found.squared_distance && index >= triangle) return;
        found = other;
        triangle = index;
        leaf = in_leaf;
        set_bound();
    }
};

/// Offers what is near enough in a leaf, the nearest first.
FETTLE_INLINE void look_through(std::uint32_t leaf, Nearest& nearest, const BoxTree& tree, const Mesh& mesh)
{
    const Float8 distances = squared_distance(tree.leaves[leaf], nearest.place);
    Lanes lanes{lanes_of(distances <= nearest.bound)};
    if (!lanes.any()) return;
    unsigned best = lanes.first();
    for (Lanes left = lanes; left.any(); left.next())
        if (distances[left.first()] < distances[best]) best = left.first();
    const auto offer = [&](unsigned lane) {
        const Eigen::Index t = tree.triangle(leaf, lane);
        nearest.offer(triangle_of(mesh, t), t, leaf);
    };
    offer(best);
    for (; lanes.any(); lanes.next())
        if (lanes.first() != best && distances[lanes.first()] <= nearest.bound) offer(lanes.first());
}

FETTLE_CLONES void find(Nearest& nearest, std::uint32_t first, const BoxTree& tree, const Mesh& mesh)
{
    look_through(first, nearest, tree, mesh);
    Stack stack(tree);
    while (stack.any()) {
        const Waiting& next = stack.pop();
        if (next.distance > nearest.bound) continue;
        const std::int32_t level = next.level;
        const std::uint32_t index = next.index;
        if (level >= 0) {
            const Float8 children =
                squared_distance(tree.levels[static_cast<std::size_t>(level)][index], nearest.place);
            stack.push(lanes_of(children <= nearest.bound), children, level - 1, index);
        } else if (index != first) {
            look_through(index, nearest, tree, mesh);
        }
    }
}

/// The first hit so far of a ray, and the ray as the tree sees it.
struct FirstHit {
    WatertightRay ray;
    float origin[3];  ///< where the ray enters the box of the mesh, about the tree's centre
    float inverse[3]; ///< of the direction
    double entry;     ///< distance at which that is
    float rounding;   ///< by which boxes are wider
    double distance = std::numeric_limits<double>::infinity();
    Eigen::Index triangle = kNone;
    float bound = std::numeric_limits<float>::infinity(); ///< from the entry on

    void offer(const Triangle& corners, Eigen::Index index)
    {
        const std::optional<double> hit = ray.hit(corners);
        if (!hit || *hit > distance || (*hit == distance && index >= triangle)) return;
        distance = *hit;
        triangle = index;
        bound = static_cast<float>((distance - entry) * (1 + kRoundings * kEpsilon)) + rounding;
    }
};

/// Where a ray enters eight boxes, from its origin on; infinite for those that it misses.
FETTLE_INLINE Float8 entries(const Boxes8& boxes, const FirstHit& hit)
{
    Float8 near = {}, far = all(hit.bound);
    for (int axis = 0; axis < 3; ++axis) {
        const Float8 to_least = (boxes.least[axis] - hit.rounding - hit.origin[axis]) * hit.inverse[axis];
        const Float8 to_most = (boxes.most[axis] + hit.rounding - hit.origin[axis]) * hit.inverse[axis];
        near = larger(near, smaller(to_least, to_most));
        far = smaller(far, larger(to_least, to_most));
    }
    return near <= far ? near : all(std::numeric_limits<float>::infinity());
}

FETTLE_INLINE Boxes8 boxes_of(const Triangles8& triangles)
{
    const auto& [a, b, c] = triangles.corner;
    Boxes8 boxes;
    for (int axis = 0; axis < 3; ++axis) {
        boxes.least[axis] = smaller(a[axis], smaller(b[axis], c[axis]));
        boxes.most[axis] = larger(a[axis], larger(b[axis], c[axis]));
    }
    return boxes;
}

FETTLE_CLONES void find(FirstHit& hit, const BoxTree& tree, const Mesh& mesh)
{
    const auto met = [](const Float8& entry) { return lanes_of(entry < std::numeric_limits<float>::infinity()); };
    Stack stack(tree);
    while (stack.any()) {
        const Waiting& next = stack.pop();
        if (next.distance > hit.bound) continue;
        const std::int32_t level = next.level;
        const std::uint32_t index = next.index;
        if (level >= 0) {
            const Float8 children = entries(tree.levels[static_cast<std::size_t>(level)][index], hit);
            stack.push(met(children), children, level - 1, index);
            continue;
        }
        for (Lanes lanes{met(entries(boxes_of(tree.leaves[index]), hit))}; lanes.any(); lanes.next()) {
            const Eigen::Index t = tree.triangle(index, lanes.first());
            hit.offer(triangle_of(mesh, t), t);
        }
    }
}

/// Distance from `origin` to where the ray enters the box; nothing if it misses it.
std::optional<double> entry_distance(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& origin,
                                     const Eigen::Vector3d& direction)
{
    double near = 0;
    double far = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) {
            if (origin[axis] < box.min()[axis] || origin[axis] > box.max()[axis]) return std::nullopt;
            continue;
        }
        const double a = (box.min()[axis] - origin[axis]) / direction[axis];
        const double b = (box.max()[axis] - origin[axis]) / direction[axis];
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    if (near > far) return std::nullopt;
    return near;
}

} // namespace

struct MeshIndex::State {
    explicit State(const Mesh& indexed) : mesh(indexed), tree(indexed) {}

    const Mesh& mesh;
    BoxTree tree;
};

MeshIndex::MeshIndex(const Mesh& mesh) : state_(std::make_unique<State>(mesh)) {}
MeshIndex::MeshIndex(MeshIndex&&) noexcept = default;
MeshIndex::~MeshIndex() = default;

const Mesh& MeshIndex::mesh() const { return state_->mesh; }

std::optional<MeshIndex::Hit> MeshIndex::cast(const Eigen::Vector3d& origin,
                                              const Eigen::Vector3d& unit_direction) const
{
    const BoxTree& tree = state_->tree;
    if (tree.levels.empty() || !origin.allFinite() || !unit_direction.allFinite()) return std::nullopt;
    const double slack = kRoundings * (tree.rounding + kEpsilon * tree.box.sizes().maxCoeff());
    Eigen::AlignedBox3d box = tree.box;
    box.min().array() -= slack;
    box.max().array() += slack;
    const std::optional<double> entry = entry_distance(box, origin, unit_direction);
    if (!entry) return std::nullopt;
    FirstHit hit{WatertightRay(origin, unit_direction), {}, {}, *entry, static_cast<float>(slack)};
    const Eigen::Vector3d start = origin + *entry * unit_direction - tree.centre;
    for (int axis = 0; axis < 3; ++axis) {
        constexpr double kAcross = 1e-30; // instead of 0, whose inverse times 0 is no number
        const double way = unit_direction[axis];
        hit.origin[axis] = static_cast<float>(start[axis]);
        hit.inverse[axis] = static_cast<float>(1 / (std::abs(way) > kAcross ? way : kAcross));
    }
    find(hit, tree, state_->mesh);
    if (hit.triangle == kNone) return std::nullopt;
    return Hit{hit.distance, hit.triangle, origin + hit.distance * unit_direction};
}

std::optional<MeshIndex::Hit> MeshIndex::highest(double x, double y) const
{
    if (state_->tree.levels.empty()) return std::nullopt;
    return cast({x, y, state_->tree.box.max().z()}, -Eigen::Vector3d::UnitZ());
}

std::optional<MeshIndex::Closest> MeshIndex::closest(const Eigen::Vector3d& point, double radius,
                                                     std::uint32_t leaf) const
{
    const BoxTree& tree = state_->tree;
    if (tree.levels.empty() || !point.allFinite() || !(radius >= 0)) return std::nullopt;
    const Eigen::Vector3d place = point - tree.centre;
    const double rounding = 2 * (tree.rounding + kEpsilon * place.cwiseAbs().maxCoeff()); // 2 > sqrt(3): of three axes
    Nearest nearest{point, {}, rounding, {}};
    for (int axis = 0; axis < 3; ++axis) nearest.place[axis] = static_cast<float>(place[axis]);
    nearest.found.squared_distance = radius * radius;
    nearest.set_bound();
    find(nearest, std::min<std::uint32_t>(leaf, static_cast<std::uint32_t>(tree.leaves.size()) - 1), tree,
         state_->mesh);
    if (nearest.triangle == kNone) return std::nullopt;
    return Closest{nearest.found.point, nearest.triangle, nearest.found.barycentric, nearest.leaf};
}

} // namespace fettle
