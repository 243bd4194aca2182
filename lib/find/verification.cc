#include "find/verification.h"

#include "find/refinement.h"

#include <opencv2/imgproc.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

namespace fettle::find {
namespace {

/// A mask of cells `factor` times as long in the map's own.
Mask magnified(const Mask& mask, int factor, const cv::Size& size)
{
    Mask large;
    cv::resize(mask, large, {}, factor, factor, cv::INTER_NEAREST);
    return large(cv::Rect({0, 0}, size)).clone();
}

/// What was verified in a coarse map, in the cells of the map.
/// @param surface  beneath, in the coarse window
Verified in_cells_of(const HeightMap& map, Verified coarse, const Image& surface, int factor)
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

// A candidate is verified in cells twice as long, and again, as long as it remains thicker than this many of them; a
// long one, whose window would be large, than the other number.
constexpr double kMinCoarseThickness = 40, kMinLongThickness = 12;
constexpr double kMaxExtent = 300; // cells: what is longer is long

/// A map in cells twice as long from level to level, with the cells of all candidates.
struct Level {
    HeightMap map;
    Mask others;
};

/// How often the cells in which a candidate is verified are doubled.
/// @param box  of its cells   @param thickness  cells
int level_of(const cv::Rect& box, double thickness)
{
    double extent = std::max(box.width, box.height);
    int level = 0;
    while (thickness >= 2 * (extent > kMaxExtent ? kMinLongThickness : kMinCoarseThickness))
        thickness /= 2, extent /= 2, ++level;
    return level;
}

/// A candidate in cells `factor` times as long.
Candidate in_longer_cells(const Candidate& candidate, int factor, const cv::Size& size)
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

/// A candidate on its way to a find.
struct Attempt {
    int level = 0;
    std::optional<Refinement> refinement; ///< nothing once it has ended
    Refinement::Progress progress = Refinement::Progress::moved;
    Candidate region;
    bool is_repetition = false; ///< ended where another had been
};

Attempt attempt_at(int level, const std::vector<Level>& levels, const Candidate& candidate, const SearchBounds& bounds)
{
    const Level& at = levels[std::size_t(level)];
    return {level, Refinement(at.map, candidate, at.others, bounds), Refinement::Progress::moved, {}, false};
}

/// Takes the region anew; one that has grown thick goes on in longer cells, if it goes on.
void step(Attempt& attempt, const std::vector<Level>& levels, const SearchBounds& bounds, bool goes_on)
{
    attempt.progress = attempt.refinement->step();
    if (attempt.progress == Refinement::Progress::none) {
        attempt.refinement.reset();
        return;
    }
    attempt.region = attempt.refinement->region();
    if (!goes_on || attempt.progress == Refinement::Progress::settled) return;
    const int level =
        std::min(attempt.level + level_of(attempt.region.box, attempt.refinement->thickness()), int(levels.size()) - 1);
    if (level > attempt.level) {
        Candidate region =
            in_longer_cells(attempt.region, 1 << (level - attempt.level), levels[std::size_t(level)].map.z.size());
        attempt = attempt_at(level, levels, region, bounds);
        attempt.region = std::move(region);
    }
}

// Two regions that overlap by this are of one place.
constexpr double kSamePlace = 0.93;

/// A region that an attempt has come to.
struct Visit {
    const Attempt* attempt;
    int level;
    Candidate region;
};

/// Ends attempts that have come to where another has been: they would go the same way. Of two that come to one place
/// together, that with the higher rank goes on.
void end_repetitions(std::vector<Attempt>& attempts, std::vector<Visit>& visits)
{
    for (Attempt& attempt : attempts) {
        if (!attempt.refinement) continue;
        attempt.is_repetition = std::ranges::any_of(visits, [&](const Visit& visit) {
            return visit.attempt != &attempt && !visit.attempt->is_repetition && visit.level == attempt.level &&
                   overlap(visit.region, attempt.region, kSamePlace);
        });
        if (attempt.is_repetition)
            attempt.refinement.reset();
        else
            visits.push_back({&attempt, attempt.level, attempt.region});
    }
}

/// The find that a region is, in the map's own cells; nothing if its evidence is not plausible.
std::optional<Verified> find_of(const Attempt& attempt, const std::vector<Level>& levels, double texture,
                                const SearchBounds& bounds)
{
    Verified verified = attempt.refinement->result(texture);
    if (!is_plausible(verified.evidence, bounds)) return std::nullopt;
    if (attempt.level == 0) return verified;
    return in_cells_of(levels[0].map, std::move(verified), attempt.refinement->surface(), 1 << attempt.level);
}

constexpr int kMaxIterations = 6;

// Candidates larger than this share of the largest anomaly, or of a lower rank, do not keep cells out of others' rings.
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
    std::vector<Visit> visits;
    for (int iteration = 1; iteration <= kMaxIterations; ++iteration) {
        tbb::parallel_for(std::size_t{0}, attempts.size(), [&](std::size_t i) {
            const int level = levels_of[i];
            if (iteration == 1)
                attempts[i] = attempt_at(
                    level, levels, in_longer_cells(candidates[i], 1 << level, levels[std::size_t(level)].map.z.size()),
                    bounds);
            if (attempts[i].refinement) step(attempts[i], levels, bounds, iteration < kMaxIterations);
        });
        end_repetitions(attempts, visits);
        tbb::parallel_for(std::size_t{0}, attempts.size(), [&](std::size_t i) {
            Attempt& attempt = attempts[i];
            if (!attempt.refinement) return;
            if (iteration == kMaxIterations || attempt.progress == Refinement::Progress::settled) {
                results[i] = find_of(attempt, levels, candidates[i].texture, bounds);
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
