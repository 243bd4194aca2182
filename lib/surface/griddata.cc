#include "surface/griddata.h"

#include "core/error.h"
#include "core/text.h"
#include "surface/clough_tocher.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace fettle {

namespace {

// Points nearer than this to each other, relative to the extent of all, are one: triangles between them would be flat.
constexpr double kSamePoint = 1e-9;
// More grid points are no finer surface: 20 or 60 touches carry far less.
constexpr double kMostGridPoints = 20000;

/// One interpolation of nodes that are themselves linear in θ.
struct Stage {
    CloughTocher interpolant;
    Eigen::MatrixXd values;    ///< nodes x θ
    Eigen::MatrixXd gradients; ///< 2 nodes x θ

    Stage(Triangulation triangulation, Eigen::MatrixXd node_values)
        : interpolant(std::move(triangulation)), values(std::move(node_values)),
          gradients(least_curvature_gradients(interpolant.triangulation(), values))
    {
    }

    /// Weight of each θ at a point; NaN outside the hull.
    Eigen::RowVectorXd weights(const Eigen::Vector2d& xy) const
    {
        const auto local = interpolant.weights(xy);
        if (!local) return Eigen::RowVectorXd::Constant(values.cols(), std::numeric_limits<double>::quiet_NaN());
        Eigen::RowVectorXd result = Eigen::RowVectorXd::Zero(values.cols());
        for (int k = 0; k < 3; ++k) {
            const int node = local->corners[k];
            result += local->weights(0, k) * values.row(node) + local->weights(1, k) * gradients.row(2 * node) +
                      local->weights(2, k) * gradients.row(2 * node + 1);
        }
        return result;
    }
};

/// Different points and how each is the mean of the given ones. @return nodes x points
struct Merged {
    Eigen::Matrix2Xd xy;
    Eigen::MatrixXd mean;
};

Merged merge_same(const Eigen::Matrix2Xd& points)
{
    const double same = kSamePoint * (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).maxCoeff();
    std::vector<std::vector<Eigen::Index>> groups;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const auto group = std::ranges::find_if(
            groups, [&](const auto& g) { return (points.col(g.front()) - points.col(i)).norm() <= same; });
        if (group == groups.end())
            groups.push_back({i});
        else
            group->push_back(i);
    }
    // Points on one circle are divided by their order, which must not be that in which they were touched. No two nodes
    // of a grid lie alike along this direction.
    const Eigen::Vector2d along(1, std::numbers::sqrt2);
    std::ranges::sort(groups, {}, [&](const auto& group) { return points.col(group.front()).dot(along); });
    const auto count = static_cast<Eigen::Index>(groups.size());
    Merged merged{Eigen::Matrix2Xd(2, count), Eigen::MatrixXd::Zero(count, points.cols())};
    for (Eigen::Index g = 0; g < count; ++g) {
        const auto& group = groups[static_cast<std::size_t>(g)];
        merged.xy.col(g) = points.col(group.front());
        for (const Eigen::Index i : group) merged.mean(g, i) = 1.0 / static_cast<double>(group.size());
    }
    return merged;
}

/// Nodes of the uniform sampling: along the hull in steps of at most `spacing`, and a square grid inside, centred on
/// the points' bounding box, as far as it is half a spacing from the hull.
Eigen::Matrix2Xd uniform_nodes(const Triangulation& triangulation, double spacing)
{
    const std::vector<int> corners = hull(triangulation);
    std::vector<Eigen::Vector2d> nodes;
    std::vector<Eigen::ParametrizedLine<double, 2>> sides; // inward normals are to their left
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Eigen::Vector2d from = triangulation.points.col(corners[k]);
        const Eigen::Vector2d side = triangulation.points.col(corners[(k + 1) % corners.size()]) - from;
        const double parts = std::ceil(side.norm() / spacing);
        for (double i = 0; i < parts; ++i) nodes.push_back(from + i / parts * side);
        sides.emplace_back(from, side.normalized());
    }
    const auto depth = [&](const Eigen::Vector2d& xy) {
        double least = std::numeric_limits<double>::infinity();
        for (const auto& side : sides) {
            const Eigen::Vector2d to = xy - side.origin();
            least = std::min(least, side.direction().x() * to.y() - side.direction().y() * to.x());
        }
        return least;
    };
    const Eigen::Vector2d low = triangulation.points.rowwise().minCoeff();
    const Eigen::Vector2d high = triangulation.points.rowwise().maxCoeff();
    const Eigen::Vector2d half = ((high - low) / (2 * spacing)).array().floor();
    for (double row = -half.y(); row <= half.y(); ++row)
        for (double column = -half.x(); column <= half.x(); ++column) {
            const Eigen::Vector2d xy = (low + high) / 2 + spacing * Eigen::Vector2d(column, row);
            if (depth(xy) > spacing / 2) nodes.push_back(xy);
        }
    Eigen::Matrix2Xd result(2, static_cast<Eigen::Index>(nodes.size()));
    for (std::size_t i = 0; i < nodes.size(); ++i) result.col(static_cast<Eigen::Index>(i)) = nodes[i];
    return result;
}

