#include "fit/representatives.h"

#include "core/decompositions.h"
#include "geometry/quantiles.h"
#include "surface/shapes.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// A cell of the grid that holds points.
struct WeightedCell {
    Vector2d at; ///< its middle, from the grid's corner along its axes, mm
    double weight = 0;
    double height = 0; ///< above the trend, mm
};
using Group = std::span<WeightedCell>;

std::vector<WeightedCell> cells_with_points(const RobustSpline& spline)
{
    const surface::Bspline trend = spline.trend_alone();
    const MatrixXd& weights = spline.last.weights;
    std::vector<WeightedCell> cells;
    for (Index column = 0; column < weights.cols(); ++column)
        for (Index row = 0; row < weights.rows(); ++row) {
            if (!(weights(row, column) > 0)) continue;
            const Vector2d uv(row + 0.5, column + 0.5);
            const double q = surface::height(trend, machine_from_grid(trend, uv));
            cells.push_back({uv.cwiseProduct(trend.cell), weights(row, column), spline.last.heights(row, column) - q});
        }
    return cells;
}

double weight_of(Group cells)
{
    double sum = 0;
    for (const WeightedCell& cell : cells) sum += cell.weight;
    return sum;
}

/// Divides cells into `parts` groups of about the same weight, across their longer side each time.
void divide(Group cells, std::size_t parts, std::vector<Group>& groups)
{
    if (parts <= 1 || cells.size() <= 1) {
        groups.push_back(cells);
        return;
    }
    Eigen::AlignedBox2d box;
    for (const WeightedCell& cell : cells) box.extend(cell.at);
    const int axis = box.sizes().x() >= box.sizes().y() ? 0 : 1;
    std::stable_sort(cells.begin(), cells.end(),
                     [axis](const WeightedCell& a, const WeightedCell& b) { return a.at[axis] < b.at[axis]; });
    const std::size_t parts_below = parts / 2;
    const double wanted = weight_of(cells) * parts_below / parts;
    std::size_t count = 0;
    for (double sum = 0; count < cells.size() && sum + cells[count].weight / 2 < wanted; ++count)
        sum += cells[count].weight;
    count = std::clamp<std::size_t>(count, 1, cells.size() - 1);
    divide(cells.first(count), parts_below, groups);
    divide(cells.subspan(count), parts - parts_below, groups);
}

/// The plane of least squares through a group, about its centroid.
struct GroupPlane {
    Vector2d centroid = Vector2d::Zero();
    Eigen::Vector3d coefficients; ///< height at the centroid, slopes

    double at(const Vector2d& place) const { return coefficients[0] + coefficients.tail<2>().dot(place - centroid); }
};

GroupPlane fit_group(Group cells)
{
    GroupPlane plane;
    for (const WeightedCell& cell : cells) plane.centroid += cell.weight * cell.at;
    plane.centroid /= weight_of(cells);
    MatrixXd A(cells.size(), 3);
    VectorXd z(A.rows());
    for (Index i = 0; i < A.rows(); ++i) {
        const double root = std::sqrt(cells[i].weight);
        A.row(i) << root, root * (cells[i].at - plane.centroid).transpose();
        z[i] = root * cells[i].height;
    }
    plane.coefficients = core::min_norm_least_squares(A, z).x;
    return plane;
}

/// The member nearest to the group's centroid: where points are, even if the group lies around B.
const WeightedCell& middle_cell(Group cells, const Vector2d& centroid)
{
    return *std::min_element(cells.begin(), cells.end(), [&](const WeightedCell& a, const WeightedCell& b) {
        return (a.at - centroid).squaredNorm() < (b.at - centroid).squaredNorm();
    });
}

/// The square of how the quarters of a group differ from a plane through them: one degree of freedom.
std::optional<double> squared_contrast(Group cells)
{
    constexpr std::size_t kMinCells = 8; // two for each quarter
    if (cells.size() < kMinCells) return std::nullopt;
    std::vector<Group> quarters;
    divide(cells, 4, quarters);
    MatrixXd A(4, 3);
    VectorXd z = VectorXd::Zero(4);
    for (Index k = 0; k < 4; ++k) {
        Vector2d middle = Vector2d::Zero();
        for (const WeightedCell& cell : quarters[k]) {
            middle += cell.weight * cell.at;
            z[k] += cell.weight * cell.height;
        }
        const double sum = weight_of(quarters[k]);
        A.row(k) << 1, middle.transpose() / sum;
        z[k] /= sum;
    }
    return (z - A * core::least_squares_by_qr(A, z).x).squaredNorm();
}

