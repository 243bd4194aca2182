#include "belt/sampling.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>

namespace fettle {
namespace {

// Places a span of the knots at which lengths and curvatures of a patch are taken: a cubic span has no more than two
// bends.
constexpr int kPlacesPerSpan = 16;
// Pieces of a boundary curve that runs from one side of the domain to the other.
constexpr double kPieces = 256;
// Boundaries closer than this share of the spacing are one: surfels cannot tell.
constexpr double kJoined = 0.02;
// Places of a curve at which the surface beyond it is looked for.
constexpr int kProbes = 9;

struct Place {
    Eigen::Vector3d point, along_u, along_v, normal;
};

/// Where two tangents are parallel, as at a pole, the normal is that beside it, towards the domain's middle.
Place place_on(const Patch& patch, const Eigen::Vector2d& uv)
{
    constexpr double kBeside = 1e-5; // of the domain: the tangents are then apart by more than rounding
    const Eigen::Matrix3d here = point_and_tangents(patch, uv);
    Place place{here.col(0), here.col(1), here.col(2), here.col(1).cross(here.col(2))};
    if (place.normal.norm() < kBeside * kBeside * place.along_u.norm() * place.along_v.norm() ||
        !(place.normal.norm() > 0)) {
        const Eigen::Matrix3d beside = point_and_tangents(patch, uv + kBeside * (domain(patch).rowwise().mean() - uv));
        place.normal = beside.col(1).cross(beside.col(2));
    }
    place.normal.normalize();
    return place;
}

/// Ascending places of a knot vector's domain, kPlacesPerSpan a span.
std::vector<double> fine_places(const Eigen::VectorXd& knots, int degree)
{
    std::vector<double> places;
    const Eigen::Index last = knots.size() - degree - 1;
    for (Eigen::Index k = degree; k < last; ++k)
        for (int i = 0; i < kPlacesPerSpan && knots[k] < knots[k + 1]; ++i)
            places.push_back(knots[k] + (knots[k + 1] - knots[k]) * i / kPlacesPerSpan);
    places.push_back(knots[last]);
    return places;
}

/// A patch on a fine grid.
struct FineGrid {
    std::vector<double> u, v;
    std::vector<Place> places; ///< v within u

