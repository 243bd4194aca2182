#include "machining/walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace fettle {
namespace {

/// Cosine of the least angle of a wall's normal to Z: 0.06 degrees, ten times what the rounding of an STL's floats
/// turns a facet whose size is a thousandth of its distance from the origin.
constexpr double kUpright = 1e-3;
/// Of the box that the bins cover: a million of them at most.
constexpr double kMostBinsOfSide = 1024;

using Segment = std::array<Eigen::Vector2d, 2>;
using Corners = Eigen::Matrix<double, 2, 3>;

double side(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p)
{
    return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

/// Do they touch? By a line that parts them: one along a side of either, or upright or level.
bool touch(const Segment& s, const Corners& t)
{
    for (int axis = 0; axis < 2; ++axis)
        if (std::max(s[0][axis], s[1][axis]) < t.row(axis).minCoeff() ||
            std::min(s[0][axis], s[1][axis]) > t.row(axis).maxCoeff())
            return false;
    const auto apart = [](double least, double most) { return least > 0 || most < 0; };
    const Eigen::Vector3d across(side(s[0], s[1], t.col(0)), side(s[0], s[1], t.col(1)), side(s[0], s[1], t.col(2)));
    if (apart(across.minCoeff(), across.maxCoeff())) return false;
    for (int k = 0; k < 3; ++k) {
        const Eigen::Vector2d a = t.col(k), b = t.col((k + 1) % 3);
        const double third = side(a, b, t.col((k + 2) % 3)), p = side(a, b, s[0]), q = side(a, b, s[1]);
        if (third > 0 ? std::max(p, q) < 0 : std::min(p, q) > 0) return false;
    }
    return true;
}

} // namespace

struct Walls::State {
    std::vector<Segment> segments;
    Eigen::Array2d low{0, 0};
    double bin = 1;
    Eigen::Index columns = 0, rows = 0;
    std::vector<std::vector<std::size_t>> bins;

    template <typename Visit>
    void visit(const Eigen::Array2d& least, const Eigen::Array2d& most, const Visit& look) const
    {
        const auto at = [&](double v, double from, Eigen::Index count) {
            return static_cast<Eigen::Index>(std::clamp((v - from) / bin, 0.0, static_cast<double>(count - 1)));
        };
        for (Eigen::Index j = at(least.y(), low.y(), rows); j <= at(most.y(), low.y(), rows); ++j)
            for (Eigen::Index i = at(least.x(), low.x(), columns); i <= at(most.x(), low.x(), columns); ++i)
                look(static_cast<std::size_t>(j * columns + i));
    }
};

Walls::Walls(const Mesh& mesh, double cell)
{
    auto state = std::make_unique<State>();
    const Eigen::Matrix3Xd normals = triangle_normals(mesh);
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        if (std::abs(normals(2, t)) > kUpright || normals.col(t).isZero()) continue;
        Segment longest = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
        for (int k = 0; k < 3; ++k) {
            const Segment edge = {mesh.vertices.col(mesh.triangles(k, t)).head<2>(),
                                  mesh.vertices.col(mesh.triangles((k + 1) % 3, t)).head<2>()};
            if ((edge[1] - edge[0]).norm() > (longest[1] - longest[0]).norm()) longest = edge;
        }
        state->segments.push_back(longest);
    }
    if (!state->segments.empty()) {
        Eigen::Array2d high = state->segments[0][0].array();
        state->low = high;
        for (const Segment& s : state->segments)
            for (const Eigen::Vector2d& end : s) {
                state->low = state->low.min(end.array());
                high = high.max(end.array());
            }
        const Eigen::Array2d size = high - state->low;
        state->bin = std::max({cell, size.maxCoeff() / kMostBinsOfSide, std::numeric_limits<double>::min()});
        state->columns = static_cast<Eigen::Index>(size.x() / state->bin) + 1;
        state->rows = static_cast<Eigen::Index>(size.y() / state->bin) + 1;
        state->bins.resize(static_cast<std::size_t>(state->columns * state->rows));
        for (std::size_t n = 0; n < state->segments.size(); ++n) {
            const Segment& s = state->segments[n];
            state->visit(s[0].array().min(s[1].array()), s[0].array().max(s[1].array()),
                         [&](std::size_t bin) { state->bins[bin].push_back(n); });
        }
    }
    state_ = std::move(state);
}

Walls::~Walls() = default;

bool Walls::meet(const Corners& triangle) const
{
    if (state_->segments.empty()) return false;
    bool met = false;
    state_->visit(triangle.rowwise().minCoeff().array(), triangle.rowwise().maxCoeff().array(), [&](std::size_t bin) {
        for (const std::size_t n : state_->bins[bin]) met = met || touch(state_->segments[n], triangle);
    });
    return met;
}

} // namespace fettle
