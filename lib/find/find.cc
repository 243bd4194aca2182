#include "find/find.h"

#include "find/outline.h"
#include "find/verification.h"
#include "find/view.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace fettle::find {
namespace {

using Eigen::Index;

// Of two finds that share more than this of either's points, the more probable one stays.
constexpr double kMaxOverlap = 0.1;
constexpr double kMinProbability = 0.5;

// A point belongs to the map's surface if it lies no farther off it than this.
constexpr double kSurfaceSigmas = 8, kSurfaceCells = 2;

/// Finds of one view.
struct ViewFinds {
    View view;
    HeightMap map;
    std::vector<Verified> finds;
};

/// Points of the part that lie on the map's surface, by cell.
struct CellPoints {
    cv::Mat1i first;           ///< point of a cell, -1: none
    std::vector<Index> next;   ///< point of the same cell after each, -1: none
};

CellPoints points_by_cell(const mesh::CloudMesh& part, const ViewFinds& view)
{
    const Index count = part.points.size();
    CellPoints cells{cv::Mat1i(view.map.z.size(), -1), std::vector<Index>(std::size_t(count), -1)};
    const cv::Rect all({0, 0}, view.map.z.size());
    for (Index i = count; i-- > 0;) {
        if (!part.points.xyz.col(i).allFinite()) continue;
        const Eigen::Vector3d p = view.view * Eigen::Vector3d(part.points.xyz.col(i));
        const cv::Point cell = view.map.cell_of(p.head<2>());
        if (!all.contains(cell)) continue;
        const double off = std::abs(p.z() - view.map.z(cell));
        if (!(off <= kSurfaceSigmas * view.map.sigma + kSurfaceCells * view.map.cell)) continue;
        cells.next[std::size_t(i)] = cells.first(cell);
        cells.first(cell) = int(i);
    }
    return cells;
}

/// Upward normal of the surface beneath a region, from its mean slope.
Eigen::Vector3d normal_beneath(const HeightMap& map, const Verified& find)
{
    double dx = 0, dy = 0, count_x = 0, count_y = 0;
    const Image beneath = map.z(find.window) - find.height;
    for (int y = 0; y < beneath.rows; ++y)
        for (int x = 0; x < beneath.cols; ++x) {
            if (!find.mask(y, x)) continue;
            if (x > 0 && std::isfinite(beneath(y, x) - beneath(y, x - 1)))
                dx += beneath(y, x) - beneath(y, x - 1), ++count_x;
            if (y > 0 && std::isfinite(beneath(y, x) - beneath(y - 1, x)))
                dy += beneath(y, x) - beneath(y - 1, x), ++count_y;
        }
    return Eigen::Vector3d(-dx / std::max(1.0, count_x), -dy / std::max(1.0, count_y), map.cell).normalized();
}

FoundAnomaly describe(const ViewFinds& view, const CellPoints& cells, const Verified& find)
{
    const HeightMap& map = view.map;
    const Eigen::Vector3d up = normal_beneath(map, find);
    FoundAnomaly found;
    found.probability = find.probability;
    found.significance = find.evidence.significance();
    found.T_view_part = view.view;
    found.cell = map.cell;
    std::vector<std::pair<Index, double>> points;
    double sum = 0;
    for (int y = 0; y < find.mask.rows; ++y)
        for (int x = 0; x < find.mask.cols; ++x) {
            if (!find.mask(y, x)) continue;
            const double height = find.height(y, x);
            if (std::isfinite(height)) sum += height, found.height = std::max(found.height, height * up.z());
            for (Index i = cells.first(y + find.window.y, x + find.window.x); i >= 0; i = cells.next[std::size_t(i)])
                points.emplace_back(i, std::isfinite(height) ? height * up.z() : 0);
        }
    found.area = find.evidence.cells * map.cell * map.cell / up.z();
    found.volume = sum * map.cell * map.cell;
    std::ranges::sort(points);
    found.heights.resize(Index(points.size()));
    for (const auto& [index, height] : points) {
        found.heights[Index(found.points.size())] = height;
        found.points.push_back(index);
    }
    return found;
}

/// A find of a view, and what it is of the part.
struct Entry {
    const Verified* find;
    std::size_t view;
    FoundAnomaly found;
};

/// Takes finds by falling probability, without those that share points with one taken before.
std::vector<Entry> without_overlaps(std::vector<Entry> entries, Index points)
{
    std::ranges::stable_sort(entries, std::greater{}, [](const Entry& e) { return e.found.probability; });
    std::vector<int> taken_by(std::size_t(points), -1);
    std::vector<Entry> taken;
    for (Entry& entry : entries) {
        std::vector<std::size_t> shared(taken.size(), 0);
        std::size_t sum = 0;
        for (const Index i : entry.found.points)
            if (const int by = taken_by[std::size_t(i)]; by >= 0) ++shared[std::size_t(by)], ++sum;
        bool is_free = double(sum) <= kMaxOverlap * double(entry.found.points.size()) && !entry.found.points.empty();
        for (std::size_t k = 0; k < taken.size(); ++k)
            is_free &= double(shared[k]) <= kMaxOverlap * double(taken[k].found.points.size());
        if (!is_free) continue;
        for (const Index i : entry.found.points) taken_by[std::size_t(i)] = int(taken.size());
        taken.push_back(std::move(entry));
    }
    return taken;
}

void set_outlines(std::vector<Entry>& entries, const std::vector<ViewFinds>& views)
{
    for (std::size_t v = 0; v < views.size(); ++v) {
        const HeightMap& map = views[v].map;
        Mask all(map.z.size(), 0);
        for (const Entry& entry : entries)
            if (entry.view == v) all(entry.find->window) |= entry.find->mask;
        for (Entry& entry : entries) {
            if (entry.view != v) continue;
            Mask region(map.z.size(), 0);
            entry.find->mask.copyTo(region(entry.find->window));
            const Outlines outlines = outlines_of(map, region, all & ~region, entry.find->growth);
            entry.found.boundary = (map.cell * outlines.boundary).colwise() + map.origin;
            entry.found.sampling = (map.cell * outlines.sampling).colwise() + map.origin;
        }
    }
}

} // namespace

