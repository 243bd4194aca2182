#include "find/find.h"

#include "find/description.h"
#include "find/refinement.h"

#include "core/error.h"

#include <algorithm>

namespace fettle::find {
namespace {

using Eigen::Index;

// If two finds share more than this of either's points, the more probable one is kept.
constexpr double kMaxOverlap = 0.1;

/// A find of a side, and what it is of the part.
struct Entry {
    const Verified* find;
    const SeenSide* side;
    FoundAnomaly found;
};

/// Takes finds by falling probability, without those that share points with one taken before.
std::vector<Entry> without_overlaps(std::vector<Entry> entries, Index points)
{
    std::ranges::stable_sort(entries, std::greater{}, [](const Entry& e) { return e.found.probability; });
    std::vector<int> taken_by(std::size_t(points), -1);
    std::vector<Entry> taken;
    for (Entry& entry : entries) {
        const auto size = double(entry.found.points.size());
        std::vector<double> shared(taken.size(), 0);
        double sum = 0;
        for (const Index i : entry.found.points)
            if (const int by = taken_by[std::size_t(i)]; by >= 0) ++shared[std::size_t(by)], ++sum;
        bool is_free = size > 0 && sum <= kMaxOverlap * size;
        for (std::size_t k = 0; k < taken.size(); ++k)
            is_free &= shared[k] <= kMaxOverlap * double(taken[k].found.points.size());
        if (!is_free) continue;
        for (const Index i : entry.found.points) taken_by[std::size_t(i)] = int(taken.size());
        taken.push_back(std::move(entry));
    }
    return taken;
}

void set_all_outlines(std::vector<Entry>& entries)
{
    for (Entry& entry : entries) {
        Mask others(entry.side->surface.z.size(), 0);
        for (const Entry& other : entries)
            if (other.side == entry.side && &other != &entry) {
                Mask window = others(other.find->window);
                window |= other.find->with_rim;
            }
        set_outlines(entry.found, *entry.side, *entry.find, others);
    }
}

void search(SeenSide& side, const FindOptions& options)
{
    side.finds = verify_all(side.searched, find_candidates(side.searched, options.bounds), options.bounds);
    if (side.is_along_normal)
        for (Verified& find : side.finds) find.probability = probability_against(find.evidence);
    std::erase_if(side.finds, [&](const Verified& find) { return find.probability < options.min_probability; });
}

/// @param min_height  along the normal of the surface beneath: a view overstates heights on walls
FindResult merge(const mesh::CloudMesh& part, const std::vector<SeenSide>& sides, double min_height)
{
    std::vector<Entry> entries;
    for (const SeenSide& side : sides) {
        if (side.finds.empty()) continue;
        const CellPoints cells = points_by_cell(part, side);
        for (const Verified& find : side.finds) entries.push_back({&find, &side, describe(part, side, cells, find)});
    }
    std::erase_if(entries, [&](const Entry& entry) { return entry.found.height < min_height; });
    entries = without_overlaps(std::move(entries), part.points.size());
    set_all_outlines(entries);
    FindResult result;
    result.noise = sides.front().searched.sigma;
    for (Entry& entry : entries) {
        entry.found.number = int(result.anomalies.size()) + 1;
        result.anomalies.push_back(std::move(entry.found));
    }
    return result;
}

// Cells across: less is a line, and has no metal around an anomaly.
constexpr double kMinSurfaceWidth = 3;

/// @throws InputError if no side of a cloud shows a surface
void check_surface(const std::vector<SeenSide>& sides)
{
    double width = 0;
    for (const SeenSide& side : sides) width = std::max(width, thickness_of(side.surface.seen));
    if (width <= kMinSurfaceWidth)
        throw core::InputError("no surface: its points lie on lines, as those of a single profile, or are too few");
}

/// The places of a side's cells in the part: of a cloud the point whose height the cell has, of a mesh its surface at
/// the cell's middle. Cells of a cloud that were filled from those around have none.
std::pair<std::vector<cv::Point>, Eigen::Matrix3Xd> places_of(const mesh::CloudMesh& part, const SeenSide& side)
{
    const HeightMap& map = side.surface;
    std::vector<cv::Point> seen, cells;
    cv::findNonZero(map.seen, seen);
    const CellPoints points = part.is_mesh() ? CellPoints() : points_by_cell(part, side);
    const Eigen::RowVector3d up = side.view.linear().row(2);
    Eigen::Matrix3Xd places(3, Index(seen.size()));
    for (const cv::Point& cell : seen) {
        if (part.is_mesh()) {
            const Eigen::Vector2d place = map.point_at(cell.x, cell.y);
            places.col(Index(cells.size())) = side.view.inverse() * Eigen::Vector3d(place.x(), place.y(), map.z(cell));
            cells.push_back(cell);
            continue;
        }
        const double height = map.z(cell) - side.view.translation().z();
        const auto error_of = [&](Index i) { return std::abs(up.dot(part.points.xyz.col(i)) - height); };
        Index nearest = points.first(cell);
        if (nearest < 0) continue;
        for (Index i = nearest; i >= 0; i = points.next[std::size_t(i)])
            if (error_of(i) < error_of(nearest)) nearest = i;
        places.col(Index(cells.size())) = part.points.xyz.col(nearest);
        cells.push_back(cell);
    }
    places.conservativeResize(Eigen::NoChange, Index(cells.size()));
    return {cells, places};
}

/// Signed distances of what a side shows, as a map.
HeightMap distance_map(const mesh::CloudMesh& part, const SeenSide& side, const SignedDistances& distances)
{
    const HeightMap& map = side.surface;
    const auto [cells, places] = places_of(part, side);
    const Eigen::VectorXd errors = distances(places);
    HeightMap result{Image(map.z.size(), std::numeric_limits<float>::quiet_NaN()), map.cell, map.origin, {}, 0};
    for (std::size_t k = 0; k < cells.size(); ++k) result.z(cells[k]) = float(errors[Index(k)]);
    return result;
}

} // namespace

FindResult find_anomalies(const mesh::CloudMesh& part, const FindOptions& options)
{
    std::vector<SeenSide> sides;
    for (const View& view : choose_views(part)) {
        SeenSide side{view, height_map(part, view), {}, false, {}};
        clean(side.surface);
        side.searched = side.surface;
        sides.push_back(std::move(side));
    }
    if (!part.is_mesh()) check_surface(sides);
    for (SeenSide& side : sides) search(side, options);
    return merge(part, sides, options.bounds.min_height);
}

FindResult find_anomalies_against(const mesh::CloudMesh& part, const SignedDistances& distances,
                                  const FindOptions& options)
{
    std::vector<SeenSide> sides;
    bool is_defined = false;
    for (const View& view : choose_views(part)) {
        SeenSide side{view, height_map(part, view), {}, true, {}};
        clean(side.surface);
        side.searched = distance_map(part, side, distances);
        if (cv::countNonZero(finite(side.searched.z)) == 0) continue;
        is_defined = true;
        clean(side.searched);
        search(side, options);
        sides.push_back(std::move(side));
    }
    if (!is_defined) throw core::InputError("the distances of all points from the reference are undefined");
    return merge(part, sides, options.bounds.min_height);
}

} // namespace fettle::find
