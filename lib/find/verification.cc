#include "find/verification.h"

#include "find/refinement.h"

#include <opencv2/imgproc.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

namespace fettle::find {
namespace {

/// Resamples the mask of a coarsened map to the cells of the full map.
Mask magnified(const Mask& mask, int factor, const cv::Size& size)
{
    Mask large;
    cv::resize(mask, large, {}, factor, factor, cv::INTER_NEAREST);
    return large(cv::Rect({0, 0}, size)).clone();
}

/// A candidate that was verified in a coarsened map, with window, heights and evidence in the cells of the full map.
/// @param surface  the surface beneath, in the coarse window
Verified in_full_resolution(const HeightMap& map, Verified coarse, const Image& surface, int factor)
{
    const cv::Rect box(factor * coarse.window.tl(),
                       cv::Size(factor * coarse.window.width, factor * coarse.window.height));
    Verified fine = std::move(coarse);
    fine.window = box & cv::Rect({0, 0}, map.z.size());
    fine.mask = magnified(fine.mask, factor, fine.window.size()) & map.seen(fine.window);
    fine.with_rim = magnified(fine.with_rim, factor, fine.window.size());
    fine.height = map.z(fine.window) - refined(surface, factor, fine.window.size());
    fine.factor = factor;
    Evidence& e = fine.evidence;
    e.cell = map.cell;
    e.cells *= factor * factor;
    e.thickness *= factor;
    e.ring_width *= factor;
    return fine;
}

// The cells in which a candidate is verified are doubled as long as it remains at least so many of them thick. Long
// candidates, which need a large window, may become thinner.
constexpr double kMinCoarseThickness = 40, kMinLongThickness = 12;
constexpr double kMaxExtent = 300; // cells: candidates above it are long

/// A level of the pyramid of maps: its cells are twice as long as those of the level before.
struct Level {
    HeightMap map;
    Mask others; ///< cells of all candidates
};

/// Level of the pyramid at which a candidate is verified.
/// @param box  bounds of its cells   @param thickness  cells
int level_of(const cv::Rect& box, double thickness)
{
    double extent = std::max(box.width, box.height);
    int level = 0;
    while (thickness >= 2 * (extent > kMaxExtent ? kMinLongThickness : kMinCoarseThickness))
        thickness /= 2, extent /= 2, ++level;
    return level;
}

/// A candidate in cells `factor` times as long.
Candidate coarsened_candidate(const Candidate& candidate, int factor, const cv::Size& size)
{
    if (factor == 1) return candidate;
    const cv::Point corner(candidate.box.x / factor, candidate.box.y / factor);
    Mask aligned;
    cv::copyMakeBorder(candidate.mask, aligned, candidate.box.y % factor, 0, candidate.box.x % factor, 0,
                       cv::BORDER_CONSTANT, 0);
    Candidate coarse{cv::Rect(corner, cv::Size()), coarsened(aligned, factor), candidate.rank, 0, candidate.texture};
    coarse.cells = cv::countNonZero(coarse.mask);
    coarse.box = cv::Rect(corner, coarse.mask.size()) & cv::Rect({0, 0}, size);
    return coarse;
}

/// A candidate under refinement.
struct Attempt {
    int level = 0;
    std::optional<Refinement> refinement; ///< none once it has ended
    Refinement::Progress progress = Refinement::Progress::changed;
    Candidate region;
    bool is_duplicate = false; ///< it reached the region of another candidate
};

Attempt attempt_at(int level, const std::vector<Level>& levels, const Candidate& candidate, const SearchBounds& bounds)
{
    const Level& at = levels[std::size_t(level)];
    return {level, Refinement(at.map, candidate, at.others, bounds), Refinement::Progress::changed, {}, false};
}

/// Segments the region again. Unless this is the last step, a region that has grown thick moves to a coarser level, and
/// one that has grown to its window's edge gets a wider window.
void step(Attempt& attempt, const std::vector<Level>& levels, const SearchBounds& bounds, bool is_last)
{
    attempt.progress = attempt.refinement->step();
    if (attempt.progress == Refinement::Progress::none) {
        attempt.refinement.reset();
        return;
    }
    attempt.region = attempt.refinement->region();
    if (is_last) return;
    const Level& at = levels[std::size_t(attempt.level)];
    if (attempt.refinement->widen(at.map, at.others))
        attempt.progress = Refinement::Progress::changed;
    else if (attempt.progress == Refinement::Progress::converged)
        return;
    const int level =
        std::min(attempt.level + level_of(attempt.region.box, attempt.refinement->thickness()), int(levels.size()) - 1);
    if (level > attempt.level) {
        Candidate region =
            coarsened_candidate(attempt.region, 1 << (level - attempt.level), levels[std::size_t(level)].map.z.size());
        attempt = attempt_at(level, levels, region, bounds);
        attempt.region = std::move(region);
    }
}

// Intersection over union above which two regions are duplicates.
constexpr double kMinDuplicateOverlap = 0.93;

/// A region that an attempt has reached.
struct VisitedRegion {
    const Attempt* attempt;
    int level;
    Candidate region;
};

/// Ends attempts that have reached the region of another: their further steps would be the same. If two reach it in one
/// step, the candidate with the higher rank continues.
void end_duplicates(std::vector<Attempt>& attempts, std::vector<VisitedRegion>& visits)
{
    for (Attempt& attempt : attempts) {
        if (!attempt.refinement) continue;
        attempt.is_duplicate = std::ranges::any_of(visits, [&](const VisitedRegion& visit) {
            return visit.attempt != &attempt && !visit.attempt->is_duplicate && visit.level == attempt.level &&
                   overlap(visit.region, attempt.region, kMinDuplicateOverlap);
        });
        if (attempt.is_duplicate)
            attempt.refinement.reset();
        else
            visits.push_back({&attempt, attempt.level, attempt.region});
    }
}

/// The result of an attempt in the cells of the full map; nothing if its evidence is not plausible.
std::optional<Verified> plausible_result(const Attempt& attempt, const std::vector<Level>& levels, double texture,
                                         const SearchBounds& bounds)
{
    Verified verified = attempt.refinement->result(texture);
    if (!is_plausible(verified.evidence, bounds)) return std::nullopt;
    verified.is_converged = attempt.progress == Refinement::Progress::converged;
    if (attempt.level == 0) return verified;
    return in_full_resolution(levels[0].map, std::move(verified), attempt.refinement->surface(), 1 << attempt.level);
}

constexpr int kMaxIterations = 6;

// Cells of a candidate are left out of the rings of others unless it is larger than this share of the largest anomaly,
// or has a low rank.
constexpr double kMaxOtherArea = 0.3;
constexpr double kMinOtherRank = 3;

} // namespace

std::vector<Verified> verify_all(const HeightMap& map, const std::vector<Candidate>& candidates,
                                 const SearchBounds& bounds)
{
    Mask others(map.z.size(), 0);
    const double max_cells = kMaxOtherArea * bounds.max_area / (map.cell * map.cell);
    for (const Candidate& candidate : candidates)
        if (candidate.rank > kMinOtherRank && candidate.cells < max_cells) others(candidate.box) |= candidate.mask;
    std::vector<int> levels_of(candidates.size());
    tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t i) {
        levels_of[i] = level_of(candidates[i].box, thickness_of(candidates[i].mask));
    });
    // A region may grow thicker than its candidate.
    std::vector<Level> levels(candidates.empty() ? 0 : std::size_t(std::ranges::max(levels_of)) + 2);
    tbb::parallel_for(std::size_t{0}, levels.size(), [&](std::size_t level) {
        levels[level] = {coarsened(map, 1 << level), coarsened(others, 1 << level)};
    });
    std::vector<Attempt> attempts(candidates.size());
    std::vector<std::optional<Verified>> results(candidates.size());
    std::vector<VisitedRegion> visits;
    for (int iteration = 1; iteration <= kMaxIterations; ++iteration) {
        tbb::parallel_for(std::size_t{0}, attempts.size(), [&](std::size_t i) {
            const int level = levels_of[i];
            if (iteration == 1)
                attempts[i] = attempt_at(
                    level, levels,
                    coarsened_candidate(candidates[i], 1 << level, levels[std::size_t(level)].map.z.size()), bounds);
            if (attempts[i].refinement) step(attempts[i], levels, bounds, iteration == kMaxIterations);
        });
        end_duplicates(attempts, visits);
        tbb::parallel_for(std::size_t{0}, attempts.size(), [&](std::size_t i) {
            Attempt& attempt = attempts[i];
            if (!attempt.refinement) return;
            if (iteration == kMaxIterations || attempt.progress == Refinement::Progress::converged) {
                results[i] = plausible_result(attempt, levels, candidates[i].texture, bounds);
                attempt.refinement.reset();
            } else
                attempt.refinement->release();
        });
    }
    std::vector<Verified> verified;
    for (auto& result : results)
        if (result) verified.push_back(std::move(*result));
    return verified;
}

} // namespace fettle::find
