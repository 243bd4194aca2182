#include "robot/heterogeneous.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <variant>

namespace fettle::robot {

namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

// Largest angle between the tool's axis and the normal of the grid, rad: distances from cuboids are too small by the
// slope over a cell, and at 30 degrees a footprint is half a tool's length.
constexpr double kMaxTiltToGrid = std::numbers::pi / 6;

mesh::Mesh submesh(const mesh::Mesh& mesh, const std::vector<Eigen::Index>& triangles)
{
    return {mesh.vertices, mesh.triangles(Eigen::all, triangles)};
}

} // namespace

std::vector<Vector3d> tool_axes(const cloud::PosePath& poses)
{
    std::vector<Vector3d> axes;
    for (const Isometry3d& T : poses)
        if (!T.translation().hasNaN()) axes.push_back(T.linear().col(2));
    return axes;
}

HeterogeneousModel::HeterogeneousModel(const Workpiece& workpiece, std::span<const Vector3d> axes,
                                       const HeterogeneousOptions& options)
    : workpiece_(workpiece), options_(options)
{
    if (axes.empty()) throw core::InputError("the path has no pose to set a grid by");
    if (options.formulas == Formulas::published && !(options.tolerance > 0))
        throw core::InputError("--tolerance: 0 would need infinitely many spheres");
    for (const Vector3d& axis : axes) {
        const auto is_near = [&](const Grid& g) { return g.normal.dot(axis) >= std::cos(kMaxTiltToGrid); };
        if (std::ranges::any_of(grids_, is_near)) continue;
        auto heights = std::make_unique<HeightGrid>(workpiece.mesh(), axis, options.cell_size, options.formulas);
        auto cuboids = std::make_unique<CuboidSearch>(*heights);
        grids_.push_back({std::move(heights), std::move(cuboids), axis});
    }
}

double HeterogeneousModel::accuracy() const
{
    double max = 0;
    for (const Grid& grid : grids_) max = std::max(max, grid.heights->accuracy);
    return max;
}

ToolZone HeterogeneousModel::tool_zone(const Robot& robot, const Isometry3d& T_part_tool) const
{
    const Vector3d axis = T_part_tool.linear().col(2);
    const auto nearest = std::ranges::max_element(grids_, {}, [&](const Grid& g) { return g.normal.dot(axis); });
    ToolZone zone{std::size_t(nearest - grids_.begin()), std::vector<char>(nearest->heights->heights.size())};
    for (const Body& body : robot.bodies)
        if (body.link == link::kTool) {
            zone.footprints.push_back(nearest->heights->footprint(body.solid, T_part_tool, options_.formulas));
            nearest->heights->mark(zone.footprints.back(), zone.cells);
        }
    return zone;
}

bool HeterogeneousModel::touches_zone(const Grid& grid, std::size_t triangle, const ToolZone& zone)
{
    return std::ranges::any_of(grid.heights->triangle_cells[triangle],
                               [&](std::uint32_t c) { return zone.cells[c] != 0; });
}

Workpiece::Nearest HeterogeneousModel::nearest_triangle(const Solid& solid, const Isometry3d& T_part_body,
                                                        const ToolZone& zone, double max_distance) const
{
    const auto in_zone = [&](Eigen::Index triangle) { return touches_zone(grids_[zone.grid], triangle, zone); };
    const auto* cylinder = std::get_if<solid::Cylinder>(&solid);
    if (options_.formulas == Formulas::corrected || cylinder == nullptr)
        return workpiece_.nearest_of(PlacedSolid(solid, T_part_body), max_distance, in_zone);
    Workpiece::Nearest best;
    best.clearance.distance = max_distance;
    for (const solid::Sphere& sphere : sphere_row(*cylinder, options_.tolerance, options_.formulas)) {
        const Workpiece::Nearest found =
            workpiece_.nearest_of(PlacedSolid(sphere, T_part_body), best.clearance.distance, in_zone);
        if (found.triangle >= 0) best = found;
    }
    return best;
}

Workpiece::Nearest HeterogeneousModel::nearest(const Solid& solid, const Isometry3d& T_part_body, const ToolZone& zone,
                                               double max_distance) const
{
    const PlacedSolid body(solid, T_part_body);
    if (options_.formulas == Formulas::corrected && workpiece_.contains(body.support(Vector3d::UnitZ())))
        return workpiece_.nearest(body, max_distance);
    const Workpiece::Nearest to_triangles = nearest_triangle(solid, T_part_body, zone, max_distance);
    const Grid& grid = grids_[zone.grid];
    const Isometry3d& T_grid_part = grid.heights->T_grid_part;
    const std::optional<Clearance> to_cuboids = grid.cuboids->nearest(
        PlacedSolid(solid, T_grid_part * T_part_body), to_triangles.clearance.distance, zone.cells, zone.footprints);
    if (!to_cuboids) return to_triangles;
    const Isometry3d T_part_grid = T_grid_part.inverse();
    Workpiece::Nearest found; // of no triangle
    found.clearance = {to_cuboids->distance, T_part_grid.linear() * to_cuboids->normal, T_part_grid * to_cuboids->on_a,
                       T_part_grid * to_cuboids->on_b};
    return found;
}

HeterogeneousModel::Geometry HeterogeneousModel::geometry(const ToolZone& zone) const
{
    const Grid& grid = grids_[zone.grid];
    std::vector<Eigen::Index> triangles, sides;
    for (std::size_t t = 0; t < grid.heights->triangle_cells.size(); ++t)
        if (touches_zone(grid, t, zone)) triangles.push_back(t);
    const mesh::Mesh cuboids = grid.heights->cuboids();
    const std::vector<std::size_t> occupied = grid.heights->occupied();
    for (Eigen::Index side = 0; side < cuboids.triangles.cols(); ++side)
        if (zone.cells[occupied[side / 12]] == 0) sides.push_back(side);
    return {submesh(workpiece_.mesh(), triangles), submesh(cuboids, sides)};
}

} // namespace fettle::robot
