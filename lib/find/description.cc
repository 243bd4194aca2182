#include "find/description.h"

#include "core/direction.h"
#include "core/text.h"
#include "find/design.h"
#include "find/outline.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace fettle::find {
namespace {

using Eigen::Index;

// A point belongs to the map's surface if it lies no farther off it than this.
constexpr double kSurfaceSigmas = 8, kSurfaceCells = 2;

// Walls and feet are narrower than a cell. Points of a region's cells and of the cells beside it therefore belong to
// the region, too, if their own height exceeds so many standard deviations of the noise and this share of the region's
// height.
constexpr double kOwnSigmas = 3, kOwnShare = 0.08;

// Below this probability a person checks a find.
constexpr double kSureProbability = 0.96;
// The surface beneath a region thicker than this multiple of its ring is an extrapolation.
constexpr double kMaxThicknessPerRing = 2.5;
// A region enclosed by a smaller share of metal is at an edge of the part or of the scan, or beside another feature.
constexpr double kMinSureEnclosure = 0.6;
// Upper bound for regions shaped as a boss: nothing on the part distinguishes a boss by design from such an anomaly.
constexpr double kMaxBossProbability = 0.9;

/// Heights of the surface beneath, in the view.
Image beneath(const SeenSide& side, const Verified& find)
{
    if (side.is_along_normal) return side.surface.z(find.window);
    return side.surface.z(find.window) - find.height;
}

/// Upward normal of the surface beneath a region in the view, from its mean slope.
Eigen::Vector3d normal_beneath(const SeenSide& side, const Verified& find)
{
    double dx = 0, dy = 0, count_x = 0, count_y = 0;
    const Image z = beneath(side, find);
    for (int y = 0; y < z.rows; ++y)
        for (int x = 0; x < z.cols; ++x) {
            if (!find.mask(y, x)) continue;
            if (x > 0 && std::isfinite(z(y, x) - z(y, x - 1))) dx += z(y, x) - z(y, x - 1), ++count_x;
            if (y > 0 && std::isfinite(z(y, x) - z(y - 1, x))) dy += z(y, x) - z(y - 1, x), ++count_y;
        }
    return Eigen::Vector3d(-dx / std::max(1.0, count_x), -dy / std::max(1.0, count_y), side.surface.cell).normalized();
}

/// The middle of the surface beneath a region, in the view, mm.
Eigen::Vector3d middle_beneath(const SeenSide& side, const Verified& find)
{
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0;
    const Image z = beneath(side, find);
    for (int y = 0; y < z.rows; ++y)
        for (int x = 0; x < z.cols; ++x)
            if (find.mask(y, x) && std::isfinite(z(y, x))) {
                const Eigen::Vector2d place = side.surface.point_at(x + find.window.x, y + find.window.y);
                sum += Eigen::Vector3d(place.x(), place.y(), z(y, x));
                ++count;
            }
    return sum / std::max(1.0, count);
}

std::string doubts_of(const Verified& find, bool is_boss)
{
    const Evidence& e = find.evidence;
    std::vector<std::string> doubts;
    if (!is_boss && find.probability < kSureProbability) doubts.push_back("it may be a feature of the part");
    if (e.enclosure < kMinSureEnclosure) doubts.push_back("it stands at an edge, or beside another feature");
    if (e.thickness > kMaxThicknessPerRing * e.ring_width)
        doubts.push_back("it is wider than the good metal around it");
    if (find.has_crease) doubts.push_back("a crease of the part runs beneath it");
    if (is_boss) doubts.push_back("with its flat top and regular outline it may be a boss by design");
    if (find.alike > 0) doubts.push_back("others of its height and size stand beside it, as in a pattern by design");
    return core::join(doubts, "; ");
}

} // namespace

CellPoints points_by_cell(const mesh::CloudMesh& part, const SeenSide& side)
{
    const HeightMap& map = side.surface;
    const Index count = part.points.size();
    CellPoints cells{cv::Mat1i(map.z.size(), -1), std::vector<Index>(std::size_t(count), -1)};
    const cv::Rect all({0, 0}, map.z.size());
    const cv::Point beside(-1, -1);
    std::vector<cv::Point> places(std::size_t(count), beside);
    tbb::parallel_for(Index{0}, count, [&](Index i) {
        if (!part.points.xyz.col(i).allFinite()) return;
        const Eigen::Vector3d p = side.view * Eigen::Vector3d(part.points.xyz.col(i));
        if (const cv::Point cell = map.cell_of(p.head<2>()); all.contains(cell)) places[std::size_t(i)] = cell;
    });
    for (Index i = count; i-- > 0;) {
        const cv::Point cell = places[std::size_t(i)];
        if (cell == beside) continue;
        cells.next[std::size_t(i)] = cells.first(cell);
        cells.first(cell) = int(i);
    }
    return cells;
}

std::vector<Index> CellPoints::in(const cv::Point& cell) const
{
    std::vector<Index> points;
    if (cv::Rect({0, 0}, first.size()).contains(cell))
        for (Index i = first(cell); i >= 0; i = next[std::size_t(i)]) points.push_back(i);
    return points;
}

