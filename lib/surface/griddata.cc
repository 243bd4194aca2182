#include "surface/griddata.h"

#include "core/constants.h"
#include "core/error.h"
#include "core/text.h"
#include "geometry/bounding_box.h"
#include "geometry/division.h"
#include "job/boundary.h"
#include "surface/clough_tocher.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <numbers>
#include <vector>

namespace fettle::surface {

namespace {

// Points closer than this, relative to the extent of all points, are merged: triangles between them would be flat.
constexpr double kDuplicatePointTolerance = 1e-9;
// Bounds time and memory; the 20 to 60 touches of a job do not determine a finer surface.
constexpr double kMaxNodes = 20000;

/// One interpolation of nodes whose values are linear in θ.
struct Stage {
    CloughTocher interpolant;
    Eigen::MatrixXd values;    ///< nodes x θ
    Eigen::MatrixXd gradients; ///< 2 nodes x θ

    Stage(Triangulation triangulation, Eigen::MatrixXd node_values)
        : interpolant(std::move(triangulation)), values(std::move(node_values)),
          gradients(min_curvature_gradients(interpolant.triangulation(), values))
    {
    }

    /// Weights of θ in the height at a point; NaN outside the convex hull.
    Eigen::RowVectorXd weights(const Eigen::Vector2d& xy) const
    {
        const auto local = interpolant.weights(xy);
        if (!local) return Eigen::RowVectorXd::Constant(values.cols(), core::kNaN);
        Eigen::RowVectorXd result = Eigen::RowVectorXd::Zero(values.cols());
        for (int k = 0; k < 3; ++k) {
            const int node = local->corners[k];
            result += local->weights(0, k) * values.row(node) + local->weights(1, k) * gradients.row(2 * node) +
                      local->weights(2, k) * gradients.row(2 * node + 1);
        }
        return result;
    }
};

/// Distinct points, each the mean of the given points at the same place.
struct MergedPoints {
    Eigen::Matrix2Xd xy;
    Eigen::MatrixXd mean; ///< nodes x points: weight of each given point
};

MergedPoints merge_duplicates(const Eigen::Matrix2Xd& points)
{
    const double tolerance = kDuplicatePointTolerance * geometry::bounding_box(points).sizes().maxCoeff();
    std::vector<std::vector<Eigen::Index>> groups;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const auto group = std::ranges::find_if(
            groups, [&](const auto& g) { return (points.col(g.front()) - points.col(i)).norm() <= tolerance; });
        if (group == groups.end())
            groups.push_back({i});
        else
            group->push_back(i);
    }
    // Cocircular points are triangulated by their order, which must not depend on the order of the touches. No two
    // nodes of a grid have the same coordinate along this direction.
    const Eigen::Vector2d along(1, std::numbers::sqrt2);
    std::ranges::sort(groups, {}, [&](const auto& group) { return points.col(group.front()).dot(along); });
    MergedPoints merged{Eigen::Matrix2Xd(2, groups.size()), Eigen::MatrixXd::Zero(groups.size(), points.cols())};
    for (std::size_t g = 0; g < groups.size(); ++g) {
        merged.xy.col(g) = points.col(groups[g].front());
        for (const Eigen::Index i : groups[g]) merged.mean(g, i) = 1.0 / groups[g].size();
    }
    return merged;
}

/// Nodes of the uniform sampling: points on the hull in steps of at most `spacing`, and those points of a square grid,
/// centred on the bounding box, that are inside the hull and more than half a spacing away from it.
Eigen::Matrix2Xd uniform_nodes(const Triangulation& triangulation, double spacing)
{
    const std::vector<int> corners = hull_corners(triangulation);
    std::vector<Eigen::Vector2d> nodes;
    std::vector<Eigen::ParametrizedLine<double, 2>> sides; // inward normals are to their left
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Eigen::Vector2d from = triangulation.points.col(corners[k]);
        const Eigen::Vector2d to = triangulation.points.col(corners[(k + 1) % corners.size()]);
        const Eigen::Matrix2Xd added = geometry::division_points(from, to, spacing);
        nodes.push_back(from);
        for (const auto& point : added.colwise()) nodes.emplace_back(point);
        sides.emplace_back(from, (to - from).normalized());
    }
    const auto distance_inside_hull = [&](const Eigen::Vector2d& xy) {
        double min = core::kInfinity;
        for (const auto& side : sides) {
            const Eigen::Vector2d to = xy - side.origin();
            min = std::min(min, side.direction().x() * to.y() - side.direction().y() * to.x());
        }
        return min;
    };
    const Eigen::AlignedBox2d box = geometry::bounding_box(triangulation.points);
    const Eigen::Vector2d half = (box.sizes() / (2 * spacing)).array().floor();
    for (double row = -half.y(); row <= half.y(); ++row)
        for (double column = -half.x(); column <= half.x(); ++column) {
            const Eigen::Vector2d xy = box.center() + spacing * Eigen::Vector2d(column, row);
            if (distance_inside_hull(xy) > spacing / 2) nodes.push_back(xy);
        }
    return job::columns_to_matrix(nodes);
}

