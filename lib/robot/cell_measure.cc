#include "robot/cell.h"
#include "robot/mesh_body.h"

#include <algorithm>
#include <variant>

namespace fettle::robot {

namespace {

using Eigen::Isometry3d;

// A clearance from the frame of its measurement to the cell's.
Clearance moved(const Isometry3d& T, const Clearance& c)
{
    return {c.distance, T.linear() * c.normal, T * c.on_a, T * c.on_b};
}

// The same, seen from the other body.
Clearance reversed(const Clearance& c) { return {c.distance, -c.normal, c.on_b, c.on_a}; }

} // namespace

// The triangles of a body; nullptr: it is convex.
const Workpiece* Cell::surface_of(std::size_t body) const
{
    if (body == robot_.bodies.size()) return workpiece_;
    const auto* triangles = std::get_if<solid::Triangles>(&robot_.bodies[body].solid);
    return triangles != nullptr ? &triangles->body->surface : nullptr;
}

// Without the pair's margin, cell frame.
Clearance Cell::measure_in_cell(CellState& state, std::size_t index, double max_clearance) const
{
    const CellPair& pair = pairs_[index];
    const Isometry3d &T_a = state.T_cell_body[pair.a], &T_b = state.T_cell_body[pair.b];
    LeafPair& start = state.start_leaves[index];
    const auto to_surface = [&](const Workpiece& surface, const Isometry3d& T_surface, std::size_t body,
                                const Isometry3d& T_body, std::uint32_t& leaf) {
        const PlacedSolid placed(robot_.bodies[body].solid, T_surface.inverse() * T_body);
        const Workpiece::Nearest found = surface.nearest(placed, max_clearance, leaf);
        leaf = found.leaf;
        return moved(T_surface, found.clearance);
    };
    if (is_of_workpiece(index) && options_.model != nullptr) {
        const auto found =
            options_.model->nearest(robot_.bodies[pair.a].solid, T_b.inverse() * T_a, state.tool_zone, max_clearance);
        return moved(T_b, found.clearance);
    }
    const Workpiece *surface_a = surface_of(pair.a), *surface_b = surface_of(pair.b);
    if (surface_a != nullptr && surface_b != nullptr) {
        const NearestTriangles found =
            nearest_triangles(*surface_a, *surface_b, T_b.inverse() * T_a, max_clearance, start);
        start = found.leaves;
        return moved(T_b, found.clearance);
    }
    if (surface_b != nullptr) return to_surface(*surface_b, T_b, pair.a, T_a, start.b);
    if (surface_a != nullptr) return reversed(to_surface(*surface_a, T_a, pair.b, T_b, start.a));
    return clearance(PlacedSolid(robot_.bodies[pair.a].solid, T_a), PlacedSolid(robot_.bodies[pair.b].solid, T_b),
                     max_clearance);
}

double Cell::measure_clearance(CellState& state, std::size_t index, double max_clearance) const
{
    const double margin = pairs_[index].margin;
    const Clearance found = measure_in_cell(state, index, max_clearance + margin);
    state.clearances[index] = {std::min(found.distance - margin, max_clearance), index, found.on_a};
    return found.distance - margin;
}

bool Cell::has_mesh(std::size_t index) const
{
    return surface_of(pairs_[index].a) != nullptr || surface_of(pairs_[index].b) != nullptr;
}

// The clearance of the convex hulls of two bodies is a lower bound of theirs.
double Cell::hull_clearance(const CellState& state, std::size_t index, double max_clearance) const
{
    const CellPair& pair = pairs_[index];
    const PlacedSolid a(robot_.bodies[pair.a].solid, state.T_cell_body[pair.a]),
        b(robot_.bodies[pair.b].solid, state.T_cell_body[pair.b]);
    return clearance(a, b, max_clearance + pair.margin).distance - pair.margin;
}

double Cell::bound_clearance(CellState& state, std::size_t index, double max_clearance) const
{
    const CellPair& pair = pairs_[index];
    if (!is_of_workpiece(index) && has_mesh(index)) return hull_clearance(state, index, max_clearance);
    if (!is_of_workpiece(index) || options_.model != nullptr) return measure_clearance(state, index, max_clearance);
    const Isometry3d T_part_a = state.T_cell_body.back().inverse() * state.T_cell_body[pair.a];
    std::uint32_t& leaf = state.start_leaves[index].b;
    const Workpiece::LowerBound found =
        workpiece_->lower_bound(PlacedSolid(robot_.bodies[pair.a].solid, T_part_a), max_clearance + pair.margin, leaf);
    leaf = found.leaf;
    return found.distance - pair.margin;
}

} // namespace fettle::robot
