#include "find/view.h"

#include "core/error.h"
#include "geometry/planar_grid.h"
#include "geometry/quantiles.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fettle::find {
namespace {

using Eigen::Index;

constexpr double kMaxCells = 2e7; // bounds the memory: some ten images of a map, four bytes a cell

// A cell's height is the median of its points no deeper than this beneath its highest, in cells. Deeper points belong
// to another surface.
constexpr double kLayerCells = 3;

// A cell is hidden if it lies so many cells beneath the cells within kHiddenReach: it shows the far side of a body,
// since no point of the near side fell into it. Walls up to 70 degrees drop by less within that reach.
constexpr int kHiddenReach = 2;
constexpr float kHiddenCells = 6;

// The edge of a cell is the median spacing of the points. It is increased by this ratio until at least kMinFill of the
// cells are filled; gaps count as cells to fill up to the 0.9 quantile of the spacing, which is that of sparse areas.
constexpr double kCellRatio = 1.25;
constexpr double kMinFill = 0.8;
constexpr int kMinFillRadius = 2, kMaxFillRadius = 8; // of these gaps, cells
constexpr double kSparseQuantile = 0.9;
constexpr int kSpacingQueries = 4000; // about
constexpr double kPointsPerGridCell = 3;
constexpr Index kGrainSize = 65536; // points for one task

// A mesh has been smoothed and interpolated, so its second differences do not show the noise that remains in waves of a
// few cells. This is a lower bound of the noise, in cells; scans have 0.03 to 0.1.
constexpr double kMinMeshSigmaCells = 0.05;
constexpr double kMinFacing = 0.17; // cosine of 80 degrees: steeper surfaces are seen from the side and have no height
constexpr double kMinMeshCells = 300, kMaxMeshCells = 3000; // along a mesh's diagonal
constexpr double kMinTriangleArea = 1e-12; // twice the area, in cells: a degenerate triangle covers no cell's centre
constexpr double kMinBarycentric = -1e-9;  // cells on the common edge of two triangles belong to both

/// Distances of points in a plane to their nearest neighbours.
struct Spacing {
    double median;
    double sparse; // kSparseQuantile
};

using Places = Eigen::Ref<const Eigen::Matrix2Xd, 0, Eigen::OuterStride<>>;

/// Squared distance of a point to the nearest one that is not at the same place; infinite if there is none in the
/// square around it of which `reach` is half a side. Most have one in a cell beside theirs.
double squared_distance_to_nearest(const geometry::PlanarGrid& grid, const Places& points, Index point, double reach)
{
    const Eigen::Array2d p = points.col(point).array();
    for (double half = std::min(grid.side, reach);; half = std::min(2 * half, reach)) {
        double squared = std::numeric_limits<double>::infinity();
        geometry::visit_cells(grid, p - half, p + half, [&](Index k) {
            const double other = (points.col(grid.order[std::size_t(k)]) - points.col(point)).squaredNorm();
            if (other > 0) squared = std::min(squared, other);
        });
        if (squared <= half * half || half >= reach) return squared;
    }
}

/// The spacing over the area: one point is sampled in each square of a grid. Statistics over all points would be those
/// of dense areas, such as walls seen from the side or the overlaps of merged scans.
Spacing spacing_of(const Places& points)
{
    const geometry::PlanarGrid grid = geometry::planar_grid(points, kPointsPerGridCell);
    const int step = std::max(1, int(std::sqrt(double(grid.count.prod()) / kSpacingQueries)));
    std::vector<double> nearest;
    for (int y = 0; y < grid.count.y(); y += step)
        for (int x = 0; x < grid.count.x(); x += step) {
            const Eigen::Array2d middle = grid.min.array() + grid.side * Eigen::Array2d(x + 0.5, y + 0.5);
            Index chosen = -1;
            geometry::visit_cells(grid, middle, middle + (step - 1) * grid.side, [&](Index k) {
                if (chosen < 0) chosen = grid.order[std::size_t(k)];
            });
            if (chosen < 0) continue;
            const double squared = squared_distance_to_nearest(grid, points, chosen, step * grid.side);
            if (std::isfinite(squared)) nearest.push_back(std::sqrt(squared));
        }
    if (nearest.empty()) throw core::InputError("no surface: the points lie far apart, or all at one place");
    return {geometry::median(nearest), geometry::quantile(nearest, kSparseQuantile)};
}

HeightMap empty_map(const Eigen::AlignedBox2d& box, double cell)
{
    const Eigen::Vector2d sizes = box.sizes() / cell;
    if ((sizes.x() + 1) * (sizes.y() + 1) > kMaxCells)
        throw core::InputError("the points lie too far apart for a map of " + std::to_string(int(kMaxCells / 1e6)) +
                               " million cells: leave outliers out first (fettle-clean)");
    const int columns = int(std::lround(sizes.x())) + 1, rows = int(std::lround(sizes.y())) + 1;
    HeightMap map;
    map.z = Image(rows, columns, std::numeric_limits<float>::quiet_NaN());
    map.cell = cell;
    map.origin = box.min();
    return map;
}

/// Removes cells that lie far beneath the morphological closing of the heights.
void remove_hidden(HeightMap& map)
{
    constexpr float kUnseenHeight = std::numeric_limits<float>::lowest();
    Image upper = map.z.clone();
    upper.setTo(kUnseenHeight, ~finite(map.z));
    const cv::Mat square = cv::getStructuringElement(cv::MORPH_RECT, {2 * kHiddenReach + 1, 2 * kHiddenReach + 1});
    cv::morphologyEx(upper, upper, cv::MORPH_CLOSE, square); // cells beyond the map's edge have no effect
    map.z.setTo(std::numeric_limits<float>::quiet_NaN(), map.z < upper - kHiddenCells * float(map.cell));
}

/// Share of seen cells among the seen cells and the gaps between them.
/// @param radius  cells: gaps up to twice as wide count
double fill_share(const Image& z, int radius)
{
    const Mask seen = finite(z);
    return double(cv::countNonZero(seen)) / std::max(1, cv::countNonZero(closed(seen, radius)));
}

HeightMap map_of_points(const Eigen::Matrix3Xd& placed, const Eigen::AlignedBox2d& box, double cell)
{
    HeightMap map = empty_map(box, cell);
    const auto cell_of = [&](Index i) {
        const cv::Point c = map.cell_of(placed.col(i).head<2>());
        return std::size_t(std::clamp(c.y, 0, map.z.rows - 1)) * std::size_t(map.z.cols) +
               std::size_t(std::clamp(c.x, 0, map.z.cols - 1));
    };
    std::vector<std::uint32_t> cells(std::size_t(placed.cols()));
    tbb::parallel_for(Index{0}, placed.cols(), [&](Index i) { cells[std::size_t(i)] = std::uint32_t(cell_of(i)); });
    std::vector<std::uint32_t> begin(map.z.total() + 1, 0);
    for (const std::uint32_t cell : cells) ++begin[cell + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<float> heights(cells.size());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for (Index i = 0; i < placed.cols(); ++i) heights[next[cells[std::size_t(i)]]++] = float(placed(2, i));
    tbb::parallel_for(0, map.z.rows, [&](int y) {
        for (int x = 0; x < map.z.cols; ++x) {
            const std::size_t c = std::size_t(y) * std::size_t(map.z.cols) + std::size_t(x);
            const auto from = heights.begin() + begin[c], to = heights.begin() + begin[c + 1];
            if (from == to) continue;
            const float floor = *std::max_element(from, to) - float(kLayerCells * cell);
            const auto layer = std::partition(from, to, [&](float z) { return z < floor; });
            const auto middle = layer + (to - layer) / 2;
            std::nth_element(layer, middle, to);
            map.z(y, x) = *middle;
        }
    });
    return map;
}

/// Rasterizes a triangle: raises the heights of the cells whose centres it covers to its own.
void rasterize(HeightMap& map, const Eigen::Matrix3d& corners)
{
    const Eigen::Matrix2d edges =
        (Eigen::Matrix2d() << (corners.col(1) - corners.col(0)).head<2>(), (corners.col(2) - corners.col(0)).head<2>())
            .finished();
    const double area = edges.determinant();
    if (!(std::abs(area) > kMinTriangleArea * map.cell * map.cell)) return;
    const Eigen::Matrix2d inverse = edges.inverse();
    const Eigen::Vector2d low = (corners.topRows<2>().rowwise().minCoeff() - map.origin) / map.cell;
    const Eigen::Vector2d high = (corners.topRows<2>().rowwise().maxCoeff() - map.origin) / map.cell;
    for (int y = std::max(0, int(std::ceil(low.y()))); y <= std::min(map.z.rows - 1, int(high.y())); ++y)
        for (int x = std::max(0, int(std::ceil(low.x()))); x <= std::min(map.z.cols - 1, int(high.x())); ++x) {
            const Eigen::Vector2d weights = inverse * (map.point_at(x, y) - corners.col(0).head<2>());
            if (weights.minCoeff() < kMinBarycentric || weights.sum() > 1 - kMinBarycentric) continue;
            const auto z = float(corners(2, 0) + weights.x() * (corners(2, 1) - corners(2, 0)) +
                                 weights.y() * (corners(2, 2) - corners(2, 0)));
            if (!(map.z(y, x) >= z)) map.z(y, x) = z;
        }
}

HeightMap map_of_mesh(const mesh::CloudMesh& part, const Eigen::Matrix3Xd& placed)
{
    std::vector<double> edges;
    Eigen::AlignedBox2d box; // of the triangles, since unused vertices belong to no surface
    for (Index t = 0; t < part.triangles.cols(); ++t)
        for (int k = 0; k < 3; ++k) {
            const Eigen::Vector2d corner = placed.col(part.triangles(k, t)).head<2>();
            box.extend(corner);
            edges.push_back((corner - placed.col(part.triangles((k + 1) % 3, t)).head<2>()).norm());
        }
    const double diagonal = box.diagonal().norm();
    HeightMap map =
        empty_map(box, std::clamp(geometry::median(edges), diagonal / kMaxMeshCells, diagonal / kMinMeshCells));
    map.sigma = kMinMeshSigmaCells * map.cell;
    for (Index t = 0; t < part.triangles.cols(); ++t) {
        Eigen::Matrix3d corners;
        for (int k = 0; k < 3; ++k) corners.col(k) = placed.col(part.triangles(k, t));
        const Eigen::Vector3d normal = (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0));
        if (normal.z() > kMinFacing * normal.norm()) rasterize(map, corners);
    }
    return map;
}

} // namespace