/// How far a place lies above the plane through its nearest neighbours.
double height_above_neighbours(const Eigen::Matrix3Xd& xyz, Index place)
{
    constexpr Index kNeighbours = 12;
    const Eigen::Matrix3Xd offset = xyz.colwise() - xyz.col(place);
    std::vector<Index> nearest(xyz.cols());
    std::iota(nearest.begin(), nearest.end(), Index{0});
    std::stable_sort(nearest.begin(), nearest.end(), [&](Index a, Index b) {
        return offset.col(a).head<2>().squaredNorm() < offset.col(b).head<2>().squaredNorm();
    });
    nearest.erase(nearest.begin()); // the place itself
    nearest.resize(std::min<std::size_t>(kNeighbours, nearest.size()));
    const Eigen::Matrix3Xd around = offset(Eigen::all, nearest);
    MatrixXd A(around.cols(), 3);
    A << VectorXd::Ones(around.cols()), around.topRows<2>().transpose();
    return -core::min_norm_least_squares(A, around.row(2).transpose()).x[0];
}

/// Leaves out, one by one, heights off their neighbours' plane by far more than all others and by more than any metal
/// bends there: inner faces and dust where a scan has nothing else.
/// @return  their number
std::size_t drop_separate(Eigen::Matrix3Xd& xyz, double spacing)
{
    constexpr double kMaxDeviations = 10; // times the standard deviation of all
    constexpr double kMinSteps = 0.25;    // times the distance of neighbours
    constexpr Index kMinKept = 24;        // fewer have no neighbourhoods to compare
    std::size_t dropped = 0;
    for (; xyz.cols() > kMinKept; ++dropped) {
        VectorXd above(xyz.cols());
        for (Index i = 0; i < xyz.cols(); ++i) above[i] = height_above_neighbours(xyz, i);
        Index worst = 0;
        const double largest = above.cwiseAbs().maxCoeff(&worst);
        const double usual = geometry::median_absolute(above) / geometry::kNormalQuartile;
        if (!(largest > std::max(kMaxDeviations * usual, kMinSteps * spacing))) break;
        const Index last = xyz.cols() - 1;
        xyz.middleCols(worst, last - worst) = xyz.rightCols(last - worst).eval();
        xyz.conservativeResize(3, last);
    }
    return dropped;
}

double sigma_of_groups(const std::vector<Group>& groups, double point_sigma)
{
    constexpr double kMedianOfSquare = 0.454936; // of the square of a normal number of variance 1
    constexpr std::size_t kMinContrasts = 12;    // their median is known to a third
    std::vector<double> points, contrasts;
    for (const Group& group : groups) {
        points.push_back(weight_of(group));
        if (const std::optional<double> contrast = squared_contrast(group)) contrasts.push_back(*contrast);
    }
    const double independent = point_sigma / std::sqrt(std::max(geometry::median(points), 1.0));
    if (contrasts.size() < kMinContrasts) return independent;
    const double of_a_quarter = std::sqrt(geometry::median(contrasts) / kMedianOfSquare);
    return std::max(independent, of_a_quarter / 2); // the mean of four
}

} // namespace

Representatives condense(const DensePoints& points, const RobustSpline& spline)
{
    std::vector<WeightedCell> cells = cells_with_points(spline);
    std::vector<Group> groups;
    divide(cells, std::min(kMaxRepresentatives, cells.size()), groups);
    const surface::Bspline trend = spline.trend_alone();
    Representatives result;
    result.sigma = sigma_of_groups(groups, spline.sigma);
    result.xyz.resize(3, groups.size());
    for (Index k = 0; k < result.xyz.cols(); ++k) {
        const GroupPlane plane = fit_group(groups[k]);
        const Vector2d place = middle_cell(groups[k], plane.centroid).at;
        const Vector2d xy = machine_from_grid(points.grid, place.cwiseQuotient(points.grid.cell));
        result.xyz.col(k) << xy, surface::height(trend, xy) + plane.at(place);
    }
    const Vector2d sides = points.grid.cell * std::sqrt(static_cast<double>(cells.size()) / groups.size());
    result.dropped = drop_separate(result.xyz, sides.mean());
    return result;
}

} // namespace fettle::fit
