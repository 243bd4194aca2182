#include "part/part.h"

#include "core/error.h"
#include "core/text.h"
#include "part/refine.h"

#include <cmath>
#include <random>

namespace fettle {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

// Relative to the step: halving further would make triangles too small for any wheel or probe to tell.
constexpr double kLeastEdge = 1.0 / 16;
// An anomaly is ground away: its own shape need not be finer than this, mm.
constexpr double kAnomalyChord = 0.02;
// 99 % of a normal distribution lie within this many standard deviations.
constexpr double kSigmasOf99Percent = 2.5758293035489004;

/// Squares of at most `step`, each cut in two; the diagonals alternate, so that no direction is preferred. z = 0.
Mesh grid(const Eigen::AlignedBox2d& region, double step)
{
    const Vector2d sides = region.sizes();
    // Relative rounding of a side that is a whole number of steps in other units.
    constexpr double kWhole = 1e-9;
    const Index nx = std::max<Index>(1, static_cast<Index>(std::ceil(sides.x() / step - kWhole)));
    const Index ny = std::max<Index>(1, static_cast<Index>(std::ceil(sides.y() / step - kWhole)));
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

Mesh lay(Mesh mesh, const std::vector<Anomaly>& anomalies, double step)
{
    for (std::size_t i = 0; i < anomalies.size(); ++i) {
        bool touched = false;
        for (Index v = 0; v < mesh.vertices.cols() && !touched; ++v)
            touched = anomalies[i].footprint.contains(Vector2d(mesh.vertices.col(v).head<2>()));
        if (!touched) throw InputError("anomalies[" + std::to_string(i) + "]", "lies beside the part");
    }
    return anomalies.empty()
               ? mesh
               : refine(mesh, anomalies, {.step = step, .chord = kAnomalyChord, .least = kLeastEdge * step});
}

Mesh make(const MadeSurface& made, const PartSpec& spec)
{
    Mesh mesh = lay(grid(made.region, spec.step), spec.anomalies, spec.step);
    for (Index v = 0; v < mesh.vertices.cols(); ++v) {
        const Vector2d xy = mesh.vertices.col(v).head<2>();
        const double z = made.z(xy);
        if (!std::isfinite(z))
            throw InputError("surface", "is not defined over (" + to_text(xy.x()) + ", " + to_text(xy.y()) + ") mm");
        mesh.vertices(2, v) = z + height(spec.anomalies, xy);
    }
    return mesh;
}

Mesh make(const ScannedSurface&, const PartSpec&) { throw InputError("scan", "is not supported yet"); }

void add_noise(Mesh& mesh, const ScanNoise& noise, std::uint64_t seed)
{
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0, noise.size / kSigmasOf99Percent);
    std::uniform_real_distribution<double> uniform(-noise.size, noise.size);
    for (double& z : mesh.vertices.row(2))
        z += noise.kind == ScanNoise::Kind::normal ? normal(random) : uniform(random);
}

} // namespace

Mesh make_part(const PartSpec& spec, std::uint64_t seed)
{
    Mesh mesh = std::visit([&](const auto& surface) { return make(surface, spec); }, spec.surface);
    if (spec.noise.size > 0) add_noise(mesh, spec.noise, seed);
    return mesh;
}

} // namespace fettle
