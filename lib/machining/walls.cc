#include "machining/walls.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::machining {
namespace {

/// Largest |z| of a wall's unit normal: 0.06 degrees, ten times the angle by which the rounding of an STL's floats
/// turns a facet whose size is a thousandth of its distance from the origin.
constexpr double kMaxNormalZ = 1e-3;
/// Largest number of bins along a side of the grid: at most a million bins.
constexpr double kMaxBinsPerSide = 1024;

using Segment = std::array<Eigen::Vector2d, 2>;
using WallCorners = Eigen::Matrix<double, 2, 3>;

/// Twice the signed area of the triangle a, b, p: positive if p is left of the line.
double side(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p)
{
    return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

/// Whether a segment and a triangle have a common point, by the separating axis theorem: the candidate lines are
/// parallel to the segment, the triangle's edges, or the coordinate axes.
bool intersect(const Segment& s, const WallCorners& t)
{
    for (int axis = 0; axis < 2; ++axis)
        if (std::max(s[0][axis], s[1][axis]) < t.row(axis).minCoeff() ||
            std::min(s[0][axis], s[1][axis]) > t.row(axis).maxCoeff())
            return false;
    const Eigen::Vector3d across(side(s[0], s[1], t.col(0)), side(s[0], s[1], t.col(1)), side(s[0], s[1], t.col(2)));
    if (across.minCoeff() > 0 || across.maxCoeff() < 0) return false;
    for (int k = 0; k < 3; ++k) {
        const Eigen::Vector2d a = t.col(k), b = t.col((k + 1) % 3);
        const double third = side(a, b, t.col((k + 2) % 3)), p = side(a, b, s[0]), q = side(a, b, s[1]);
        if (third > 0 ? std::max(p, q) < 0 : std::min(p, q) > 0) return false;
    }
    return true;
}

} // namespace

/// Calls visit(index) for the bins that a box overlaps.
template <typename Visit>
void Walls::for_bins(const Eigen::Array2d& min, const Eigen::Array2d& max, const Visit& visit) const
{
    const auto bin_at = [this](double offset, Eigen::Index count) {
        return static_cast<Eigen::Index>(std::clamp<double>(offset / bin_size_, 0, count - 1));
    };
    const Eigen::Array2d low = min - origin_, high = max - origin_;
    for (Eigen::Index j = bin_at(low.y(), rows_); j <= bin_at(high.y(), rows_); ++j)
        for (Eigen::Index i = bin_at(low.x(), columns_); i <= bin_at(high.x(), columns_); ++i) visit(j * columns_ + i);
}

Walls::Walls(const mesh::Mesh& mesh, double cell)
{
    const Eigen::Matrix3Xd normals = mesh::triangle_normals(mesh);
    Eigen::AlignedBox2d box;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        if (std::abs(normals(2, t)) > kMaxNormalZ || normals.col(t).isZero()) continue;
        Segment longest = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
        for (int k = 0; k < 3; ++k) {
            const Segment edge = {mesh.vertices.col(mesh.triangles(k, t)).head<2>(),
                                  mesh.vertices.col(mesh.triangles((k + 1) % 3, t)).head<2>()};
            if ((edge[1] - edge[0]).norm() > (longest[1] - longest[0]).norm()) longest = edge;
        }
        segments_.push_back(longest);
        box.extend(longest[0]).extend(longest[1]);
    }
    if (segments_.empty()) return;
    origin_ = box.min();
    bin_size_ = std::max({cell, box.sizes().maxCoeff() / kMaxBinsPerSide, std::numeric_limits<double>::min()});
    columns_ = static_cast<Eigen::Index>(box.sizes().x() / bin_size_) + 1;
    rows_ = static_cast<Eigen::Index>(box.sizes().y() / bin_size_) + 1;
    bins_.resize(columns_ * rows_);
    for (std::size_t n = 0; n < segments_.size(); ++n) {
        const auto& [a, b] = segments_[n];
        for_bins(a.cwiseMin(b), a.cwiseMax(b), [&](Eigen::Index bin) { bins_[bin].push_back(n); });
    }
}

bool Walls::intersects(const WallCorners& triangle) const
{
    if (segments_.empty()) return false;
    bool hit = false;
    for_bins(triangle.rowwise().minCoeff(), triangle.rowwise().maxCoeff(), [&](Eigen::Index bin) {
        for (const std::size_t n : bins_[bin]) hit = hit || intersect(segments_[n], triangle);
    });
    return hit;
}

} // namespace fettle::machining
