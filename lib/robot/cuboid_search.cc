#include "robot/cuboid_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::robot {

namespace {

using Eigen::Vector2d, Eigen::Vector3d;

// Lower bound of the signed distance of a box, from the tangent plane of the body's convex distance at its centre.
double distance_bound(const PlacedSolid& body, const Eigen::AlignedBox3d& box)
{
    const PointDistance at = body.signed_distance(box.center());
    return at.value - at.gradient.cwiseAbs().dot(box.sizes()) / 2;
}

bool is_inside(const Eigen::AlignedBox3d& box, const Footprint& area)
{
    const Vector2d across(-area.along.y(), area.along.x()), half = box.sizes().head<2>() / 2,
                                                            off = box.center().head<2>() - area.centre;
    return std::abs(off.dot(area.along)) + area.along.cwiseAbs().dot(half) <= area.half_along &&
           std::abs(off.dot(across)) + across.cwiseAbs().dot(half) <= area.half_across;
}

} // namespace

CuboidSearch::CuboidSearch(const HeightGrid& grid) : grid_(grid)
{
    Eigen::Index columns = grid.columns, rows = grid.rows;
    const std::vector<double>* below = &grid.heights;
    while (columns > 1 || rows > 1) {
        Level level{(columns + 1) / 2, (rows + 1) / 2, {}};
        level.heights.assign(level.columns * level.rows, -1);
        for (Eigen::Index row = 0; row < rows; ++row)
            for (Eigen::Index column = 0; column < columns; ++column) {
                double& highest = level.heights[column / 2 + level.columns * (row / 2)];
                highest = std::max(highest, (*below)[column + columns * row]);
            }
        columns = level.columns;
        rows = level.rows;
        levels_.push_back(std::move(level));
        below = &levels_.back().heights;
    }
}

double CuboidSearch::height_of(const Block& block) const
{
    if (block.level == 0) return grid_.heights[grid_.index(block.column, block.row)];
    const Level& level = levels_[block.level - 1];
    return level.heights[block.column + level.columns * block.row];
}

Eigen::AlignedBox3d CuboidSearch::box_of(const Block& block) const
{
    const double side = std::ldexp(grid_.cell_size, block.level);
    const Vector3d min(side * block.column, side * block.row, 0);
    return {min, min + Vector3d(side, side, height_of(block))};
}

// Depth first, the nearest of four blocks first.
std::optional<Clearance> CuboidSearch::nearest(const PlacedSolid& body, double max_distance,
                                               std::span<const char> left_out, std::span<const Footprint> areas) const
{
    struct Entry {
        double bound;
        Block block;
    };
    std::optional<Clearance> best;
    double min_distance = max_distance;
    std::vector<Entry> stack = {{-std::numeric_limits<double>::infinity(), {std::int32_t(levels_.size()), 0, 0}}};
    while (!stack.empty()) {
        const auto [bound, block] = stack.back();
        stack.pop_back();
        if (bound >= min_distance || height_of(block) < 0) continue;
        const Eigen::AlignedBox3d box = box_of(block);
        if (block.level == 0) {
            if (left_out[grid_.index(block.column, block.row)] != 0) continue;
            const Solid cuboid = solid::Box{Eigen::Isometry3d(Eigen::Translation3d(box.center())), box.sizes() / 2};
            const Clearance c = clearance(body, PlacedSolid(cuboid, Eigen::Isometry3d::Identity()), min_distance);
            if (!(c.distance < min_distance)) continue;
            best = c;
            min_distance = c.distance;
            continue;
        }
        if (std::ranges::any_of(areas, [&](const Footprint& area) { return is_inside(box, area); })) continue;
        const Eigen::Index columns = block.level == 1 ? grid_.columns : levels_[block.level - 2].columns,
                           rows = block.level == 1 ? grid_.rows : levels_[block.level - 2].rows;
        const std::size_t first = stack.size();
        for (std::int32_t k = 0; k < 4; ++k) {
            const Block child = {block.level - 1, 2 * block.column + k % 2, 2 * block.row + k / 2};
            if (child.column >= columns || child.row >= rows || height_of(child) < 0) continue;
            const double child_bound = distance_bound(body, box_of(child));
            if (child_bound < min_distance) stack.push_back({child_bound, child});
        }
        std::sort(stack.begin() + first, stack.end(), [](const Entry& a, const Entry& b) { return a.bound > b.bound; });
    }
    return best;
}

} // namespace fettle::robot
