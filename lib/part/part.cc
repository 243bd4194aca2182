#include "part/part.h"

#include "core/error.h"
#include "core/file.h"
#include "job/boundary.h"
#include "part/refine.h"
#include "sampling/scan.h"

#include <cmath>

namespace fettle {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

// Relative to the step: halving further would make triangles too small for any wheel or probe to tell.
constexpr double kLeastEdge = 1.0 / 16;
// An anomaly is ground away: its own shape need not be finer than this, mm.
constexpr double kAnomalyChord = 0.02;

/// Squares of at most `step`, each cut in two; the diagonals alternate, so that no direction is preferred. z = 0.
/// @throws InputError as check_size()
Mesh grid(const Eigen::AlignedBox2d& region, double step)
{
    // Relative rounding of a side that is a whole number of steps in other units.
    constexpr double kWhole = 1e-9;
    const Eigen::Array2d squares = (region.sizes().array() / step - kWhole).ceil().max(1);
    check_size(2 * squares.prod());
    const auto nx = static_cast<Index>(squares.x()), ny = static_cast<Index>(squares.y());
    Mesh mesh;
    mesh.vertices.setZero(3, (nx + 1) * (ny + 1));
    mesh.triangles.resize(3, 2 * nx * ny);
    const Eigen::ArrayXd x = Eigen::ArrayXd::LinSpaced(nx + 1, region.min().x(), region.max().x());
    const Eigen::ArrayXd y = Eigen::ArrayXd::LinSpaced(ny + 1, region.min().y(), region.max().y());
    for (Index j = 0; j <= ny; ++j)
        for (Index i = 0; i <= nx; ++i) mesh.vertices.col(j * (nx + 1) + i) << x[i], y[j], 0;
    for (Index j = 0, t = 0; j < ny; ++j)
        for (Index i = 0; i < nx; ++i) {
            const int a = static_cast<int>(j * (nx + 1) + i), b = a + 1, d = a + static_cast<int>(nx) + 1, c = d + 1;
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

/// Work that fails if the step is too fine for it.
template <typename Work>
Mesh by_step(const PartSpec& spec, const Work& work)
try {
    return work(spec.step);
} catch (const InputError& error) {
    throw InputError(spec.source, std::string("step: ") + error.what());
}

Mesh grid(const Eigen::AlignedBox2d& region, const PartSpec& spec)
{
    return by_step(spec, [&](double step) { return grid(region, step); });
}

InputError beside(const PartSpec& spec, std::size_t anomaly)
{
    return InputError(spec.source, "anomalies[" + std::to_string(anomaly) + "]: lies beside the part");
}

/// The mesh with the triangles that the anomalies need; not lifted yet.
Mesh lay(const Mesh& mesh, const PartSpec& spec)
{
    if (spec.anomalies.empty()) return mesh;
    Mesh refined = by_step(spec, [&](double step) {
        return refine(mesh, spec.anomalies, {.step = step, .chord = kAnomalyChord, .least = kLeastEdge * step});
    });
    for (std::size_t i = 0; i < spec.anomalies.size(); ++i) {
        bool touched = false;
        for (Index v = 0; v < refined.vertices.cols() && !touched; ++v)
            touched = spec.anomalies[i].height(refined.vertices.col(v).head<2>()) > 0;
        if (!touched) throw beside(spec, i);
    }
    return refined;
}

Mesh make(const MadeSurface& made, const PartSpec& spec)
{
    Mesh mesh = lay(grid(made.region, spec), spec);
    for (Index v = 0; v < mesh.vertices.cols(); ++v) {
        const Vector2d xy = mesh.vertices.col(v).head<2>();
        const double z = made.z(xy);
        if (!std::isfinite(z)) throw InputError(spec.source, "surface: is not defined over " + place(xy, spec.units));
        mesh.vertices(2, v) = z + height(spec.anomalies, xy);
    }
    return mesh;
}

/// The triangles whose corners all lie in the region.
Mesh crop(const Mesh& mesh, const Eigen::AlignedBox2d& region)
{
    std::vector<int> kept(static_cast<std::size_t>(mesh.vertices.cols()), -1);
    std::vector<Eigen::Vector3i> triangles;
    std::vector<Eigen::Vector3d> vertices;
    const auto inside = [&](int v) { return region.contains(Vector2d(mesh.vertices.col(v).head<2>())); };
    for (Eigen::Vector3i corners : mesh.triangles.colwise()) {
        if (!inside(corners[0]) || !inside(corners[1]) || !inside(corners[2])) continue;
        for (int& v : corners) {
            int& index = kept[static_cast<std::size_t>(v)];
            if (index < 0) {
                index = static_cast<int>(vertices.size());
                vertices.emplace_back(mesh.vertices.col(v));
            }
            v = index;
        }
        triangles.push_back(corners);
    }
    Mesh result;
    result.vertices.resize(3, static_cast<Index>(vertices.size()));
    for (Index v = 0; v < result.vertices.cols(); ++v) result.vertices.col(v) = vertices[static_cast<std::size_t>(v)];
    result.triangles.resize(3, static_cast<Index>(triangles.size()));
    for (Index t = 0; t < result.triangles.cols(); ++t)
        result.triangles.col(t) = triangles[static_cast<std::size_t>(t)];
    return result;
}

Mesh lay_on(Mesh mesh, const PartSpec& spec)
{
    if (spec.anomalies.empty()) return mesh;
    const Scan bare(mesh);
    mesh = lay(mesh, spec);
    // A vertex on the upper side meets the highest surface over it, but for the rounding of its coordinates.
    const double rounding = 1e-9 * mesh.vertices.cwiseAbs().maxCoeff();
    for (Index v = 0; v < mesh.vertices.cols(); ++v) {
        const Vector2d xy = mesh.vertices.col(v).head<2>();
        const double h = height(spec.anomalies, xy);
        if (h > 0 && mesh.vertices(2, v) >= bare.height(xy).value_or(mesh.vertices(2, v)) - rounding)
            mesh.vertices(2, v) += h;
    }
    return mesh;
}

/// Points `step` apart under the anomaly, on the surface that touches of the cloud would find, and lifted.
Eigen::Matrix3Xd points_of(const Anomaly& anomaly, const PartSpec& spec, const Scan& bare)
{
    std::vector<Eigen::Vector3d> points;
    const Mesh lattice = grid(anomaly.footprint, spec);
    for (const Eigen::Vector3d& node : lattice.vertices.colwise()) {
        const Vector2d xy = node.head<2>();
        const std::optional<double> z = anomaly.height(xy) > 0 ? bare.height(xy) : std::nullopt;
        if (z) points.emplace_back(xy.x(), xy.y(), *z + height(spec.anomalies, xy));
    }
    if (points.empty()) return {};
    return Eigen::Map<Eigen::Matrix3Xd>(points[0].data(), 3, static_cast<Index>(points.size()));
}

Cloud lay_on(const Cloud& scan, const PartSpec& spec)
{
    Cloud part; // its fields say nothing about the points that are added, so they go
    part.xyz = scan.xyz;
    if (spec.anomalies.empty()) return part;
    const Scan bare(scan);
    for (auto point : part.xyz.colwise()) point.z() += height(spec.anomalies, point.head<2>());
    for (std::size_t i = 0; i < spec.anomalies.size(); ++i) {
        const Eigen::Matrix3Xd points = points_of(spec.anomalies[i], spec, bare);
        if (points.cols() == 0) throw beside(spec, i);
        const Index before = part.xyz.cols();
        part.xyz.conservativeResize(3, before + points.cols());
        part.xyz.rightCols(points.cols()) = points;
    }
    return part;
}

MeshOrCloud make(const ScannedSurface& scanned, const PartSpec& spec)
{
    const ShapeFile file = parse_shape(read_whole(scanned.file), scanned.file, Units{scanned.unit, Units::Force::N});
    if (const Mesh* whole = std::get_if<Mesh>(&file.shape))
        return lay_on(scanned.region ? crop(*whole, *scanned.region) : *whole, spec);
    const Cloud& whole = std::get<Cloud>(file.shape);
    std::vector<Index> kept;
    for (Index i = 0; i < whole.size(); ++i) {
        const bool inside = !scanned.region || scanned.region->contains(Vector2d(whole.xyz.col(i).head<2>()));
        if (whole.xyz.col(i).allFinite() && inside) kept.push_back(i);
    }
    return lay_on(select(whole, kept), spec);
}

void add_noise(Eigen::Matrix3Xd& points, const TouchNoise& noise, std::uint64_t seed)
{
    points.row(2) += draw_noise(noise, points.cols(), seed).transpose();
}

} // namespace

MeshOrCloud make_part(const PartSpec& spec, std::uint64_t seed)
{
    MeshOrCloud part =
        std::visit([&](const auto& surface) -> MeshOrCloud { return make(surface, spec); }, spec.surface);
    if (Mesh* mesh = std::get_if<Mesh>(&part))
        add_noise(mesh->vertices, spec.noise, seed);
    else
        add_noise(std::get<Cloud>(part).xyz, spec.noise, seed);
    return part;
}

} // namespace fettle
