#include "part/part.h"

#include "core/error.h"
#include "core/file.h"
#include "job/boundary.h"
#include "job/shape_warnings.h"
#include "part/refine.h"
#include "sampling/scan.h"

#include <algorithm>
#include <cmath>

namespace fettle::part {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

// Shortest edge as a fraction of the step: smaller triangles make no difference to any wheel or probe.
constexpr double kMinEdgePerStep = 1.0 / 16;
// Chord error of an anomaly, mm; it need not be finer, because the anomaly is ground off.
constexpr double kAnomalyChordError = 0.02;

/// A grid of squares with sides of at most `step`, each split in two; the diagonals alternate, so that no direction is
/// preferred. z = 0. @throws InputError as check_triangle_count()
mesh::Mesh grid(const Eigen::AlignedBox2d& region, double step)
{
    constexpr double kStepRounding = 1e-9; // of a side that is a whole number of steps in other units
    const Eigen::Array2d squares = (region.sizes().array() / step - kStepRounding).ceil().max(1);
    check_triangle_count(2 * squares.prod());
    const auto nx = static_cast<Index>(squares.x()), ny = static_cast<Index>(squares.y());
    mesh::Mesh mesh;
    mesh.vertices.setZero(3, (nx + 1) * (ny + 1));
    mesh.triangles.resize(3, 2 * nx * ny);
    const Eigen::ArrayXd x = Eigen::ArrayXd::LinSpaced(nx + 1, region.min().x(), region.max().x());
    const Eigen::ArrayXd y = Eigen::ArrayXd::LinSpaced(ny + 1, region.min().y(), region.max().y());
    for (Index j = 0; j <= ny; ++j)
        for (Index i = 0; i <= nx; ++i) mesh.vertices.col(j * (nx + 1) + i) << x[i], y[j], 0;
    for (Index j = 0, t = 0; j < ny; ++j)
        for (Index i = 0; i < nx; ++i) {
            const int a = j * (nx + 1) + i, b = a + 1, d = a + nx + 1, c = d + 1;
            if ((i + j) % 2 == 0) {
                mesh.triangles.col(t++) << a, b, c;
                mesh.triangles.col(t++) << a, c, d;
            } else {
                mesh.triangles.col(t++) << a, b, d;
                mesh.triangles.col(t++) << b, c, d;
            }
        }
    return mesh;
}

/// Calls work(step); its errors are about the key "step".
template <typename Work>
mesh::Mesh with_step(const PartSpec& spec, const Work& work)
try {
    return work(spec.step);
} catch (const core::InputError& error) {
    throw core::InputError(spec.source, std::string("step: ") + error.what());
}

mesh::Mesh grid(const Eigen::AlignedBox2d& region, const PartSpec& spec)
{
    return with_step(spec, [&](double step) { return grid(region, step); });
}

core::InputError outside_error(const PartSpec& spec, std::size_t anomaly)
{
    return core::InputError(spec.source, "anomalies[" + std::to_string(anomaly) + "]: is outside the part");
}

/// Refines the mesh under the anomalies, without lifting it.
mesh::Mesh refine_under_anomalies(const mesh::Mesh& mesh, const PartSpec& spec)
{
    if (spec.anomalies.empty()) return mesh;
    const mesh::Mesh refined = with_step(spec, [&](double step) {
        return refine(mesh, spec.anomalies,
                      {.step = step, .chord_error = kAnomalyChordError, .min_edge = kMinEdgePerStep * step});
    });
    for (std::size_t i = 0; i < spec.anomalies.size(); ++i) {
        const auto& height = spec.anomalies[i].height;
        const auto lifts = [&](const auto& vertex) { return height(vertex.template head<2>()) > 0; };
        if (std::ranges::none_of(refined.vertices.colwise(), lifts)) throw outside_error(spec, i);
    }
    return refined;
}

mesh::Mesh make_surface(const AnalyticSurface& made, const PartSpec& spec)
{
    mesh::Mesh mesh = refine_under_anomalies(grid(made.region, spec), spec);
    for (Index v = 0; v < mesh.vertices.cols(); ++v) {
        const Vector2d xy = mesh.vertices.col(v).head<2>();
        const double z = made.z(xy);
        if (!std::isfinite(z))
            throw core::InputError(spec.source, "surface: is not defined over " + job::point_text(xy, spec.units));
        mesh.vertices(2, v) = z + height(spec.anomalies, xy);
    }
    return mesh;
}

/// The triangles whose corners all lie in the region.
mesh::Mesh crop(const mesh::Mesh& mesh, const Eigen::AlignedBox2d& region)
{
    std::vector<int> new_index(mesh.vertices.cols(), -1);
    std::vector<Eigen::Vector3i> triangles;
    std::vector<Eigen::Vector3d> vertices;
    const auto inside = [&](int v) { return region.contains(Vector2d(mesh.vertices.col(v).head<2>())); };
    for (Eigen::Vector3i corners : mesh.triangles.colwise()) {
        if (!inside(corners[0]) || !inside(corners[1]) || !inside(corners[2])) continue;
        for (int& v : corners) {
            int& index = new_index[v];
            if (index < 0) {
                index = vertices.size();
                vertices.emplace_back(mesh.vertices.col(v));
            }
            v = index;
        }
        triangles.push_back(corners);
    }
    mesh::Mesh result;
    if (triangles.empty()) return result;
    result.vertices = Eigen::Map<Eigen::Matrix3Xd>(vertices[0].data(), 3, vertices.size());
    result.triangles = Eigen::Map<Eigen::Matrix3Xi>(triangles[0].data(), 3, triangles.size());
    return result;
}

/// The mesh, refined and lifted by the anomalies.
mesh::Mesh add_anomalies(mesh::Mesh mesh, const PartSpec& spec)
{
    if (spec.anomalies.empty()) return mesh;
    const sampling::Scan bare(mesh);
    mesh = refine_under_anomalies(mesh, spec);
    // A vertex is on the upper side if no surface is above it, within the rounding of its coordinates.
    const double rounding = 1e-9 * mesh.vertices.cwiseAbs().maxCoeff();
    for (Index v = 0; v < mesh.vertices.cols(); ++v) {
        const Vector2d xy = mesh.vertices.col(v).head<2>();
        const double h = height(spec.anomalies, xy);
        if (h > 0 && mesh.vertices(2, v) >= bare.height(xy).value_or(mesh.vertices(2, v)) - rounding)
            mesh.vertices(2, v) += h;
    }
    return mesh;
}

/// Points on an anomaly over a cloud, on a grid of spacing `step`: the heights that touches of the cloud would find,
/// lifted by the anomaly.
Eigen::Matrix3Xd anomaly_points(const Anomaly& anomaly, const PartSpec& spec, const sampling::Scan& bare)
{
    std::vector<Eigen::Vector3d> points;
    const mesh::Mesh lattice = grid(anomaly.footprint, spec);
    for (const Eigen::Vector3d& node : lattice.vertices.colwise()) {
        const Vector2d xy = node.head<2>();
        const std::optional<double> z = anomaly.height(xy) > 0 ? bare.height(xy) : std::nullopt;
        if (z) points.emplace_back(xy.x(), xy.y(), *z + height(spec.anomalies, xy));
    }
    if (points.empty()) return {};
    return Eigen::Map<Eigen::Matrix3Xd>(points[0].data(), 3, points.size());
}

/// The cloud, lifted by the anomalies, and additional points on them.
cloud::Cloud add_anomalies(const cloud::Cloud& scan, const PartSpec& spec)
{
    cloud::Cloud part; // without the scan's fields, which the additional points would lack
    part.xyz = scan.xyz;
    if (spec.anomalies.empty()) return part;
    const sampling::Scan bare(scan);
    for (auto point : part.xyz.colwise()) point.z() += height(spec.anomalies, point.head<2>());
    for (std::size_t i = 0; i < spec.anomalies.size(); ++i) {
        const Eigen::Matrix3Xd points = anomaly_points(spec.anomalies[i], spec, bare);
        if (points.cols() == 0) throw outside_error(spec, i);
        const Index before = part.xyz.cols();
        part.xyz.conservativeResize(3, before + points.cols());
        part.xyz.rightCols(points.cols()) = points;
    }
    return part;
}

mesh::MeshOrCloud make_surface(const ScannedSurface& scanned, const PartSpec& spec, std::vector<std::string>* warnings)
{
    const mesh::ShapeFile file = mesh::parse_shape(core::read_file(scanned.file), scanned.file,
                                                   units::Units{scanned.unit, units::Units::Force::N});
    if (warnings != nullptr) *warnings = job::shape_warnings(file, scanned.file, file.units);
    if (const mesh::Mesh* whole = std::get_if<mesh::Mesh>(&file.shape))
        return add_anomalies(scanned.region ? crop(*whole, *scanned.region) : *whole, spec);
    const cloud::Cloud& whole = std::get<cloud::Cloud>(file.shape);
    std::vector<Index> kept;
    for (Index i = 0; i < whole.size(); ++i) {
        const bool inside = !scanned.region || scanned.region->contains(Vector2d(whole.xyz.col(i).head<2>()));
        if (whole.xyz.col(i).allFinite() && inside) kept.push_back(i);
    }
    return add_anomalies(cloud::select_points(whole, kept), spec);
}

} // namespace

mesh::MeshOrCloud make_part(const PartSpec& spec, std::uint64_t seed, std::vector<std::string>* warnings)
{
    const auto* scanned = std::get_if<ScannedSurface>(&spec.surface);
    mesh::MeshOrCloud part = scanned != nullptr ? make_surface(*scanned, spec, warnings)
                                                : make_surface(std::get<AnalyticSurface>(spec.surface), spec);
    mesh::Mesh* const mesh = std::get_if<mesh::Mesh>(&part);
    Eigen::Matrix3Xd& points = mesh ? mesh->vertices : std::get<cloud::Cloud>(part).xyz;
    points.row(2) += sampling::draw_noise(spec.noise, points.cols(), seed).transpose();
    return part;
}

} // namespace fettle::part