HeightMap height_map(const mesh::CloudMesh& part, const View& view)
{
    Eigen::Matrix3Xd placed(3, part.points.size());
    using Range = tbb::blocked_range<Index>;
    tbb::parallel_for(Range(0, placed.cols(), kGrainSize), [&](const Range& range) {
        placed.middleCols(range.begin(), Index(range.size())) =
            view * part.points.xyz.middleCols(range.begin(), Index(range.size()));
    });
    if (!part.is_mesh()) {
        const Eigen::VectorXd facing =
            cloud::has_normals(part.points)
                ? Eigen::VectorXd((view.linear().row(2) * cloud::normals(part.points)).transpose())
                : Eigen::VectorXd::Ones(placed.cols());
        Index count = 0;
        for (Index i = 0; i < placed.cols(); ++i)
            if (placed.col(i).allFinite() && facing[i] > kMinFacing) placed.col(count++) = placed.col(i).eval();
        placed.conservativeResize(Eigen::NoChange, count);
    }
    if (placed.cols() == 0) throw core::InputError("no point is finite");
    if (!part.is_mesh() && double(placed.cols()) > kMaxCells)
        throw core::InputError(std::to_string(placed.cols()) + " points are more than a map of " +
                               std::to_string(int(kMaxCells / 1e6)) +
                               " million cells shows: thin them first (fettle-clean --thin)");
    if (part.is_mesh()) return map_of_mesh(part, placed);
    const Eigen::AlignedBox2d box(placed.topRows<2>().rowwise().minCoeff(), placed.topRows<2>().rowwise().maxCoeff());
    const Spacing spacing = spacing_of(placed.topRows<2>());
    for (double cell = spacing.median;; cell *= kCellRatio) {
        HeightMap map = map_of_points(placed, box, cell);
        remove_hidden(map);
        const int radius = std::clamp(int(std::ceil(spacing.sparse / cell)), kMinFillRadius, kMaxFillRadius);
        if (fill_share(map.z, radius) >= kMinFill) return map;
    }
}

} // namespace fettle::find
