#include "robot/heterogeneous.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

namespace fettle {

namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

// A grid serves tools that lean no farther from its direction: cuboids are too near by the slope over a cell, and at 30
// degrees a footprint is half a tool's length.
constexpr double kMostLean = std::numbers::pi / 6;

Mesh some_of(const Mesh& mesh, const std::vector<Eigen::Index>& triangles)
{
    return {mesh.vertices, mesh.triangles(Eigen::all, triangles)};
}

} // namespace

std::vector<Vector3d> tool_directions(const PosePath& poses)
{
    std::vector<Vector3d> ups;
    for (const Isometry3d& T : poses)
        if (!T.translation().hasNaN()) ups.push_back(T.linear().col(2));
    return ups;
}

Heterogeneous::Heterogeneous(const Workpiece& workpiece, std::span<const Vector3d> ups,
                             const HeterogeneousOptions& options)
    : workpiece_(workpiece), options_(options)
{
    if (ups.empty()) throw InputError("the path has no pose that a grid could stand across");
    if (options.formulas == Formulas::published && !(options.tolerance > 0))
        throw InputError("--tolerance: 0 would take endless rows of spheres");
    for (const Vector3d& up : ups) {
        const bool served = std::any_of(grids_.begin(), grids_.end(),
                                        [&](const Grid& g) { return g.up.dot(up) >= std::cos(kMostLean); });
        if (served) continue;
        Grid grid{HeightGrid(workpiece.mesh(), up, options.cell, options.formulas), {}, {}, {}, up};
        grid.occupied = grid.heights.occupied();
        grid.cuboids = std::make_unique<Mesh>(grid.heights.cuboids());
        grid.workpiece = std::make_unique<Workpiece>(*grid.cuboids);
        grids_.push_back(std::move(grid));
    }
}

double Heterogeneous::accuracy() const
{
    double most = 0;
    for (const Grid& grid : grids_) most = std::max(most, grid.heights.accuracy);
    return most;
}

ToolZone Heterogeneous::zone(const Robot& robot, const Isometry3d& T_part_tool) const
{
    const Vector3d up = T_part_tool.linear().col(2);
    const auto nearest = std::max_element(grids_.begin(), grids_.end(),
                                          [&](const Grid& a, const Grid& b) { return a.up.dot(up) < b.up.dot(up); });
    ToolZone zone{static_cast<std::size_t>(nearest - grids_.begin()),
                  std::vector<char>(nearest->heights.heights.size())};
    for (const Body& body : robot.bodies)
        if (body.link == link::kTool)
            nearest->heights.mark(nearest->heights.footprint(body.solid, T_part_tool, options_.formulas), zone.cells);
    return zone;
}

Workpiece::Nearest Heterogeneous::to_triangles(const Solid& solid, const Isometry3d& T_part_body, const ToolZone& zone,
                                               double beyond) const
{
    const HeightGrid& heights = grids_[zone.grid].heights;
    const auto in_zone = [&](Eigen::Index triangle) {
        const auto& cells = heights.cells_of[static_cast<std::size_t>(triangle)];
        return std::any_of(cells.begin(), cells.end(), [&](std::uint32_t c) { return zone.cells[c] != 0; });
    };
    const auto* cylinder = std::get_if<solid::Cylinder>(&solid);
    if (options_.formulas == Formulas::right || cylinder == nullptr)
        return workpiece_.nearest_of(PlacedSolid(solid, T_part_body), beyond, in_zone);
    Workpiece::Nearest best;
    best.clearance.distance = beyond;
    for (const solid::Sphere& sphere : sphere_row(*cylinder, options_.tolerance, options_.formulas)) {
        const Workpiece::Nearest found =
            workpiece_.nearest_of(PlacedSolid(sphere, T_part_body), best.clearance.distance, in_zone);
        if (found.triangle >= 0) best = found;
    }
    return best;
}

Workpiece::Nearest Heterogeneous::nearest(const Solid& solid, const Isometry3d& T_part_body, const ToolZone& zone,
                                          double beyond) const
{
    const PlacedSolid body(solid, T_part_body);
    if (options_.formulas == Formulas::right && workpiece_.holds(body.farthest(Vector3d::UnitZ())))
        return workpiece_.nearest(body, beyond);
    Workpiece::Nearest best = to_triangles(solid, T_part_body, zone, beyond);
    const Grid& grid = grids_[zone.grid];
    const auto outside = [&](Eigen::Index triangle) {
        return zone.cells[grid.occupied[static_cast<std::size_t>(triangle / 12)]] == 0;
    };
    Workpiece::Nearest other = grid.workpiece->nearest_of(body, best.clearance.distance, outside);
    if (other.triangle < 0) return best;
    other.triangle = -1; // it is none of the mesh's
    return other;
}

Heterogeneous::Parts Heterogeneous::parts(const ToolZone& zone) const
{
    const Grid& grid = grids_[zone.grid];
    std::vector<Eigen::Index> triangles, sides;
    for (std::size_t t = 0; t < grid.heights.cells_of.size(); ++t) {
        const auto& cells = grid.heights.cells_of[t];
        if (std::any_of(cells.begin(), cells.end(), [&](std::uint32_t c) { return zone.cells[c] != 0; }))
            triangles.push_back(static_cast<Eigen::Index>(t));
    }
    for (Eigen::Index side = 0; side < grid.cuboids->triangles.cols(); ++side)
        if (zone.cells[grid.occupied[static_cast<std::size_t>(side / 12)]] == 0) sides.push_back(side);
    return {some_of(workpiece_.mesh(), triangles), some_of(*grid.cuboids, sides)};
}

} // namespace fettle
