#include "belt/design_mesh.h"
#include "belt/sampling.h"
#include "compare/weld.h"
#include "core/error.h"
#include "core/text.h"
#include "geometry/bounding_box.h"
#include "geometry/clipping.h"
#include "mesh/triangle.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>

namespace fettle::belt {
namespace {

// Quantile of a chart's curvature by area. The maximum would let a few slivers of a bad triangulation require millions
// of surfels.
constexpr double kCurvatureQuantile = 0.99;
// Shorter sides of facets, in units of the rounding of their coordinates, are not used for the curvature.
constexpr double kMinSideRoundings = 100;
// Height difference within a cell, in cell diagonals, above which two pieces of a chart are separate layers: more than
// its slope can rise.
constexpr double kLayerGapCells = 2;

/// The intersection of a facet and a cell of the lattice.
struct Entry {
    std::int64_t cell;
    double height;           ///< outward, mm
    double squared_distance; ///< from the cell's centre in the plane, mm²
    int facet;
    Eigen::Vector3d barycentric;
    double area; ///< of the intersection in the plane, mm²
};

/// Square cells in a chart's plane.
struct Lattice {
    Eigen::Array2d corner, side;
    Eigen::Array<std::int64_t, 2, 1> cells;

    Eigen::Array2d center(std::int64_t i, std::int64_t j) const
    {
        return corner + side * Eigen::Array2d(double(i) + 0.5, double(j) + 0.5);
    }
    std::int64_t cell(double coordinate, int axis) const
    {
        return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor((coordinate - corner[axis]) / side[axis])),
                                        0, cells[axis] - 1);
    }
};

/// Corners of a facet in a chart's axes.
mesh::Triangle facet_in(const DesignMesh& design, int f, const Eigen::Matrix3d& axes)
{
    mesh::Triangle corners;
    for (int k = 0; k < 3; ++k) corners.col(k) = axes.transpose() * design.corner(3 * f + k);
    return corners;
}

/// Curvature of a facet: the maximum change of the normal per length along its sides, without sides of rounding size.
double facet_curvature(const DesignMesh& design, int f)
{
    double max = 0;
    for (int k = 0; k < 3; ++k) {
        const int a = 3 * f + k, b = 3 * f + (k + 1) % 3;
        const double length = (design.corner(a) - design.corner(b)).norm();
        const double turn = (design.corner_normals.col(a) - design.corner_normals.col(b)).norm();
        if (length > kMinSideRoundings * compare::float_rounding(design.corner(a).cwiseAbs().maxCoeff()))
            max = std::max(max, turn / length);
    }
    return max;
}

double chart_curvature(const DesignMesh& design, const Chart& chart)
{
    std::vector<std::pair<double, double>> facets; // curvature, area
    double area = 0;
    for (const int f : chart.elements) {
        facets.emplace_back(facet_curvature(design, f), design.areas[f]);
        area += design.areas[f];
    }
    std::sort(facets.begin(), facets.end());
    std::size_t k = 0;
    double below = facets[k].second;
    while (below < kCurvatureQuantile * area) below += facets[++k].second;
    return facets[k].first;
}

Lattice lattice_over(const Eigen::AlignedBox2d& box, double step)
{
    Lattice lattice;
    lattice.corner = box.min();
    // The tolerance keeps rounding of a length of a whole number of steps from adding a cell.
    const Eigen::Array2d sides = box.sizes(), counts = (sides / step - 1e-9).ceil().max(1);
    constexpr double kMaxCells = 1e15; // numbers of cells stay exact; only those under facets take memory
    if (!(counts.prod() <= kMaxCells)) throw core::InputError("the spacing is too fine for the size of the design");
    lattice.cells = counts.cast<std::int64_t>();
    lattice.side = (sides / counts).max(std::numeric_limits<double>::min());
    return lattice;
}

/// Interval [min, max] in x of the part of a triangle with y from `low` to `high`; empty if min > max.
Eigen::Vector2d x_interval_between(const mesh::Triangle& t, double low, double high)
{
    Eigen::Vector2d interval(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity());
    const auto add = [&](double x) { interval = {std::min(interval[0], x), std::max(interval[1], x)}; };
    for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d a = t.col(k), b = t.col((k + 1) % 3);
        if (a.y() >= low && a.y() <= high) add(a.x());
        for (const double y : {low, high})
            if ((a.y() < y) != (b.y() < y)) add(a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()));
    }
    return interval;
}

