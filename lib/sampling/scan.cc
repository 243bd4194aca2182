#include "sampling/scan.h"

#include "core/error.h"
#include "core/file.h"
#include "mesh/shape_file.h"
#include "sampling/point_surface.h"
#include "sampling/triangle_grid.h"

#include <mutex>
#include <optional>

namespace fettle {

/// Either of points or of triangles.
struct Scan::State {
    explicit State(Mesh triangles) : bounds(bounding_box(triangles.vertices)), mesh(std::move(triangles)) {}
    explicit State(const Cloud& cloud) : bounds(bounding_box(cloud.xyz)), points(std::in_place, cloud.xyz) {}

    const TriangleGrid& grid() const
    {
        std::call_once(grid_made, [this] { made_grid.emplace(mesh); });
        return *made_grid;
    }

    Eigen::Matrix<double, 3, 2> bounds;
    std::optional<PointSurface> points;
    Mesh mesh;
    // Made when the first touch asks for it: who grinds needs the triangles alone.
    mutable std::once_flag grid_made;
    mutable std::optional<TriangleGrid> made_grid;
};

Scan::Scan(Mesh mesh) : state_(std::make_unique<State>(std::move(mesh))) {}
Scan::Scan(Cloud cloud) : state_(std::make_unique<State>(cloud)) {}
Scan::Scan(Scan&&) noexcept = default;
Scan::~Scan() = default;

std::optional<double> Scan::height(const Eigen::Vector2d& xy) const
{
    return state_->points ? state_->points->height(xy) : state_->grid().highest(xy);
}

std::optional<double> Scan::drop_ball(const Eigen::Vector2d& xy, double radius) const
{
    if (state_->points) return state_->points->drop_ball(xy, radius);
    const std::optional<double> centre = state_->grid().ball_centre(xy, radius);
    if (!centre) return std::nullopt;
    return *centre - radius;
}

std::optional<double> Scan::highest_point(const Eigen::Vector2d& xy, double radius) const
{
    return state_->points ? state_->points->highest(xy, radius) : std::nullopt;
}

const Mesh* Scan::mesh() const { return state_->points ? nullptr : &state_->mesh; }

Eigen::Matrix<double, 3, 2> Scan::bounds() const { return state_->bounds; }

Scan read_scan(const std::string& path, const Units& units, std::optional<Units::Length> stated)
{
    ShapeFile file =
        parse_shape(read_whole(path), display_name(path), Units{stated.value_or(units.length), units.force});
    if (Mesh* mesh = std::get_if<Mesh>(&file.shape)) return Scan(std::move(*mesh));
    if (!bounding_box(places_of(file.shape)).allFinite()) throw InputError(display_name(path), "no points");
    return Scan(std::get<Cloud>(std::move(file.shape)));
}

} // namespace fettle