    const Place& at(std::size_t i, std::size_t j) const { return places[i * v.size() + j]; }
};

FineGrid fine_grid(const Patch& patch)
{
    FineGrid grid{fine_places(patch.knots_u, patch.degree_u), fine_places(patch.knots_v, patch.degree_v), {}};
    for (const double u : grid.u)
        for (const double v : grid.v) grid.places.push_back(place_on(patch, {u, v}));
    return grid;
}

double curvature(const FineGrid& grid)
{
    double most = 0;
    const auto look = [&](const Place& a, const Place& b) {
        const double length = (a.point - b.point).norm();
        if (length > 0) most = std::max(most, (a.normal - b.normal).norm() / length);
    };
    for (std::size_t i = 0; i < grid.u.size(); ++i)
        for (std::size_t j = 0; j < grid.v.size(); ++j) {
            if (i > 0) look(grid.at(i - 1, j), grid.at(i, j));
            if (j > 0) look(grid.at(i, j - 1), grid.at(i, j));
        }
    return most;
}

/// Cuts a domain so that no arc between two cuts is longer than the spacing. @param lengths  of the longest arc between
/// fine places, one fewer than these
std::vector<double> cuts(const std::vector<double>& fine, const std::vector<double>& lengths, double spacing)
{
    double whole = 0;
    for (const double length : lengths) whole += length;
    const double steps = std::max(1.0, std::ceil(whole / spacing * (1 - 1e-9)));
    check_surfel_count(steps);
    std::vector<double> places;
    double before = 0;
    std::size_t k = 0;
    for (double i = 0; i <= steps; ++i) {
        const double wanted = whole * i / steps;
        while (k + 1 < lengths.size() && before + lengths[k] < wanted) before += lengths[k++];
        const double share = lengths[k] > 0 ? std::clamp((wanted - before) / lengths[k], 0.0, 1.0) : 0;
        places.push_back(fine[k] + share * (fine[k + 1] - fine[k]));
    }
    return places;
}

struct Cuts {
    std::vector<double> u, v;
};

Cuts lattice_cuts(const FineGrid& grid, double spacing)
{
    // The speed of an iso-curve is taken where it is greater of either end of a fine step.
    std::vector<double> along_u(grid.u.size() - 1, 0), along_v(grid.v.size() - 1, 0);
    for (std::size_t i = 0; i < grid.u.size(); ++i)
        for (std::size_t j = 0; j < grid.v.size(); ++j) {
            const auto speed_u = [&](std::size_t k) { return grid.at(k, j).along_u.norm(); };
            const auto speed_v = [&](std::size_t k) { return grid.at(i, k).along_v.norm(); };
            if (i > 0)
                along_u[i - 1] =
                    std::max(along_u[i - 1], std::max(speed_u(i - 1), speed_u(i)) * (grid.u[i] - grid.u[i - 1]));
            if (j > 0)
                along_v[j - 1] =
                    std::max(along_v[j - 1], std::max(speed_v(j - 1), speed_v(j)) * (grid.v[j] - grid.v[j - 1]));
        }
    return {cuts(grid.u, along_u, spacing), cuts(grid.v, along_v, spacing)};
}

/// The middles of the lattice's cells, as far as the patch is there.
void sample_inside(const Patch& patch, int number, const Cuts& lattice, std::vector<Surfel>& surfels)
{
    const std::vector<Eigen::Matrix2Xd> around = outlines(patch);
    const std::size_t rows = lattice.u.size() - 1, columns = lattice.v.size() - 1;
    check_surfel_count(double(rows) * double(columns));
    std::vector<std::optional<Surfel>> cells(rows * columns);
    tbb::parallel_for(std::size_t{0}, rows, [&](std::size_t i) {
        for (std::size_t j = 0; j < columns; ++j) {
            const Eigen::Vector2d side(lattice.u[i + 1] - lattice.u[i], lattice.v[j + 1] - lattice.v[j]);
            const Eigen::Vector2d uv = Eigen::Vector2d(lattice.u[i], lattice.v[j]) + side / 2;
            if (!patch.trim.empty() && !inside(around, uv)) continue;
            const Place place = place_on(patch, uv);
            const Eigen::Vector3d a = side[0] / 2 * place.along_u, b = side[1] / 2 * place.along_v;
            cells[i * columns + j] = Surfel{
                place.point, place.normal, uv, std::max((a + b).norm(), (a - b).norm()), number, 4 * a.cross(b).norm()};
        }
    });
    for (const std::optional<Surfel>& cell : cells)
        if (cell) surfels.push_back(*cell);
}

/// The outlines of a patch in space, cut at their corners.
void add_curves(const Patch& patch, int number, const SurfelSampling& options, double spacing,
                std::vector<EdgeCurve>& curves)
{
    const Eigen::Matrix2d limits = domain(patch);
    const Eigen::Array2d size = limits.col(1) - limits.col(0);
    for (const Eigen::Matrix2Xd& outline : outlines(patch)) {
        std::vector<Eigen::Vector2d> uv;
        for (Eigen::Index i = 1; i < outline.cols(); ++i) {
            const Eigen::Vector2d a = outline.col(i - 1), b = outline.col(i);
            const double pieces = std::max(1.0, std::ceil(((b - a).array() / size).abs().maxCoeff() * kPieces));
            for (double k = 0; k < pieces; ++k) uv.emplace_back(a + (b - a) * (k / pieces));
        }
        std::vector<Place> places;
        for (const Eigen::Vector2d& at : uv) places.push_back(place_on(patch, at));
        const std::size_t count = places.size();
        const auto point = [&](std::size_t i) { return places[i % count].point; };
        std::vector<std::size_t> corners;
        for (std::size_t i = 0; i < count; ++i) {
            const Eigen::Vector3d before = point(i) - point(i + count - 1), after = point(i + 1) - point(i);
            if (before.dot(after) <= std::cos(options.sharp) * before.norm() * after.norm()) corners.push_back(i);
        }
        if (corners.empty()) corners.push_back(0);
        for (std::size_t c = 0; c < corners.size(); ++c) {
            const std::size_t first = corners[c];
            const std::size_t last = c + 1 < corners.size() ? corners[c + 1] : corners[0] + count;
            EdgeCurve curve;
            const auto length = static_cast<Eigen::Index>(last - first + 1);
            curve.points.resize(3, length);
            curve.normals.resize(3, length);
            curve.uv.resize(2, length);
            for (std::size_t i = first; i <= last; ++i) {
                const auto k = static_cast<Eigen::Index>(i - first);
                curve.points.col(k) = point(i);
                curve.normals.col(k) = places[i % count].normal;
                curve.uv.col(k) = uv[i % count];
            }
            curve.patch = number;
            curve.spacing = spacing;
            curves.push_back(std::move(curve));
        }
    }
}

/// Is there a piece of the curve so near to a point, with nearly its normal?
bool continues(const EdgeCurve& curve, const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double near,
               double least_cosine)
{
    for (Eigen::Index i = 1; i < curve.points.cols(); ++i) {
        const Eigen::Vector3d a = curve.points.col(i - 1), way = curve.points.col(i) - a;
        const double share = way.squaredNorm() > 0 ? std::clamp((point - a).dot(way) / way.squaredNorm(), 0.0, 1.0) : 0;
        // Which way round two patches are parametrised says nothing about an edge between them.
        if ((a + share * way - point).norm() <= near && std::abs(normal.dot(curve.normals.col(i))) >= least_cosine)
            return true;
    }
    return false;
}

/// Marks the curves along which the surface goes on.
void find_smooth(std::vector<EdgeCurve>& curves, double sharp)
{
    std::vector<Eigen::AlignedBox3d> boxes;
    for (const EdgeCurve& curve : curves)
        boxes.emplace_back(curve.points.rowwise().minCoeff(), curve.points.rowwise().maxCoeff());
    tbb::parallel_for(std::size_t{0}, curves.size(), [&](std::size_t i) {
        EdgeCurve& curve = curves[i];
        const double near = kJoined * curve.spacing;
        int found = 0;
        for (int probe = 0; probe < kProbes; ++probe) {
            const Eigen::Index k = (2 * probe + 1) * (curve.points.cols() - 1) / (2 * kProbes);
            const Eigen::Vector3d point = (curve.points.col(k) + curve.points.col(k + 1)) / 2;
            for (std::size_t j = 0; j < curves.size(); ++j) {
                if (j == i || boxes[j].exteriorDistance(point) > near) continue;
                if (!continues(curves[j], point, curve.normals.col(k), near, std::cos(sharp))) continue;
                ++found;
                break;
            }
        }
        curve.smooth = found == kProbes;
    });
}

} // namespace

SampledDesign sample_surfels(const std::vector<Patch>& design, const SurfelSampling& options)
{
    SampledDesign sampled;
    sampled.patches = static_cast<int>(design.size());
    sampled.least_spacing = options.spacing;
    std::vector<Surfel> surfels;
    std::vector<EdgeCurve> curves;
    for (int number = 0; number < sampled.patches; ++number) {
        const Patch& patch = design[static_cast<std::size_t>(number)];
        const FineGrid grid = fine_grid(patch);
        const double spacing = spacing_for(options, curvature(grid));
        sampled.least_spacing = std::min(sampled.least_spacing, spacing);
        sample_inside(patch, number, lattice_cuts(grid, spacing), surfels);
        add_curves(patch, number, options, spacing, curves);
    }
    find_smooth(curves, options.sharp);
    // Without trimming the lattice's cells end at the boundary; nothing is missing there.
    std::erase_if(curves, [&](const EdgeCurve& curve) {
        return curve.smooth && design[static_cast<std::size_t>(curve.patch)].trim.empty();
    });
    sampled.edges = resample_boundaries(surfels, curves, options.edge_spacing.value_or(sampled.least_spacing / 2));
    for (auto surfel = surfels.end() - sampled.edges.on_edges; surfel != surfels.end(); ++surfel) {
        const Place place = place_on(design[static_cast<std::size_t>(surfel->patch)], surfel->uv);
        surfel->position = place.point;
        surfel->normal = place.normal;
    }
    sampled.surfels = to_surfels(surfels);
    return sampled;
}

} // namespace fettle