namespace {

/// Points of a region with their heights over the surface beneath: points of its cells that lie on the map's surface
/// and not at the foot of a wall, and points of its cells and the cells beside them whose own height exceeds a limit.
std::vector<std::pair<Index, double>> points_of(const mesh::CloudMesh& part, const SeenSide& side,
                                                const CellPoints& cells, const Verified& find,
                                                const Eigen::Vector3d& up)
{
    const HeightMap& map = side.surface;
    const double tolerance = kSurfaceSigmas * map.sigma + kSurfaceCells * map.cell;
    const double own_limit = std::max(kOwnSigmas * map.sigma, kOwnShare * find.evidence.height);
    // Distances from a reference are known for cells, not for points.
    const Mask near = side.is_along_normal ? find.mask : dilated(find.mask, 1);
    const Image floor = filled(beneath(side, find));
    std::vector<std::pair<Index, double>> points;
    for (int y = 0; y < near.rows; ++y)
        for (int x = 0; x < near.cols; ++x) {
            if (!near(y, x)) continue;
            const cv::Point cell(x + find.window.x, y + find.window.y);
            const Eigen::Vector2d place = map.point_at(cell.x, cell.y);
            const Eigen::Vector3d foot(place.x(), place.y(), floor(y, x));
            const double height = std::isfinite(find.height(y, x)) ? find.height(y, x) : 0;
            for (const Index i : cells.in(cell)) {
                const Eigen::Vector3d p = side.view * Eigen::Vector3d(part.points.xyz.col(i));
                const double own = up.dot(p - foot) / up.z();
                const bool is_on_map = std::abs(p.z() - map.z(cell)) <= tolerance;
                const bool is_above = !side.is_along_normal && own > own_limit && own < 2 * find.evidence.height;
                // A cell at a wall has points at the wall's foot, which belong to the metal around.
                const bool is_at_foot = !side.is_along_normal && own < own_limit &&
                                        own < std::min(height / 2, height - kOwnSigmas * map.sigma);
                if (find.mask(y, x) && is_on_map && !is_at_foot)
                    points.emplace_back(i, (side.is_along_normal ? 1 : up.z()) * height);
                else if (is_above)
                    points.emplace_back(i, up.z() * own);
            }
        }
    return points;
}

} // namespace

FoundAnomaly describe(const mesh::CloudMesh& part, const SeenSide& side, const CellPoints& cells, const Verified& find)
{
    const Eigen::Vector3d up = normal_beneath(side, find);
    const double along_normal = side.is_along_normal ? 1 : up.z();
    const double cell_area = side.surface.cell * side.surface.cell / up.z();
    FoundAnomaly found;
    const bool is_boss = looks_designed(find);
    found.probability =
        is_boss && !side.is_along_normal ? std::min(find.probability, kMaxBossProbability) : find.probability;
    found.score = find.score;
    found.doubtful_others = find.doubtful_others;
    found.significance = find.evidence.significance();
    found.doubt = doubts_of(find, is_boss);
    found.cell = side.surface.cell;
    found.T_anomaly_part = core::rotation_between(side.view.linear().transpose() * up, Eigen::Vector3d::UnitZ());
    found.T_anomaly_part.pretranslate(-(found.T_anomaly_part * (side.view.inverse() * middle_beneath(side, find))));
    std::vector<std::pair<Index, double>> points = points_of(part, side, cells, find, up);
    double sum = 0;
    for (int y = 0; y < find.mask.rows; ++y)
        for (int x = 0; x < find.mask.cols; ++x) {
            if (!find.mask(y, x)) continue;
            const double height = std::isfinite(find.height(y, x)) ? along_normal * find.height(y, x) : 0;
            sum += height;
            found.height = std::max(found.height, height);
        }
    found.area = find.evidence.cells * cell_area;
    found.volume = sum * cell_area;
    std::ranges::sort(points);
    found.heights.resize(Index(points.size()));
    for (const auto& [index, height] : points) {
        found.heights[Index(found.points.size())] = height;
        found.points.push_back(index);
    }
    return found;
}

void set_outlines(FoundAnomaly& anomaly, const SeenSide& side, const Verified& find, const Mask& others)
{
    const HeightMap map = coarsened(side.surface, find.factor);
    Mask all(side.surface.z.size(), 0);
    find.with_rim.copyTo(all(find.window));
    const Mask region = coarsened(all, find.factor);
    const Outlines outlines = outlines_of(map, region, coarsened(others, find.factor) & ~region, find.growth);
    const Eigen::Isometry3d T_anomaly_view = anomaly.T_anomaly_part * side.view.inverse();
    // The plane through the anomaly's origin, whose normal is the surface's: n · (p - p0) = 0.
    const Eigen::Vector3d n = T_anomaly_view.linear().row(2), p0 = T_anomaly_view.inverse().translation();
    const auto to_frame = [&](const Eigen::Matrix2Xd& cells) {
        Eigen::Matrix2Xd polygon(2, cells.cols());
        for (Index k = 0; k < cells.cols(); ++k) {
            Eigen::Vector3d p;
            p.head<2>() = map.point_at(cells(0, k), cells(1, k));
            p.z() = p0.z() - n.head<2>().dot(p.head<2>() - p0.head<2>()) / n.z();
            polygon.col(k) = (T_anomaly_view * p).head<2>();
        }
        return polygon;
    };
    anomaly.boundary = to_frame(outlines.boundary);
    anomaly.sampling = to_frame(outlines.sampling);
}

} // namespace fettle::find
