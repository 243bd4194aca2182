#include "belt/design_mesh.h"
#include "belt/sampling.h"
#include "compare/weld.h"
#include "core/error.h"
#include "mesh/triangle.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace fettle {
namespace {

// Of a chart's curvature this share of the area has less: a few slivers of a bad triangulation may not ask for millions
// of surfels.
constexpr double kCurvedShare = 0.99;
// Shorter sides of facets, in roundings of their coordinates, say nothing about curvature.
constexpr double kSide = 100;
// In a cell, what lies farther above another piece of the chart than a slope in it can rise, in cells, is another
// layer.
constexpr double kLayerGap = 2;

/// A facet that reaches into a cell of the lattice.
struct Entry {
    std::int64_t cell;
    double height;           ///< outward, mm
    double squared_distance; ///< from the cell's middle in the plane, mm²
    int facet;
    Eigen::Vector3d barycentric;
    double area; ///< of what of the facet is over the cell, in the plane, mm²
};

/// The cells of a chart's plane.
struct Lattice {
    Eigen::Array2d corner, side;
    Eigen::Array<std::int64_t, 2, 1> cells;

    Eigen::Array2d middle(std::int64_t i, std::int64_t j) const
    {
        return corner + side * Eigen::Array2d(double(i) + 0.5, double(j) + 0.5);
    }
    std::int64_t cell(double place, int axis) const
    {
        return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor((place - corner[axis]) / side[axis])), 0,
                                        cells[axis] - 1);
    }
};

Triangle facet_in(const DesignMesh& design, int f, const Eigen::Matrix3d& axes)
{
    Triangle corners;
    for (int k = 0; k < 3; ++k) corners.col(k) = axes.transpose() * design.corner(3 * f + k);
    return corners;
}

/// A normal turns by the curvature along a length: the most along a facet's sides, if rounding leaves these a
/// direction.
double curvature(const DesignMesh& design, int f)
{
    double most = 0;
    for (int k = 0; k < 3; ++k) {
        const int a = 3 * f + k, b = 3 * f + (k + 1) % 3;
        const double length = (design.corner(a) - design.corner(b)).norm();
        const double turn = (design.corner_normals.col(a) - design.corner_normals.col(b)).norm();
        if (length > kSide * float_rounding(design.corner(a).cwiseAbs().maxCoeff()))
            most = std::max(most, turn / length);
    }
    return most;
}

double curvature(const DesignMesh& design, const Chart& chart)
{
    std::vector<std::pair<double, double>> of_area;
    double whole = 0;
    for (const int f : chart.elements) {
        of_area.emplace_back(curvature(design, f), design.areas[f]);
        whole += design.areas[f];
    }
    std::sort(of_area.begin(), of_area.end());
    std::size_t k = 0;
    double below = of_area[k].second;
    while (below < kCurvedShare * whole) below += of_area[++k].second;
    return of_area[k].first;
}

Lattice lattice_over(const Eigen::Array2d& least, const Eigen::Array2d& most, double step)
{
    Lattice lattice;
    lattice.corner = least;
    // Rounding of a length that is a whole number of steps makes no further cell.
    const Eigen::Array2d counts = ((most - least) / step - 1e-9).ceil().max(1);
    check_surfel_count(counts.prod());
    lattice.cells = counts.cast<std::int64_t>();
    lattice.side = ((most - least) / counts).max(std::numeric_limits<double>::min());
    return lattice;
}

/// What of a triangle (x, y) lies between two values of y: least and most x; nothing if least > most.
Eigen::Vector2d stretch_between(const Triangle& t, double low, double high)
{
    Eigen::Vector2d found(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity());
    const auto add = [&](double x) { found = {std::min(found[0], x), std::max(found[1], x)}; };
    for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d a = t.col(k), b = t.col((k + 1) % 3);
        if (a.y() >= low && a.y() <= high) add(a.x());
        for (const double y : {low, high})
            if ((a.y() < y) != (b.y() < y)) add(a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()));
    }
    return found;
}

