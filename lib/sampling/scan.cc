#include "sampling/scan.h"

#include "core/error.h"
#include "core/file.h"
#include "geometry/bounding_box.h"
#include "job/frame.h"
#include "job/plausible.h"
#include "mesh/shape_file.h"
#include "sampling/point_surface.h"
#include "sampling/triangle_grid.h"

#include <mutex>
#include <optional>

namespace fettle::sampling {

/// Either points or a mesh.
struct Scan::State {
    State(mesh::Mesh triangles, const mesh::MeshRepair& done)
        : bounds(geometry::finite_bounding_box(triangles.vertices)), mesh(std::move(triangles)), repair(done)
    {
    }
    explicit State(const cloud::Cloud& cloud)
        : bounds(geometry::finite_bounding_box(cloud.xyz)), points(std::in_place, cloud.xyz)
    {
    }

    const TriangleGrid& grid() const
    {
        std::call_once(grid_once, [this] { lazy_grid.emplace(mesh); });
        return *lazy_grid;
    }

    Eigen::AlignedBox3d bounds;
    std::optional<PointSurface> points;
    mesh::Mesh mesh;
    mesh::MeshRepair repair;
    // Created at the first touch: grinding uses the triangles only.
    mutable std::once_flag grid_once;
    mutable std::optional<TriangleGrid> lazy_grid;
};

Scan::Scan(mesh::Mesh mesh, const mesh::MeshRepair& repair) : state_(std::make_unique<State>(std::move(mesh), repair))
{
}
Scan::Scan(cloud::Cloud cloud) : state_(std::make_unique<State>(cloud)) {}
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

const mesh::Mesh* Scan::mesh() const { return state_->points ? nullptr : &state_->mesh; }

const mesh::MeshRepair& Scan::repair() const { return state_->repair; }

Eigen::AlignedBox3d Scan::bounds() const { return state_->bounds; }

Scan read_scan(const std::string& path, const job::Job& job, std::optional<units::Units::Length> stated)
{
    mesh::ShapeFile file = mesh::parse_shape(core::read_file(path), core::display_name(path),
                                             units::Units{stated.value_or(job.units.length), job.units.force});
    job::move_to_job_frame(file.shape, job);
    if (mesh::Mesh* mesh = std::get_if<mesh::Mesh>(&file.shape)) return Scan(std::move(*mesh), file.repair);
    if (!geometry::finite_bounding_box(mesh::coordinates_of(file.shape)).min().allFinite())
        throw core::InputError(core::display_name(path), "no points");
    return Scan(std::get<cloud::Cloud>(std::move(file.shape)));
}

std::vector<std::string> scan_warnings(const Scan& scan, const job::Job& job, const std::string& name)
{
    std::vector<std::string> warnings;
    for (const std::string& warning : {job::part_box_warning(scan.bounds(), job), mesh::repair_warning(scan.repair())})
        if (!warning.empty()) warnings.push_back(name + ": " + warning);
    return warnings;
}

} // namespace fettle::sampling
