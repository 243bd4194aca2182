#include "compare/areas.h"

#include <Eigen/Dense>

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

namespace fettle {

namespace {

constexpr double kPointsPerSquare = 16;

constexpr double kSteepest = 0.1; // least |n_z| for which an area seen from above tells that of the surface: 84°

// A point further than this from its lattice place, in cells, is not on the lattice. Rounding to float stays far below.
constexpr double kOffLattice = 0.1;
// The first estimate of the cell, from two neighbours, is good to about 1e-3: over so many cells it still tells places.
constexpr double kFirstReach = 50;

/// p = origin + i a + j b
struct Lattice {
    Eigen::Vector2d origin, a, b;
    Eigen::Matrix2d cell() const { return (Eigen::Matrix2d() << a, b).finished(); }
};

Eigen::Matrix2Xd finite_plan(const Eigen::Matrix3Xd& xyz)
{
    std::vector<Eigen::Index> finite;
    for (Eigen::Index i = 0; i < xyz.cols(); ++i)
        if (xyz.col(i).allFinite()) finite.push_back(i);
    return xyz.topRows<2>()(Eigen::all, finite);
}

// The shortest step from the first point to another, and the shortest one across it.
std::optional<Lattice> guess(const Eigen::Matrix2Xd& plan)
{
    const Eigen::Matrix2Xd steps = plan.colwise() - plan.col(0).eval();
    const auto shortest = [&](const auto& allowed) -> std::optional<Eigen::Vector2d> {
        std::optional<Eigen::Vector2d> best;
        for (const Eigen::Vector2d step : steps.colwise())
            if (step.squaredNorm() > 0 && allowed(step) && (!best || step.squaredNorm() < best->squaredNorm()))
                best = step;
        return best;
    };
    const auto a = shortest([](const Eigen::Vector2d&) { return true; });
    if (!a) return std::nullopt;
    const auto b = shortest(
        [&](const Eigen::Vector2d& step) { return std::abs(step.dot(*a)) < kOffLattice * a->norm() * step.norm(); });
    if (!b) return std::nullopt;
    return Lattice{plan.col(0), *a, *b};
}

// Least squares of the points within `reach` cells; nothing if one of them is off its place.
std::optional<Lattice> refine(const Eigen::Matrix2Xd& plan, const Lattice& lattice, double reach)
{
    const Eigen::Matrix2d to_cells = lattice.cell().inverse();
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, 2> B = Eigen::Matrix<double, 3, 2>::Zero();
    for (const Eigen::Vector2d p : plan.colwise()) {
        const Eigen::Vector2d cells = to_cells * (p - lattice.origin);
        if (cells.cwiseAbs().maxCoeff() > reach) continue;
        const Eigen::Vector2d place = cells.array().round();
        if ((cells - place).cwiseAbs().maxCoeff() > kOffLattice) return std::nullopt;
        const Eigen::Vector3d row(1, place.x(), place.y());
        A += row * row.transpose();
        B += row * (p - lattice.origin).transpose();
    }
    const Eigen::FullPivLU<Eigen::Matrix3d> solver(A);
    if (!solver.isInvertible()) return std::nullopt;
    const Eigen::Matrix<double, 3, 2> fit = solver.solve(B);
    return Lattice{lattice.origin + fit.row(0).transpose(), fit.row(1).transpose(), fit.row(2).transpose()};
}

std::optional<double> lattice_cell(const Eigen::Matrix2Xd& plan)
{
    if (plan.cols() < 4) return std::nullopt;
    std::optional<Lattice> lattice = guess(plan);
    for (const double reach : {kFirstReach, std::numeric_limits<double>::infinity()})
        if (lattice) lattice = refine(plan, *lattice, reach);
    if (!lattice) return std::nullopt;
    return std::abs(lattice->cell().determinant());
}

} // namespace

Eigen::VectorXd vertex_areas(const Mesh& mesh, const Eigen::Vector3d& direction)
{
    Eigen::VectorXd areas = Eigen::VectorXd::Zero(mesh.vertices.cols());
    for (const Eigen::Vector3i corners : mesh.triangles.colwise()) {
        const Eigen::Vector3d p = mesh.vertices.col(corners[0]);
        const Eigen::Vector3d q = mesh.vertices.col(corners[1]), r = mesh.vertices.col(corners[2]);
        const Eigen::Vector3d twice = (q - p).cross(r - p);
        const double area = (direction.isZero(0) ? twice.norm() : std::abs(twice.dot(direction))) / 2;
        for (const int corner : corners) areas[corner] += area / 3;
    }
    return areas;
}

Eigen::VectorXd vertex_areas(const Mesh& mesh) { return vertex_areas(mesh, Eigen::Vector3d::Zero()); }

Eigen::VectorXd plan_areas(const Eigen::Matrix3Xd& xyz)
{
    Eigen::VectorXd areas = Eigen::VectorXd::Zero(xyz.cols());
    const Eigen::Matrix2Xd plan = finite_plan(xyz);
    if (plan.cols() == 0) return areas;
    const std::optional<double> cell = lattice_cell(plan);
    const Eigen::Vector2d least = plan.rowwise().minCoeff();
    const Eigen::Vector2d extent = plan.rowwise().maxCoeff() - least;
    const double square = kPointsPerSquare * extent.prod() / static_cast<double>(plan.cols());
    if (!cell && !(square > 0)) return areas; // all on one line: no area
    const auto bin = [&](Eigen::Index i) {
        const Eigen::Vector2d place = (xyz.col(i).head<2>() - least) / std::sqrt(square);
        return std::pair(static_cast<long>(place.x()), static_cast<long>(place.y()));
    };
    std::map<std::pair<long, long>, double> points_in;
    for (Eigen::Index i = 0; i < xyz.cols() && !cell; ++i)
        if (xyz.col(i).allFinite()) ++points_in[bin(i)];
    for (Eigen::Index i = 0; i < xyz.cols(); ++i)
        if (xyz.col(i).allFinite()) areas[i] = cell ? *cell : square / points_in.at(bin(i));
    return areas;
}

Eigen::VectorXd volume_areas(const Eigen::Matrix3Xd& xyz, const ErrorMap& map, const DistanceOptions& options)
{
    Eigen::VectorXd areas = plan_areas(xyz);
    for (Eigen::Index i = 0; i < areas.size(); ++i) {
        const double steepness = std::abs(map.normal(2, i));
        const double seen =
            options.mode == DistanceMode::direction ? std::abs(map.normal.col(i).dot(options.direction)) : 1;
        areas[i] *= steepness >= kSteepest ? seen / steepness : 0;
    }
    return areas;
}

Eigen::VectorXd volume_areas(const Mesh& mesh, const DistanceOptions& options)
{
    return options.mode == DistanceMode::direction ? vertex_areas(mesh, options.direction) : vertex_areas(mesh);
}

} // namespace fettle
