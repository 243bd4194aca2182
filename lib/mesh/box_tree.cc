#include "mesh/box_tree.h"

#include "core/hilbert.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <limits>

namespace fettle {

namespace {

constexpr std::size_t kWide = 8;

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
    for (int axis = 0; axis < 3; ++axis)
        for (std::size_t k = 0; k < kWide; ++k) {
            box.least[axis] = std::min(box.least[axis], boxes.least[axis][k]);
            box.most[axis] = std::max(box.most[axis], boxes.most[axis][k]);
        }
    return box;
}

Box box_of(const Triangles8& triangles)
{
    Box box;
    for (int axis = 0; axis < 3; ++axis)
        for (const auto& corner : triangles.corner)
            for (std::size_t k = 0; k < kWide; ++k) {
                box.least[axis] = std::min(box.least[axis], corner[axis][k]);
                box.most[axis] = std::max(box.most[axis], corner[axis][k]);
            }
    return box;
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
std::vector<Boxes8> nodes_over(const std::vector<Child>& children)
{
    std::vector<Boxes8> nodes((children.size() + kWide - 1) / kWide);
    tbb::parallel_for(std::size_t{0}, nodes.size(), [&](std::size_t i) {
        for (std::size_t k = 0; k < kWide; ++k)
            set(nodes[i], k, kWide * i + k < children.size() ? box_of(children[kWide * i + k]) : Box{});
    });
    return nodes;
}

} // namespace

BoxTree::BoxTree(const Mesh& mesh) : box(box_of(mesh))
{
    const auto count = static_cast<std::size_t>(mesh.triangles.cols());
    if (count == 0) return;
    centre = box.center();
    rounding = std::numeric_limits<float>::epsilon() * box.sizes().maxCoeff() / 2;
    order = hilbert_order(count, [&](std::size_t t) -> Eigen::Vector3d {
        const Eigen::Vector3i corners = mesh.triangles.col(static_cast<Eigen::Index>(t));
        return (mesh.vertices.col(corners[0]) + mesh.vertices.col(corners[1]) + mesh.vertices.col(corners[2])) / 3;
    });
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
    levels.push_back(nodes_over(leaves));
    while (levels.back().size() > 1) levels.push_back(nodes_over(levels.back()));
}

} // namespace fettle
