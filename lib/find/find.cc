#include "find/find.h"

#include "find/description.h"
#include "find/doubtful.h"
#include "find/refinement.h"

#include "core/error.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <optional>

namespace fettle::find {
namespace {

using Eigen::Index;

// If two finds share more than this of either's points, the one with the higher rank is kept.
constexpr double kMaxOverlap = 0.1;

// A find is part of another that has so much of its points, and is hardly less probable.
constexpr double kMinContained = 0.9, kMaxRankDifference = 0.05;

/// A find of a side, described in the part.
struct Entry {
    const Verified* find;
    const SeenSide* side;
    FoundAnomaly found;
    bool is_part = false; ///< of another find
};

/// How well a side shows a find. Against a reference nearly all finds are probable, and the enclosure decides: a side
/// that shows only half of an anomaly has an edge around that half.
double rank_in_part(const Entry& entry)
{
    const double probability = entry.find->probability;
    return entry.side->is_along_normal ? probability * entry.find->evidence.enclosure : probability;
}

/// Leaves out finds whose region was still growing when the steps ended, inside another that has converged: a part of
/// an anomaly may be as probable as the whole.
void leave_out_parts(std::vector<Entry>& entries, Index points)
{
    for (const Entry& whole : entries) {
        if (!whole.find->is_converged) continue;
        std::vector<bool> is_in_whole(std::size_t(points), false);
        for (const Index i : whole.found.points) is_in_whole[std::size_t(i)] = true;
        for (Entry& entry : entries) {
            const auto shared =
                std::ranges::count_if(entry.found.points, [&](Index i) { return bool(is_in_whole[std::size_t(i)]); });
            entry.is_part |= !entry.find->is_converged &&
                             rank_in_part(entry) - rank_in_part(whole) < kMaxRankDifference &&
                             double(shared) >= kMinContained * double(entry.found.points.size());
        }
    }
    std::erase_if(entries, [](const Entry& entry) { return entry.is_part; });
}

/// Selects finds by descending rank, without those that share points with a selected one. @return  most probable first
std::vector<Entry> without_overlaps(std::vector<Entry> entries, Index points)
{
    std::ranges::stable_sort(entries, std::greater{}, rank_in_part);
    std::vector<int> selected_by(std::size_t(points), -1);
    std::vector<Entry> selected;
    for (Entry& entry : entries) {
        const auto size = double(entry.found.points.size());
        std::vector<double> shared(selected.size(), 0);
        double sum = 0;
        for (const Index i : entry.found.points)
            if (const int by = selected_by[std::size_t(i)]; by >= 0) ++shared[std::size_t(by)], ++sum;
        bool is_distinct = size > 0 && sum <= kMaxOverlap * size;
        for (std::size_t k = 0; k < selected.size(); ++k)
            is_distinct &= shared[k] <= kMaxOverlap * double(selected[k].found.points.size());
        if (!is_distinct) continue;
        for (const Index i : entry.found.points) selected_by[std::size_t(i)] = int(selected.size());
        selected.push_back(std::move(entry));
    }
    std::ranges::stable_sort(selected, std::greater{}, [](const Entry& e) { return e.found.probability; });
    return selected;
}

void set_all_outlines(std::vector<Entry>& entries)
{
    tbb::parallel_for(std::size_t{0}, entries.size(), [&](std::size_t i) {
        Entry& entry = entries[i];
        Mask others(entry.side->surface.z.size(), 0);
        for (const Entry& other : entries)
            if (other.side == entry.side && &other != &entry) {
                Mask window = others(other.find->window);
                window |= other.find->with_rim;
            }
        set_outlines(entry.found, *entry.side, *entry.find, others);
    });
}

void search(SeenSide& side, const FindOptions& options)
{
    side.finds = verify_all(side.searched, find_candidates(side.searched, options.bounds), options.bounds);
    if (side.is_along_normal)
        for (Verified& find : side.finds) find.probability = probability_against(find.evidence);
    else
        set_probabilities(side.finds);
    std::erase_if(side.finds, [&](const Verified& find) {
        return find.probability < options.min_probability && find.probability_by_evidence < options.min_by_evidence;
    });
}

/// @param min_height  along the normal of the surface beneath: a view overstates heights on walls
FindResult merge(const mesh::CloudMesh& part, const std::vector<SeenSide>& sides, double min_height)
{
    std::vector<Entry> entries;
    for (const SeenSide& side : sides) {
        if (side.finds.empty()) continue;
        const CellPoints cells = points_by_cell(part, side);
        const std::size_t first = entries.size();
        for (const Verified& find : side.finds) entries.push_back({&find, &side, {}});
        tbb::parallel_for(first, entries.size(),
                          [&](std::size_t i) { entries[i].found = describe(part, side, cells, *entries[i].find); });
    }
    std::erase_if(entries, [&](const Entry& entry) { return entry.found.height < min_height; });
    leave_out_parts(entries, part.points.size());
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

// Cells across. A narrower surface is a line, without metal around an anomaly.
constexpr double kMinSurfaceWidth = 3;

/// @throws InputError if no side of a cloud shows a surface
void check_surface(const std::vector<SeenSide>& sides)
{
    double width = 0;
    for (const SeenSide& side : sides) width = std::max(width, thickness_of(side.surface.seen));
    if (width <= kMinSurfaceWidth)
        throw core::InputError("no surface: its points lie on lines, as those of a single profile, or are too few");
}

/// The place of a cell in the part: of a cloud the point whose height the cell has, of a mesh its surface at the cell's
/// middle; nothing where rounding has put the only point beside the cell.
std::optional<Eigen::Vector3d> place_of(const mesh::CloudMesh& part, const SeenSide& side, const CellPoints& points,
                                        const cv::Point& cell)
{
    const Eigen::Vector2d middle = side.surface.point_at(cell.x, cell.y);
    const Eigen::Vector3d place(middle.x(), middle.y(), side.surface.z(cell));
    if (part.is_mesh()) return side.view.inverse() * place;
    double best = std::numeric_limits<double>::infinity();
    std::optional<Eigen::Vector3d> nearest;
    for (Index i = points.first(cell); i >= 0; i = points.next[std::size_t(i)]) {
        const Eigen::Vector3d point = part.points.xyz.col(i);
        if (const double off = std::abs((side.view * point).z() - place.z()); off < best) best = off, nearest = point;
    }
    return nearest;
}

/// Signed distances of what a side shows, as a map.
/// @param measured  the side's map before it was cleaned
HeightMap distance_map(const mesh::CloudMesh& part, const SeenSide& side, const HeightMap& measured,
                       const SignedDistances& distances)
{
    const HeightMap& map = side.surface;
    std::vector<cv::Point> seen, cells;
    cv::findNonZero(map.seen & (map.z == measured.z), seen); // what was filled from cells around lies beside the part
    const CellPoints points = part.is_mesh() ? CellPoints() : points_by_cell(part, side);
    Eigen::Matrix3Xd places(3, Index(seen.size()));
    for (const cv::Point& cell : seen)
        if (const auto place = place_of(part, side, points, cell)) {
            places.col(Index(cells.size())) = *place;
            cells.push_back(cell);
        }
    const Eigen::VectorXd errors = distances(places.leftCols(Index(cells.size())));
    // Distances from a reference that is the part itself have no noise, but are no surer than the part's surface.
    HeightMap result{
        Image(map.z.size(), std::numeric_limits<float>::quiet_NaN()), map.cell, map.origin, {}, measured.sigma};
    for (std::size_t k = 0; k < cells.size(); ++k) result.z(cells[k]) = float(errors[Index(k)]);
    return result;
}

} // namespace

FindResult find_anomalies(const mesh::CloudMesh& part, const FindOptions& options)
{
    std::vector<SeenSide> sides;
    for (const View& view : choose_views(part)) {
        SeenSide side{view, height_map(part, view), {}, false, {}};
        clean(side.surface, !part.is_mesh());
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
        const HeightMap measured = height_map(part, view);
        SeenSide side{view, measured, {}, true, {}};
        clean(side.surface, !part.is_mesh());
        side.searched = distance_map(part, side, measured, distances);
        if (cv::countNonZero(finite(side.searched.z)) == 0) continue;
        is_defined = true;
        clean(side.searched, !part.is_mesh());
        search(side, options);
        sides.push_back(std::move(side));
    }
    if (!is_defined) throw core::InputError("the distances of all points from the reference are undefined");
    return merge(part, sides, options.bounds.min_height);
}

} // namespace fettle::find
