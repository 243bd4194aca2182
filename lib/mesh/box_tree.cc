#include "mesh/box_tree.h"

#include "core/simd.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

namespace fettle {

namespace {

constexpr std::size_t kWide = 8;

// So many levels have discs: the children of the next one are of 512 triangles, too many to be flat on most parts.
constexpr std::size_t kFlatLevels = 2;

struct Box {
    Eigen::Array3f least = Eigen::Array3f::Constant(std::numeric_limits<float>::infinity());
    Eigen::Array3f most = -least;
};

void set(Boxes8& boxes, std::size_t k, const Box& box)
{
    for (int axis = 0; axis < 3; ++axis) {
        boxes.least[axis][k] = box.least[axis];
        boxes.most[axis][k] = box.most[axis];
    }
}

Box box_of(const Boxes8& boxes)
{
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        box.least[axis] = least_of(boxes.least[axis]);
        box.most[axis] = most_of(boxes.most[axis]);
    }
    return box;
}

Box box_of(const Triangles8& triangles)
{
    const auto& [a, b, c] = triangles.corner;
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        box.least[axis] = least_of(smaller(a[axis], smaller(b[axis], c[axis])));
        box.most[axis] = most_of(larger(a[axis], larger(b[axis], c[axis])));
    }
    return box;
}

Box box_of(const Boxes8& boxes, std::size_t k)
{
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        box.least[axis] = boxes.least[axis][k];
        box.most[axis] = boxes.most[axis][k];
    }
    return box;
}

struct Disc {
    Eigen::Vector3f centre, normal;
    float radius, half;
};

void set(Discs8& discs, std::size_t k, const Disc& disc)
{
    for (int axis = 0; axis < 3; ++axis) {
        discs.centre[axis][k] = disc.centre[axis];
        discs.normal[axis][k] = disc.normal[axis];
    }
    discs.radius[k] = disc.radius;
    discs.half[k] = disc.half;
}

/// The disc about some leaves in a box, across the sum of their areas.
FETTLE_CLONES Disc disc_about(std::span<const Triangles8> leaves, const Box& box)
{
    Point8 area = {};
    for (const Triangles8& t : leaves) {
        const Point8 a = corner(t, 0);
        area = area + cross(corner(t, 1) - a, corner(t, 2) - a);
    }
    Disc disc;
    disc.normal = Eigen::Vector3f(sum_of(area.x), sum_of(area.y), sum_of(area.z)).stableNormalized();
    if (!(disc.normal.norm() > 0.5f)) disc.normal = Eigen::Vector3f::UnitZ(); // areas that cancel: any will do
    const Eigen::Vector3f middle = (box.least + box.most) / 2;
    const Point8 normal = all(disc.normal.data()), origin = all(middle.data());
    Float8 lowest = all(std::numeric_limits<float>::infinity()), highest = -lowest, beside2 = {};
    for (const Triangles8& t : leaves)
        for (int k = 0; k < 3; ++k) {
            const Point8 way = corner(t, k) - origin;
            const Float8 above = dot(way, normal);
            lowest = smaller(lowest, above);
            highest = larger(highest, above);
            beside2 = larger(beside2, dot(way, way) * (1 + kDiscRoundings) - above * above);
        }
    const float low = least_of(lowest), high = most_of(highest);
    const float rounding = kDiscRoundings * box.least.abs().max(box.most.abs()).maxCoeff();
    disc.centre = middle + disc.normal * ((low + high) / 2);
    disc.radius = std::sqrt(most_of(beside2)) + rounding;
    disc.half = (high - low) / 2 + rounding;
    return disc;
}

Eigen::AlignedBox3d box_of(const Mesh& mesh)
{
    const auto of_range = [&](const tbb::blocked_range<Eigen::Index>& range, Eigen::AlignedBox3d box) {
        for (Eigen::Index t = range.begin(); t < range.end(); ++t)
            for (const int corner : mesh.triangles.col(t)) box.extend(Eigen::Vector3d(mesh.vertices.col(corner)));
        return box;
    };
    const auto join = [](const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) { return a.merged(b); };
    return tbb::parallel_reduce(tbb::blocked_range<Eigen::Index>(0, mesh.triangles.cols()), Eigen::AlignedBox3d(),
                                of_range, join);
}

/// Nodes over `children`, eight to each.
template <typename Child>
Level level_over(const LargeArray<Child>& children)
{
    Level level;
    level.boxes.resize((children.size() + kWide - 1) / kWide);
    tbb::parallel_for(std::size_t{0}, level.boxes.size(), [&](std::size_t i) {
        for (std::size_t k = 0; k < kWide; ++k)
            set(level.boxes[i], k, kWide * i + k < children.size() ? box_of(children[kWide * i + k]) : Box{});
    });
    return level;
}

/// Adds the discs of children with `each` leaves.
void add_discs(Level& level, std::span<const Triangles8> leaves, std::size_t each)
{
    level.discs.resize(level.boxes.size());
    tbb::parallel_for(std::size_t{0}, level.discs.size(), [&](std::size_t i) {
        level.discs[i] = Discs8{};
        for (std::size_t k = 0; k < kWide; ++k) {
            const std::size_t first = std::min((kWide * i + k) * each, leaves.size());
            const std::size_t count = std::min(each, leaves.size() - first);
            if (count > 0) set(level.discs[i], k, disc_about(leaves.subspan(first, count), box_of(level.boxes[i], k)));
        }
    });
}

/// A triangle on its way to a leaf.
struct Middle {
    std::array<float, 3> at; ///< the middle of its corners
    std::uint32_t triangle;
};