/// The area of what of a triangle (x, y) lies in a rectangle, by clipping at its sides (Sutherland & Hodgman 1974).
double area_in(const Triangle& t, const Eigen::Array2d& least, const Eigen::Array2d& most)
{
    std::array<Eigen::Vector2d, 7> polygon; // each of the four sides adds a corner at most
    std::size_t count = 3;
    for (int k = 0; k < 3; ++k) polygon[static_cast<std::size_t>(k)] = t.col(k).head<2>();
    for (int side = 0; side < 4; ++side) {
        const int axis = side / 2;
        const double sign = side % 2 == 0 ? 1 : -1, limit = side % 2 == 0 ? least[axis] : most[axis];
        std::array<Eigen::Vector2d, 7> clipped;
        std::size_t kept = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const Eigen::Vector2d &a = polygon[k], &b = polygon[(k + 1) % count];
            const double of_a = sign * (a[axis] - limit), of_b = sign * (b[axis] - limit);
            if (of_a >= 0) clipped[kept++] = a;
            if ((of_a < 0) != (of_b < 0)) clipped[kept++] = a + (b - a) * (of_a / (of_a - of_b));
        }
        polygon = clipped;
        count = kept;
    }
    double twice = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const Eigen::Vector2d &a = polygon[k], &b = polygon[(k + 1) % count];
        twice += a.x() * b.y() - a.y() * b.x();
    }
    return std::abs(twice) / 2;
}

void add_entries(const Triangle& corners, int facet, const Lattice& lattice, std::vector<Entry>& entries)
{
    Triangle flat = corners;
    flat.row(2).setZero();
    const Eigen::Vector3d least = flat.rowwise().minCoeff(), most = flat.rowwise().maxCoeff();
    for (std::int64_t j = lattice.cell(least.y(), 1); j <= lattice.cell(most.y(), 1); ++j) {
        const double low = lattice.corner.y() + double(j) * lattice.side.y();
        const Eigen::Vector2d stretch = stretch_between(flat, low, low + lattice.side.y());
        if (stretch[0] > stretch[1]) continue;
        for (std::int64_t i = lattice.cell(stretch[0], 0); i <= lattice.cell(stretch[1], 0); ++i) {
            const Eigen::Array2d middle = lattice.middle(i, j);
            const TrianglePoint point = closest_on_triangle(flat, {middle.x(), middle.y(), 0});
            if (((point.point.head<2>().array() - middle).abs() > lattice.side * (0.5 + 1e-9)).any()) continue;
            entries.push_back({j * lattice.cells[0] + i, corners.row(2).dot(point.barycentric), point.squared_distance,
                               facet, point.barycentric,
                               area_in(flat, middle - lattice.side / 2, middle + lattice.side / 2)});
        }
    }
}

/// The entries that become surfels: of each layer in each cell the one closest to its middle, with the areas of all.
std::vector<Entry> chosen(std::vector<Entry> entries, double gap)
{
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        if (a.cell != b.cell) return a.cell < b.cell;
        if (a.height != b.height) return a.height < b.height;
        return a.facet < b.facet;
    });
    std::vector<Entry> best;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const Entry& entry = entries[i];
        if (i == 0 || entry.cell != entries[i - 1].cell || entry.height - entries[i - 1].height > gap)
            best.push_back(entry);
        else {
            const double area = best.back().area + entry.area;
            if (entry.squared_distance < best.back().squared_distance) best.back() = entry;
            best.back().area = area;
        }
    }
    return best;
}

/// The surfels inside a chart.
void sample_chart(const DesignMesh& design, const Chart& chart, int patch, double spacing, std::vector<Surfel>& surfels)
{
    Eigen::Array2d least = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity()), most = -least;
    for (const int f : chart.elements) {
        const Triangle corners = facet_in(design, f, chart.axes);
        least = least.min(corners.topRows<2>().rowwise().minCoeff().array());
        most = most.max(corners.topRows<2>().rowwise().maxCoeff().array());
    }
    const Lattice lattice = lattice_over(least, most, spacing * chart.steepest);
    std::vector<Entry> entries;
    for (const int f : chart.elements) {
        if (!(design.areas[f] > 0)) continue;
        add_entries(facet_in(design, f, chart.axes), f, lattice, entries);
    }
    // Of the plane, and of facets that reach into a corner of a cell, but are closest to its middle beyond it.
    double area = 0, found = 0;
    for (const int f : chart.elements) area += design.areas[f];
    for (Entry& entry : entries) {
        entry.area /= design.facet_normals.col(entry.facet).dot(chart.axes.col(2));
        found += entry.area;
    }
    const double half = lattice.side.matrix().norm() / 2;
    for (const Entry& entry : chosen(std::move(entries), kLayerGap * 2 * half)) {
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
        surfel.area = found > 0 ? entry.area * (area / found) : 0;
        surfels.push_back(surfel);
    }
}