void add_entries(const mesh::Triangle& corners, int facet, const Lattice& lattice, std::vector<Entry>& entries)
{
    mesh::Triangle flat = corners;
    flat.row(2).setZero();
    const Eigen::AlignedBox3d box = geometry::bounding_box(flat);
    for (std::int64_t j = lattice.cell(box.min().y(), 1); j <= lattice.cell(box.max().y(), 1); ++j) {
        const double low = lattice.corner.y() + double(j) * lattice.side.y();
        const Eigen::Vector2d interval = x_interval_between(flat, low, low + lattice.side.y());
        if (interval[0] > interval[1]) continue;
        for (std::int64_t i = lattice.cell(interval[0], 0); i <= lattice.cell(interval[1], 0); ++i) {
            const Eigen::Array2d center = lattice.center(i, j);
            const mesh::TrianglePoint point = mesh::closest_on_triangle(flat, {center.x(), center.y(), 0});
            if (((point.point.head<2>().array() - center).abs() > lattice.side * (0.5 + 1e-9)).any()) continue;
            const Eigen::AlignedBox2d cell(center - lattice.side / 2, center + lattice.side / 2);
            const geometry::ClippedTriangle<2> part(flat.topRows<2>(), cell);
            entries.push_back({j * lattice.cells[0] + i, corners.row(2).dot(point.barycentric), point.squared_distance,
                               facet, point.barycentric, geometry::polygon_area(part.corners())});
        }
    }
}

/// Selects one entry for each layer in each cell: the closest to the cell's centre, with the area of all.
std::vector<Entry> select_closest(std::vector<Entry> entries, double gap)
{
    std::ranges::sort(entries, {}, [](const Entry& e) { return std::tuple(e.cell, e.height, e.facet); });
    std::vector<Entry> selected;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const Entry& entry = entries[i];
        if (i == 0 || entry.cell != entries[i - 1].cell || entry.height - entries[i - 1].height > gap) {
            selected.push_back(entry);
        } else {
            const double area = selected.back().area + entry.area;
            if (entry.squared_distance < selected.back().squared_distance) selected.back() = entry;
            selected.back().area = area;
        }
    }
    return selected;
}

/// Adds the interior surfels of a chart.
void sample_chart(const DesignMesh& design, const Chart& chart, int patch, double spacing, std::vector<Surfel>& surfels)
{
    Eigen::AlignedBox2d box;
    for (const int f : chart.elements) box.extend(geometry::bounding_box(facet_in(design, f, chart.axes).topRows<2>()));
    const Lattice lattice = lattice_over(box, spacing * chart.min_cosine);
    std::vector<Entry> entries;
    for (const int f : chart.elements)
        if (design.areas[f] > 0) add_entries(facet_in(design, f, chart.axes), f, lattice, entries);
    // The entries' areas are converted from the plane to the surface. They are then scaled to the chart's area, since
    // facets that only reach into a corner of a cell have no entry there.
    double area = 0, entry_area = 0;
    for (const int f : chart.elements) area += design.areas[f];
    for (Entry& entry : entries) {
        entry.area /= design.facet_normals.col(entry.facet).dot(chart.axes.col(2));
        entry_area += entry.area;
    }
    const double half = lattice.side.matrix().norm() / 2;
    for (const Entry& entry : select_closest(std::move(entries), kLayerGapCells * 2 * half)) {
        Surfel surfel;
        surfel.position.setZero();
        surfel.normal.setZero();
        for (int k = 0; k < 3; ++k) {
            surfel.position += entry.barycentric[k] * design.corner(3 * entry.facet + k);
            surfel.normal += entry.barycentric[k] * design.corner_normals.col(3 * entry.facet + k);
        }
        if (!(surfel.normal.norm() > 0)) surfel.normal = design.facet_normals.col(entry.facet);
        surfel.normal.normalize();
        surfel.uv = chart.axes.leftCols<2>().transpose() * surfel.position;
        surfel.radius = half / design.facet_normals.col(entry.facet).dot(chart.axes.col(2));
        surfel.patch = patch;
        surfel.area = entry_area > 0 ? entry.area * (area / entry_area) : 0;
        surfels.push_back(surfel);
    }
}

