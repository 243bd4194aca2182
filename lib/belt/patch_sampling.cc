#include "belt/sampling.h"
#include "geometry/bounding_box.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>

namespace fettle::belt {
namespace {

// Samples per knot span for lengths and curvatures of a patch; a cubic span has at most two inflections.
constexpr int kSamplesPerSpan = 16;
// Segments of a boundary curve that runs from one side of the domain to the other.
constexpr double kSegmentsPerDomain = 256;
// Distance below which two boundaries coincide, relative to the spacing: surfels cannot resolve it.
constexpr double kJoinDistanceSpacings = 0.02;
// Points per curve at which a continuation of the surface is searched for.
constexpr int kContinuationProbes = 9;

struct SurfacePoint {
    Eigen::Vector3d point, P_u, P_v, normal; ///< mm; tangents; unit
};

/// Where the tangents are parallel, as at a pole, the normal is taken a little towards the middle of the domain.
SurfacePoint surface_point(const surface::Patch& patch, const Eigen::Vector2d& uv)
{
    constexpr double kPoleOffset = 1e-5; // relative to the domain: the angle of the tangents there exceeds rounding
    const Eigen::Matrix3d P = surface::point_and_tangents(patch, uv);
    SurfacePoint result{P.col(0), P.col(1), P.col(2), P.col(1).cross(P.col(2))};
    if (result.normal.norm() < kPoleOffset * kPoleOffset * result.P_u.norm() * result.P_v.norm() ||
        !(result.normal.norm() > 0)) {
        const Eigen::Matrix3d Q = surface::point_and_tangents(
            patch, uv + kPoleOffset * (surface::parameter_domain(patch).rowwise().mean() - uv));
        result.normal = Q.col(1).cross(Q.col(2));
    }
    result.normal.normalize();
    return result;
}

/// Ascending parameters over a knot vector's domain, kSamplesPerSpan for each span.
std::vector<double> sample_parameters(const Eigen::VectorXd& knots, int degree)
{
    std::vector<double> parameters;
    const Eigen::Index last = knots.size() - degree - 1;
    for (Eigen::Index k = degree; k < last; ++k)
        for (int i = 0; i < kSamplesPerSpan && knots[k] < knots[k + 1]; ++i)
            parameters.push_back(knots[k] + (knots[k + 1] - knots[k]) * i / kSamplesPerSpan);
    parameters.push_back(knots[last]);
    return parameters;
}

/// Samples of a patch on a grid of parameters.
struct PatchSamples {
    std::vector<double> u, v;
    std::vector<SurfacePoint> points; ///< v varies fastest