/// Loops cut where they turn sharply and where the patch changes.
std::vector<EdgeCurve> curves_of(const DesignMesh& design, const std::vector<Chart>& charts,
                                 const std::vector<int>& patches, const std::vector<double>& spacings, double sharp)
{
    const auto way = [&](int h) { return Eigen::Vector3d(design.corner(h - h % 3 + (h + 1) % 3) - design.corner(h)); };
    const auto patch = [&](int h) { return patches[static_cast<std::size_t>(h / 3)]; };
    const auto corner = [&](int before, int after) {
        const Eigen::Vector3d a = way(before), b = way(after);
        return patch(before) != patch(after) || a.dot(b) < std::cos(sharp) * a.norm() * b.norm();
    };
    std::vector<EdgeCurve> curves;
    for (const std::vector<int>& loop : sharp_loops(design)) {
        const std::size_t size = loop.size();
        std::size_t start = 0;
        while (start < size && !corner(loop[(start + size - 1) % size], loop[start])) ++start;
        if (start == size) start = 0;
        for (std::size_t first = 0, last = 0; first < size; first = last) {
            last = first + 1;
            while (last < size && !corner(loop[(start + last - 1) % size], loop[(start + last) % size])) ++last;
            EdgeCurve curve;
            curve.patch = patch(loop[(start + first) % size]);
            const auto count = static_cast<Eigen::Index>(last - first + 1);
            curve.points.resize(3, count);
            curve.normals.resize(3, count);
            for (Eigen::Index i = 0; i < count; ++i) {
                const bool end = i + 1 == count;
                const int h = loop[(start + first + static_cast<std::size_t>(end ? i - 1 : i)) % size];
                const int at = end ? h - h % 3 + (h + 1) % 3 : h;
                curve.points.col(i) = design.corner(at);
                curve.normals.col(i) = design.corner_normals.col(at);
            }
            const Chart& chart = charts[static_cast<std::size_t>(curve.patch)];
            curve.uv = chart.axes.leftCols<2>().transpose() * curve.points;
            curve.spacing = spacings[static_cast<std::size_t>(curve.patch)];
            curves.push_back(std::move(curve));
        }
    }
    return curves;
}

} // namespace

double spacing_for(const SurfelSampling& options, double curvature)
{
    if (!options.precision || !(curvature > 0)) return options.spacing;
    return std::min(options.spacing, 2 * std::sqrt(*options.precision / curvature));
}

void check_surfel_count(double count)
{
    constexpr double kMostSurfels = 2e8; // 100 bytes each
    if (count > kMostSurfels) throw InputError("a spacing so fine makes more than 200 million surfels");
}

SampledDesign sample_surfels(Mesh mesh, const SurfelSampling& options)
{
    const DesignMesh design = design_mesh(std::move(mesh), options.sharp);
    std::vector<Chart> charts = charts_of(design.adjacency, design.facet_normals, design.areas);
    std::vector<int> patches(static_cast<std::size_t>(design.areas.size()));
    std::vector<double> spacings;
    std::vector<Surfel> surfels;
    double count = 0;
    for (std::size_t c = 0; c < charts.size(); ++c) {
        Chart& chart = charts[c];
        Eigen::Matrix3Xd corners(3, 3 * chart.elements.size());
        double area = 0;
        for (std::size_t i = 0; i < chart.elements.size(); ++i) {
            const int f = chart.elements[i];
            patches[static_cast<std::size_t>(f)] = static_cast<int>(c);
            for (int k = 0; k < 3; ++k) corners.col(static_cast<Eigen::Index>(3 * i) + k) = design.corner(3 * f + k);
            area += design.areas[f];
        }
        chart.axes = rectangle_axes(corners, chart.axes.col(2));
        spacings.push_back(spacing_for(options, curvature(design, chart)));
        check_surfel_count(count += area / (spacings.back() * spacings.back()));
        sample_chart(design, chart, static_cast<int>(c), spacings.back(), surfels);
    }
    SampledDesign sampled;
    sampled.patches = static_cast<int>(charts.size());
    sampled.least_spacing = *std::min_element(spacings.begin(), spacings.end());
    const double e = options.edge_spacing.value_or(sampled.least_spacing / 2);
    sampled.edges = resample_boundaries(surfels, curves_of(design, charts, patches, spacings, options.sharp), e);
    sampled.surfels = to_surfels(surfels);
    return sampled;
}

} // namespace fettle