Stage resample(const Stage& first, double spacing)
{
    const Triangulation& triangulation = first.interpolant.triangulation();
    const Eigen::Vector2d size = geometry::bounding_box(triangulation.points).sizes();
    if ((size / spacing).prod() > kMaxNodes)
        throw core::InputError("the spacing of " + core::to_text(spacing) + " mm gives more than " +
                               core::to_text(kMaxNodes) + " grid points");
    const Eigen::Matrix2Xd nodes = uniform_nodes(triangulation, spacing);
    Eigen::MatrixXd values(nodes.cols(), first.values.cols());
    for (Eigen::Index i = 0; i < nodes.cols(); ++i) values.row(i) = first.weights(nodes.col(i));
    return Stage(delaunay(nodes), std::move(values));
}

void check_points(const Eigen::Matrix3Xd& points)
{
    if (points.cols() < 3)
        throw core::InputError("griddata needs at least 3 points, there are " + std::to_string(points.cols()));
    if (!points.allFinite()) throw core::InputError("a point is not finite");
}

/// @param fields  points x C, the values to interpolate
Stage interpolate(const Eigen::Matrix2Xd& points, const Eigen::MatrixXd& fields, double spacing)
{
    const MergedPoints merged = merge_duplicates(points);
    Stage once(delaunay(merged.xy), merged.mean * fields);
    return spacing > 0 ? resample(once, spacing) : once;
}

} // namespace

struct Griddata::Interpolant {
    Eigen::Matrix2d rotation_grid_machine;
    Stage stage;
    Eigen::MatrixXd node_data; ///< nodes x 3: z and its derivatives along the grid's axes
};

Griddata make_griddata(const Eigen::Matrix3Xd& points, double spacing, double angle)
{
    check_points(points);
    const Eigen::Matrix2d rotation = job::rotation_working_machine(angle);
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
    check_points(points);
    const Eigen::Matrix2d rotation = job::rotation_working_machine(angle);
    const Stage stage = interpolate(rotation * points.topRows<2>(), points.row(2).transpose(), spacing);
    Eigen::VectorXd z(xy.cols());
    for (Eigen::Index i = 0; i < xy.cols(); ++i) z[i] = stage.weights(rotation * xy.col(i)).value();
    return z;
}

double height(const Griddata& surface, const Eigen::Vector2d& xy)
{
    const Griddata::Interpolant& interpolant = *surface.interpolant;
    const auto local = interpolant.stage.interpolant.weights(interpolant.rotation_grid_machine * xy);
    if (!local) return core::kNaN;
    double z = 0;
    for (int k = 0; k < 3; ++k) z += interpolant.node_data.row(local->corners[k]) * local->weights.col(k);
    return z;
}

Eigen::VectorXd height_gradient(const Griddata& surface, const Eigen::Vector2d& xy)
{
    const Griddata::Interpolant& interpolant = *surface.interpolant;
    return interpolant.stage.weights(interpolant.rotation_grid_machine * xy).transpose();
}

} // namespace fettle::surface