    const SurfacePoint& at(std::size_t i, std::size_t j) const { return points[i * v.size() + j]; }
};

PatchSamples sample_patch(const surface::Patch& patch)
{
    PatchSamples grid{
        sample_parameters(patch.knots_u, patch.degree_u), sample_parameters(patch.knots_v, patch.degree_v), {}};
    for (const double u : grid.u)
        for (const double v : grid.v) grid.points.push_back(surface_point(patch, {u, v}));
    return grid;
}

/// Maximum change of the normal per length between neighbouring samples, 1/mm.
double max_curvature(const PatchSamples& grid)
{
    double max = 0;
    const auto add = [&](const SurfacePoint& a, const SurfacePoint& b) {
        const double length = (a.point - b.point).norm();
        if (length > 0) max = std::max(max, (a.normal - b.normal).norm() / length);
    };
    for (std::size_t i = 0; i < grid.u.size(); ++i)
        for (std::size_t j = 0; j < grid.v.size(); ++j) {
            if (i > 0) add(grid.at(i - 1, j), grid.at(i, j));
            if (j > 0) add(grid.at(i, j - 1), grid.at(i, j));
        }
    return max;
}

/// Divides a domain so that no arc between two lines of the lattice is longer than the spacing.
/// @param samples  parameters   @param lengths  of the longest arc between each two samples, mm
std::vector<double> lattice_lines(const std::vector<double>& samples, const std::vector<double>& lengths,
                                  double spacing, int patch)
{
    double total = 0;
    for (const double length : lengths) total += length;
    const double steps = std::max(1.0, std::ceil(total / spacing * (1 - 1e-9)));
    check_surfel_count(steps, patch);
    std::vector<double> lines;
    double before = 0;
    std::size_t k = 0;
    for (double i = 0; i <= steps; ++i) {
        const double arc_length = total * i / steps;
        while (k + 1 < lengths.size() && before + lengths[k] < arc_length) before += lengths[k++];
        const double fraction = lengths[k] > 0 ? std::clamp((arc_length - before) / lengths[k], 0.0, 1.0) : 0;
        lines.push_back(samples[k] + fraction * (samples[k + 1] - samples[k]));
    }
    return lines;
}

struct PatchLattice {
    std::vector<double> u, v; ///< lines
};

PatchLattice patch_lattice(const PatchSamples& grid, double spacing, int patch)
{
    // Between two samples the speed of an iso-curve is the greater of theirs.
    const auto add = [](double& length, double speed_a, double speed_b, double step) {
        length = std::max(length, std::max(speed_a, speed_b) * step);
    };
    std::vector<double> lengths_u(grid.u.size() - 1, 0), lengths_v(grid.v.size() - 1, 0);
    for (std::size_t i = 0; i < grid.u.size(); ++i)
        for (std::size_t j = 0; j < grid.v.size(); ++j) {
            const SurfacePoint& p = grid.at(i, j);
            if (i > 0) add(lengths_u[i - 1], grid.at(i - 1, j).P_u.norm(), p.P_u.norm(), grid.u[i] - grid.u[i - 1]);
            if (j > 0) add(lengths_v[j - 1], grid.at(i, j - 1).P_v.norm(), p.P_v.norm(), grid.v[j] - grid.v[j - 1]);
        }
    return {lattice_lines(grid.u, lengths_u, spacing, patch), lattice_lines(grid.v, lengths_v, spacing, patch)};
}

/// Adds surfels at the centres of the lattice's cells inside the trimming curves.
void sample_inside(const surface::Patch& patch, int number, const PatchLattice& lattice, std::vector<Surfel>& surfels)
{
    const std::vector<Eigen::Matrix2Xd> boundary = surface::boundary_polygons(patch);
    const std::size_t rows = lattice.u.size() - 1, columns = lattice.v.size() - 1;
    check_surfel_count(double(surfels.size()) + double(rows) * double(columns), number);
    std::vector<std::optional<Surfel>> cells(rows * columns);
    tbb::parallel_for(std::size_t{0}, rows, [&](std::size_t i) {
        for (std::size_t j = 0; j < columns; ++j) {
            const Eigen::Vector2d side(lattice.u[i + 1] - lattice.u[i], lattice.v[j + 1] - lattice.v[j]);
            const Eigen::Vector2d uv = Eigen::Vector2d(lattice.u[i], lattice.v[j]) + side / 2;
            if (!patch.trim.empty() && !surface::is_inside(boundary, uv)) continue;
            const SurfacePoint p = surface_point(patch, uv);
            const Eigen::Vector3d a = side[0] / 2 * p.P_u, b = side[1] / 2 * p.P_v;
            cells[i * columns + j] =
                Surfel{p.point, p.normal, uv, std::max((a + b).norm(), (a - b).norm()), number, 4 * a.cross(b).norm()};
        }
    });
    for (const std::optional<Surfel>& cell : cells)
        if (cell) surfels.push_back(*cell);
}

/// Adds the outlines of a patch in space, cut at their corners.
void add_boundary_curves(const surface::Patch& patch, int number, const SurfelSampling& options, double spacing,
                         std::vector<EdgeCurve>& curves)
{
    const Eigen::Matrix2d limits = surface::parameter_domain(patch);
    const Eigen::Array2d size = limits.col(1) - limits.col(0);
    for (const Eigen::Matrix2Xd& outline : surface::boundary_polygons(patch)) {
        std::vector<Eigen::Vector2d> uv;
        for (Eigen::Index i = 1; i < outline.cols(); ++i) {
            const Eigen::Vector2d a = outline.col(i - 1), b = outline.col(i);
            const double segments =
                std::max(1.0, std::ceil(((b - a).array() / size).abs().maxCoeff() * kSegmentsPerDomain));
            for (double k = 0; k < segments; ++k) uv.emplace_back(a + (b - a) * (k / segments));
        }
        std::vector<SurfacePoint> points;
        for (const Eigen::Vector2d& p : uv) points.push_back(surface_point(patch, p));
        const std::size_t count = points.size();
        const auto point = [&](std::size_t i) { return points[i % count].point; };
        std::vector<std::size_t> corners;
        for (std::size_t i = 0; i < count; ++i) {
            const Eigen::Vector3d before = point(i) - point(i + count - 1), after = point(i + 1) - point(i);
            if (before.dot(after) <= std::cos(options.sharp_angle) * before.norm() * after.norm()) corners.push_back(i);
        }
        if (corners.empty()) corners.push_back(0);
        for (std::size_t c = 0; c < corners.size(); ++c) {
            const std::size_t first = corners[c];
            const std::size_t last = c + 1 < corners.size() ? corners[c + 1] : corners[0] + count;
            EdgeCurve curve;
            const std::size_t vertices = last - first + 1;
            curve.points.resize(3, vertices);
            curve.normals.resize(3, vertices);
            curve.uv.resize(2, vertices);
            for (std::size_t k = 0; k < vertices; ++k) {
                curve.points.col(k) = point(first + k);
                curve.normals.col(k) = points[(first + k) % count].normal;
                curve.uv.col(k) = uv[(first + k) % count];
            }
            curve.patch = number;
            curve.spacing = spacing;
            curves.push_back(std::move(curve));
        }
    }
}

/// Does the curve pass a point within a distance and with nearly the same normal?
bool continues(const EdgeCurve& curve, const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double max_distance,
               double min_cosine)
{
    for (Eigen::Index i = 1; i < curve.points.cols(); ++i) {
        const Eigen::Vector3d a = curve.points.col(i - 1), ab = curve.points.col(i) - a;
        const double t = ab.squaredNorm() > 0 ? std::clamp((point - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0) : 0;
        // The sign of the normals depends on the parametrisation alone.
        if ((a + t * ab - point).norm() <= max_distance && std::abs(normal.dot(curve.normals.col(i))) >= min_cosine)
            return true;
    }
    return false;
}

/// Marks the curves along which the surface continues smoothly.
void mark_smooth(std::vector<EdgeCurve>& curves, double sharp_angle)
{
    std::vector<Eigen::AlignedBox3d> boxes;
    for (const EdgeCurve& curve : curves) boxes.push_back(geometry::bounding_box(curve.points));
    tbb::parallel_for(std::size_t{0}, curves.size(), [&](std::size_t i) {
        EdgeCurve& curve = curves[i];
        const double max_distance = kJoinDistanceSpacings * curve.spacing;
        int found = 0;
        for (int probe = 0; probe < kContinuationProbes; ++probe) {
            const Eigen::Index k = (2 * probe + 1) * (curve.points.cols() - 1) / (2 * kContinuationProbes);
            const Eigen::Vector3d point = (curve.points.col(k) + curve.points.col(k + 1)) / 2;
            for (std::size_t j = 0; j < curves.size(); ++j) {
                if (j == i || boxes[j].exteriorDistance(point) > max_distance) continue;
                if (!continues(curves[j], point, curve.normals.col(k), max_distance, std::cos(sharp_angle))) continue;
                ++found;
                break;
            }
        }
        curve.smooth = found == kContinuationProbes;
    });
}

} // namespace

SampledDesign sample_surfels(const std::vector<surface::Patch>& design, const SurfelSampling& options)
{
    SampledDesign sampled;
    sampled.patches = static_cast<int>(design.size());
    sampled.min_spacing = options.spacing;
    std::vector<Surfel> surfels;
    std::vector<EdgeCurve> curves;
    for (int number = 0; number < sampled.patches; ++number) {
        const surface::Patch& patch = design[number];
        const PatchSamples grid = sample_patch(patch);
        const double spacing = spacing_for_curvature(options, max_curvature(grid));
        sampled.min_spacing = std::min(sampled.min_spacing, spacing);
        sample_inside(patch, number, patch_lattice(grid, spacing, number), surfels);
        add_boundary_curves(patch, number, options, spacing, curves);
    }
    mark_smooth(curves, options.sharp_angle);
    // Without trimming the lattice's cells end at the boundary, which needs no surfels of its own.
    std::erase_if(curves, [&](const EdgeCurve& curve) { return curve.smooth && design[curve.patch].trim.empty(); });
    sampled.edges = resample_boundaries(surfels, curves, options.edge_spacing.value_or(sampled.min_spacing / 2));
    for (auto surfel = surfels.end() - sampled.edges.on_edges; surfel != surfels.end(); ++surfel) {
        const SurfacePoint exact = surface_point(design[surfel->patch], surfel->uv);
        surfel->position = exact.point;
        surfel->normal = exact.normal;
    }
    sampled.surfels = to_surfels(surfels);
    return sampled;
}

} // namespace fettle::belt
