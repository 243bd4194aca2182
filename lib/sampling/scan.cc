#include "sampling/scan.h"

#include "cloud/pcd.h"
#include "core/error.h"
#include "core/file.h"
#include "mesh/mesh_file.h"
#include "sampling/point_surface.h"
#include "sampling/triangle_grid.h"

#include <variant>

namespace fettle {

struct Scan::State {
    std::variant<TriangleGrid, PointSurface> surface;
    Eigen::Matrix<double, 3, 2> bounds;
};

namespace {

Eigen::Matrix<double, 3, 2> finite_bounds(const Eigen::Matrix3Xd& points)
{
    Eigen::Matrix<double, 3, 2> box;
    box.col(0).setConstant(std::numeric_limits<double>::infinity());
    box.col(1) = -box.col(0);
    for (Eigen::Index i = 0; i < points.cols(); ++i)
        if (points.col(i).allFinite()) {
            box.col(0) = box.col(0).cwiseMin(points.col(i));
            box.col(1) = box.col(1).cwiseMax(points.col(i));
        }
    return box;
}

} // namespace

Scan::Scan(Mesh mesh)
{
    const Eigen::Matrix<double, 3, 2> bounds = bounding_box(mesh);
    state_ = std::make_unique<State>(State{TriangleGrid(std::move(mesh)), bounds});
}

Scan::Scan(Cloud cloud) : state_(std::make_unique<State>(State{PointSurface(cloud.xyz), finite_bounds(cloud.xyz)})) {}

Scan::Scan(Scan&&) noexcept = default;
Scan::~Scan() = default;

std::optional<double> Scan::height(const Eigen::Vector2d& xy) const
{
    if (const auto* mesh = std::get_if<TriangleGrid>(&state_->surface)) return mesh->highest(xy);
    return std::get<PointSurface>(state_->surface).height(xy);
}

std::optional<double> Scan::drop_ball(const Eigen::Vector2d& xy, double radius) const
{
    if (const auto* mesh = std::get_if<TriangleGrid>(&state_->surface)) {
        const std::optional<double> centre = mesh->ball_centre(xy, radius);
        if (!centre) return std::nullopt;
        return *centre - radius;
    }
    return std::get<PointSurface>(state_->surface).drop_ball(xy, radius);
}

Eigen::Matrix<double, 3, 2> Scan::bounds() const { return state_->bounds; }

Scan read_scan(const std::string& path, const Units& units, std::optional<Units::Length> stated)
{
    const std::string bytes = read_whole(path);
    const std::string source = display_name(path);
    const Units::Length unit = stated.value_or(units.length);
    if (!looks_like_cloud(bytes)) return Scan(parse_mesh(bytes, source, unit));
    Cloud cloud = parse_cloud(bytes, source, Units{unit, units.force}).cloud;
    if (!finite_bounds(cloud.xyz).allFinite()) throw InputError(source, "no points");
    return Scan(std::move(cloud));
}

} // namespace fettle