Stage resample(const Stage& first, double spacing)
{
    const Triangulation& triangulation = first.interpolant.triangulation();
    const Eigen::Vector2d size = triangulation.points.rowwise().maxCoeff() - triangulation.points.rowwise().minCoeff();
    if ((size / spacing).prod() > kMostGridPoints)
        throw InputError("the spacing of " + to_text(spacing) + " mm gives more than " + to_text(kMostGridPoints) +
                         " grid points");
    const Eigen::Matrix2Xd nodes = uniform_nodes(triangulation, spacing);
    Eigen::MatrixXd values(nodes.cols(), first.values.cols());
    for (Eigen::Index i = 0; i < nodes.cols(); ++i) values.row(i) = first.weights(nodes.col(i));
    return Stage(delaunay(nodes), std::move(values));
}

void check(const Eigen::Matrix3Xd& points)
{
    if (points.cols() < 3)
        throw InputError("griddata needs at least 3 points, there are " + std::to_string(points.cols()));
    if (!points.allFinite()) throw InputError("a point is not finite");
}

/// @param fields  points x C, what is interpolated
Stage interpolate(const Eigen::Matrix2Xd& points, const Eigen::MatrixXd& fields, double spacing)
{
    const Merged merged = merge_same(points);
    Stage once(delaunay(merged.xy), merged.mean * fields);
    return spacing > 0 ? resample(once, spacing) : once;
}

} // namespace

struct Griddata::Interpolant {
    Eigen::Matrix2d rotation_grid_machine;
    Stage stage;
    Eigen::MatrixXd node_data; ///< nodes x 3: z and its derivatives along the grid's axes, for heights alone
};

Griddata make_griddata(const Eigen::Matrix3Xd& points, double spacing, double angle)
{
    check(points);
    const Eigen::Matrix2d rotation = rotation_working_machine(angle);
    const Eigen::VectorXd z = points.row(2).transpose();
    Stage stage = interpolate(rotation * points.topRows<2>(), Eigen::MatrixXd::Identity(z.size(), z.size()), spacing);
    const Eigen::VectorXd gradients = stage.gradients * z;
    Eigen::MatrixXd data(stage.values.rows(), 3);
    data.col(0) = stage.values * z;
    data.rightCols<2>() = Eigen::Map<const Eigen::Matrix2Xd>(gradients.data(), 2, data.rows()).transpose();
    return {points, spacing, angle,
            std::make_shared<const Griddata::Interpolant>(
                Griddata::Interpolant{rotation, std::move(stage), std::move(data)})};
}

Eigen::VectorXd griddata_heights(const Eigen::Matrix3Xd& points, double spacing, double angle,
                                 const Eigen::Matrix2Xd& xy)
{
    check(points);
    const Eigen::Matrix2d rotation = rotation_working_machine(angle);
    const Stage stage = interpolate(rotation * points.topRows<2>(), points.row(2).transpose(), spacing);
    Eigen::VectorXd z(xy.cols());
    for (Eigen::Index i = 0; i < xy.cols(); ++i) z[i] = stage.weights(rotation * xy.col(i)).value();
    return z;
}

double height(const Griddata& surface, const Eigen::Vector2d& xy)
{
    const Griddata::Interpolant& made = *surface.interpolant;
    const auto local = made.stage.interpolant.weights(made.rotation_grid_machine * xy);
    if (!local) return std::numeric_limits<double>::quiet_NaN();
    double z = 0;
    for (int k = 0; k < 3; ++k) z += made.node_data.row(local->corners[k]) * local->weights.col(k);
    return z;
}

Eigen::VectorXd height_gradient(const Griddata& surface, const Eigen::Vector2d& xy)
{
    const Griddata::Interpolant& made = *surface.interpolant;
    return made.stage.weights(made.rotation_grid_machine * xy).transpose();
}

Eigen::VectorXi parameter_powers(const Griddata& surface)
{
    return Eigen::VectorXi::Constant(surface.points.cols(), 1);
}

} // namespace fettle