/// Cuts the sharp loops where they turn sharply and where the patch changes.
std::vector<EdgeCurve> boundary_curves(const DesignMesh& design, const std::vector<Chart>& charts,
                                       const std::vector<int>& patches, const std::vector<double>& spacings,
                                       double sharp_angle)
{
    const auto end_of = [](int h) { return h - h % 3 + (h + 1) % 3; };
    const auto direction = [&](int h) { return Eigen::Vector3d(design.corner(end_of(h)) - design.corner(h)); };
    const auto patch = [&](int h) { return patches[h / 3]; };
    const auto is_corner = [&](int before, int after) {
        const Eigen::Vector3d a = direction(before), b = direction(after);
        return patch(before) != patch(after) || a.dot(b) < std::cos(sharp_angle) * a.norm() * b.norm();
    };
    std::vector<EdgeCurve> curves;
    for (const std::vector<int>& loop : sharp_loops(design)) {
        const std::size_t size = loop.size();
        std::size_t start = 0;
        while (start < size && !is_corner(loop[(start + size - 1) % size], loop[start])) ++start;
        if (start == size) start = 0;
        for (std::size_t first = 0, last = 0; first < size; first = last) {
            last = first + 1;
            while (last < size && !is_corner(loop[(start + last - 1) % size], loop[(start + last) % size])) ++last;
            EdgeCurve curve;
            curve.patch = patch(loop[(start + first) % size]);
            const Eigen::Index count = last - first + 1;
            curve.points.resize(3, count);
            curve.normals.resize(3, count);
            for (Eigen::Index i = 0; i < count; ++i) {
                const bool is_last = i + 1 == count;
                const int h = loop[(start + first + (is_last ? i - 1 : i)) % size];
                const int corner = is_last ? end_of(h) : h;
                curve.points.col(i) = design.corner(corner);
                curve.normals.col(i) = design.corner_normals.col(corner);
            }
            curve.uv = charts[curve.patch].axes.leftCols<2>().transpose() * curve.points;
            curve.spacing = spacings[curve.patch];
            curves.push_back(std::move(curve));
        }
    }
    return curves;
}

} // namespace

double spacing_for_curvature(const SurfelSampling& options, double curvature)
{
    if (!options.precision || !(curvature > 0)) return options.spacing;
    return std::min(options.spacing, 2 * std::sqrt(*options.precision / curvature));
}

void check_surfel_count(double count, int patch)
{
    if (count <= kMaxSurfels) return;
    throw core::InputError("patch " + std::to_string(patch) + ": the spacing is too fine for its size: " +
                           core::to_short_text(count) + " surfels, at most " + core::to_short_text(kMaxSurfels));
}

SampledDesign sample_surfels(mesh::Mesh mesh, const SurfelSampling& options)
{
    const DesignMesh design = design_mesh(std::move(mesh), options.sharp_angle);
    std::vector<Chart> charts = segment_into_charts(design.adjacency, design.facet_normals, design.areas);
    std::vector<int> patches(design.areas.size()); // of the facets
    std::vector<double> spacings;
    std::vector<Surfel> surfels;
    double count = 0;
    for (std::size_t c = 0; c < charts.size(); ++c) {
        Chart& chart = charts[c];
        Eigen::Matrix3Xd corners(3, 3 * chart.elements.size());
        double area = 0;
        for (std::size_t i = 0; i < chart.elements.size(); ++i) {
            const int f = chart.elements[i];
            patches[f] = static_cast<int>(c);
            for (int k = 0; k < 3; ++k) corners.col(3 * i + k) = design.corner(3 * f + k);
            area += design.areas[f];
        }
        chart.axes = min_rectangle_axes(corners, chart.axes.col(2));
        spacings.push_back(spacing_for_curvature(options, chart_curvature(design, chart)));
        check_surfel_count(count += area / (spacings.back() * spacings.back()), static_cast<int>(c));
        sample_chart(design, chart, static_cast<int>(c), spacings.back(), surfels);
    }
    SampledDesign sampled;
    sampled.patches = static_cast<int>(charts.size());
    sampled.min_spacing = *std::min_element(spacings.begin(), spacings.end());
    const double e = options.edge_spacing.value_or(sampled.min_spacing / 2);
    sampled.edges =
        resample_boundaries(surfels, boundary_curves(design, charts, patches, spacings, options.sharp_angle), e);
    sampled.surfels = to_surfels(surfels);
    return sampled;
}

} // namespace fettle::belt