FindResult find_anomalies(const mesh::CloudMesh& part, const SearchBounds& bounds)
{
    std::vector<ViewFinds> views;
    std::vector<Entry> entries;
    for (const View& view : choose_views(part)) {
        ViewFinds finds{view, height_map(part, view), {}};
        clean(finds.map);
        finds.finds = verify_all(finds.map, find_candidates(finds.map, bounds), bounds);
        std::erase_if(finds.finds, [](const Verified& find) { return find.probability < kMinProbability; });
        views.push_back(std::move(finds));
    }
    FindResult result;
    for (std::size_t v = 0; v < views.size(); ++v) {
        const CellPoints cells = points_by_cell(part, views[v]);
        for (const Verified& find : views[v].finds) entries.push_back({&find, v, describe(views[v], cells, find)});
    }
    result.noise = views.front().map.sigma;
    entries = without_overlaps(std::move(entries), part.points.size());
    set_outlines(entries, views);
    for (Entry& entry : entries) result.anomalies.push_back(std::move(entry.found));
    return result;
}

mesh::CloudMesh labelled(mesh::CloudMesh part, const FindResult& result)
{
    Eigen::VectorXd anomaly = Eigen::VectorXd::Zero(part.points.size()), height = anomaly;
    for (std::size_t k = 0; k < result.anomalies.size(); ++k) {
        const FoundAnomaly& found = result.anomalies[k];
        for (std::size_t i = 0; i < found.points.size(); ++i) {
            anomaly[found.points[i]] = double(k + 1);
            height[found.points[i]] = found.heights[Index(i)];
        }
    }
    cloud::set_field(part.points, "anomaly", anomaly);
    cloud::set_field(part.points, "height", height);
    return part;
}

} // namespace fettle::find
