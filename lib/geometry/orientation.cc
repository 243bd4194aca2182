#include "geometry/orientation.h"

#include "geometry/union_find.h"

#include <tbb/parallel_sort.h>

#include <cmath>
#include <tuple>

namespace fettle::geometry {
namespace {

struct Edge {
    float difference; ///< 1 - |cosine| of the normals
    std::uint32_t a, b;
    auto key() const { return std::tuple(difference, a, b); }
};

/// Sum of the normals of each piece, at its root.
Eigen::Matrix3Xd sums_of_pieces(const Eigen::Matrix3Xd& normals, UnionFind& pieces)
{
    Eigen::Matrix3Xd sums = Eigen::Matrix3Xd::Zero(3, normals.cols());
    for (Eigen::Index i = 0; i < normals.cols(); ++i)
        sums.col(pieces.root(static_cast<std::uint32_t>(i))) += normals.col(i);
    return sums;
}

} // namespace

void orient_consistently(Eigen::Matrix3Xd& normals, const Eigen::Matrix3Xd& xyz,
                         const std::vector<std::vector<std::uint32_t>>& neighbours, const Eigen::Matrix3Xd& hints)
{
    if (normals.cols() == 0) return;
    std::vector<Edge> edges;
    for (std::uint32_t a = 0; a < neighbours.size(); ++a)
        for (const std::uint32_t b : neighbours[a])
            if (a < b && !normals.col(a).isZero(0) && !normals.col(b).isZero(0))
                edges.push_back({static_cast<float>(1 - std::abs(normals.col(a).dot(normals.col(b)))), a, b});
    tbb::parallel_sort(edges, [](const Edge& one, const Edge& other) { return one.key() < other.key(); });
    UnionFind pieces(neighbours.size());
    for (const Edge& edge : edges) pieces.join(edge.a, edge.b, normals.col(edge.a).dot(normals.col(edge.b)) < 0);
    Eigen::VectorXd votes = Eigen::VectorXd::Zero(normals.cols());
    for (Eigen::Index i = 0; i < normals.cols(); ++i) {
        const auto root = pieces.find(static_cast<std::uint32_t>(i));
        if (root.odd) normals.col(i) *= -1;
        votes[root.element] += normals.col(i).dot(hints.col(i).stableNormalized());
    }
    const Eigen::Matrix3Xd sums = sums_of_pieces(normals, pieces);
    Eigen::Index largest = 0;
    sums.colwise().squaredNorm().maxCoeff(&largest);
    // Without a hint most parts are seen from outside, where they are convex.
    Eigen::Vector3d side = sums.col(largest);
    const Eigen::Vector3d middle = xyz.rowwise().mean();
    if (((xyz.colwise() - middle).array() * normals.array()).sum() < 0) side *= -1;
    for (Eigen::Index i = 0; i < normals.cols(); ++i) {
        const std::uint32_t root = pieces.root(static_cast<std::uint32_t>(i));
        const double vote = votes[root] != 0 ? votes[root] : sums.col(root).dot(side);
        if (vote < 0) normals.col(i) *= -1;
    }
}

} // namespace fettle::geometry