/// Puts those that are `wanted` first. No branch depends on the data, which no processor could foresee.
/// @return  how many they are
template <typename Wanted>
std::size_t put_first(std::span<Middle> range, const Wanted& wanted)
{
    std::size_t count = 0;
    for (Middle& next : range) {
        const Middle middle = next;
        next = range[count];
        range[count] = middle;
        count += wanted(middle);
    }
    return count;
}

/// Where along an axis the `count` lowest probably end: from a sample.
float probable_end(std::span<const Middle> range, std::size_t count, std::size_t axis)
{
    std::array<float, 63> sample;
    const std::size_t size = std::clamp<std::size_t>(range.size() / 16 | 1, 3, sample.size());
    for (std::size_t i = 0; i < size; ++i) sample[i] = range[(2 * i + 1) * range.size() / (2 * size)].at[axis];
    const auto end = sample.begin() + static_cast<std::ptrdiff_t>(count * size / range.size());
    std::nth_element(sample.begin(), end, sample.begin() + static_cast<std::ptrdiff_t>(size));
    return *end;
}

/// Puts the `count` lowest along an axis first (Hoare, Algorithm 65: FIND, 1961).
void put_lowest_first(std::span<Middle> range, std::size_t count, std::size_t axis)
{
    while (count > 0 && count < range.size()) {
        const float end = probable_end(range, count, axis);
        const std::size_t below = put_first(range, [&](const Middle& middle) { return middle.at[axis] < end; });
        if (count <= below) {
            range = range.first(below);
            continue;
        }
        range = range.subspan(below);
        count -= below;
        const std::size_t equal = put_first(range, [&](const Middle& middle) { return middle.at[axis] <= end; });
        if (count <= equal || equal == 0) return; // none: the end is NaN, and any order will do
        range = range.subspan(equal);
        count -= equal;
    }
}

/// The axis along which they reach farthest.
std::size_t longest_side(std::span<const Middle> range)
{
    Eigen::Array4f least = Eigen::Array4f::Constant(std::numeric_limits<float>::infinity()), most = -least;
    for (const Middle& middle : range) { // four lanes at once: the triangle's goes along
        Eigen::Array4f at;
        std::memcpy(at.data(), &middle, sizeof at);
        least = least.min(at);
        most = most.max(at);
    }
    int axis = 0;
    (most - least).head<3>().maxCoeff(&axis);
    return static_cast<std::size_t>(axis);
}

/// Puts what belongs to one subtree together: the range is cut in two across its longer side, at a whole number of the
/// largest subtrees below it, until it fits a leaf.
void arrange(std::span<Middle> range)
{
    if (range.size() <= kWide) return;
    std::size_t whole = kWide;
    while (whole * kWide < range.size()) whole *= kWide;
    const std::size_t half = std::max((range.size() / 2 + whole / 2) / whole, std::size_t{1}) * whole;
    put_lowest_first(range, half, longest_side(range));
    const auto lower = [&] { arrange(range.first(half)); };
    const auto upper = [&] { arrange(range.subspan(half)); };
    constexpr std::size_t kParallel = 1 << 13; // smaller ranges are not worth a task
    if (range.size() > kParallel) {
        tbb::parallel_invoke(lower, upper);
    } else {
        lower();
        upper();
    }
}

/// The triangles in the order of the leaves.
LargeArray<std::uint32_t> order_of(const Mesh& mesh, const Eigen::Vector3d& centre)
{
    LargeArray<Middle> middles(static_cast<std::size_t>(mesh.triangles.cols()));
    tbb::parallel_for(std::size_t{0}, middles.size(), [&](std::size_t t) {
        const Eigen::Vector3i corners = mesh.triangles.col(static_cast<Eigen::Index>(t));
        const Eigen::Vector3d sum =
            mesh.vertices.col(corners[0]) + mesh.vertices.col(corners[1]) + mesh.vertices.col(corners[2]);
        Eigen::Vector3f::Map(middles[t].at.data()) = (sum / 3 - centre).cast<float>();
        middles[t].triangle = static_cast<std::uint32_t>(t);
    });
    arrange(middles);
    LargeArray<std::uint32_t> order(middles.size());
    tbb::parallel_for(std::size_t{0}, order.size(), [&](std::size_t i) { order[i] = middles[i].triangle; });
    return order;
}

} // namespace

BoxTree::BoxTree(const Mesh& mesh) : box(box_of(mesh))
{
    const auto count = static_cast<std::size_t>(mesh.triangles.cols());
    if (count == 0) return;
    centre = box.center();
    rounding = std::numeric_limits<float>::epsilon() * box.sizes().maxCoeff() / 2;
    order = order_of(mesh, centre);
    leaves.resize((count + kWide - 1) / kWide);
    tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t l) {
        for (std::size_t k = 0; k < kWide; ++k) {
            const std::uint32_t t = order[std::min(kWide * l + k, count - 1)];
            for (int c = 0; c < 3; ++c) {
                const Eigen::Vector3f at = (mesh.vertices.col(mesh.triangles(c, t)) - centre).cast<float>();
                for (int axis = 0; axis < 3; ++axis) leaves[l].corner[c][axis][k] = at[axis];
            }
        }
    });
    levels.push_back(level_over(leaves));
    while (levels.back().boxes.size() > 1) levels.push_back(level_over(levels.back().boxes));
    std::size_t each = 1; // leaves of a child
    for (std::size_t l = 0; l < std::min(kFlatLevels, levels.size()); ++l, each *= kWide)
        add_discs(levels[l], leaves, each);
}

} // namespace fettle
