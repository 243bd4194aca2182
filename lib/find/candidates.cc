#include "find/candidates.h"

#include "find/background.h"
#include "find/sheets.h"

#include <opencv2/imgproc.hpp>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <iterator>

namespace fettle::find {
namespace {

constexpr std::array<double, 8> kThresholdSigmas{1.5, 3, 6, 12, 24, 48, 96, 192};
constexpr double kResidualSmoothing = 0.8; // cells

constexpr int kMinCells = 10;
// A region that fills more than this share of the one around it at the next lower threshold is a duplicate of it.
constexpr double kMaxNestedAreaShare = 0.85;

// A candidate is higher than the median of a shell around it, from 2 to 4 cells off, by so many sigmas; this share of
// the shell lies within 0.3 of its height about that median.
constexpr int kShellInner = 1, kShellOuter = 4;
constexpr double kMinContrast = 4, kMaxContrast = 30; // a higher contrast does not raise the rank
constexpr double kLevelShare = 0.3;
// A filter takes part of an anomaly for surface: a candidate may be lower than what is reported.
constexpr double kMinHeightShare = 0.5;
constexpr double kMinEnclosure = 0.3;

constexpr double kFirstWidth = 10, kWidthRatio = 1.9; // of the filters, cells
constexpr std::size_t kMaxCandidates = 200;

// Candidates may be larger than what is reported by these factors: a low threshold takes in their surroundings.
constexpr double kMaxAreaFactor = 1.5, kMaxExtentFactor = 2;
constexpr double kAreaRankPower = 0.25;      // at the same contrast and enclosure the larger candidate ranks first
constexpr float kBelowAllThresholds = -1e9F; // height of cells that are not seen

// Two candidates are the same if they share this much of what both cover.
constexpr double kDuplicateOverlap = 0.85;

std::vector<double> filter_widths(const HeightMap& map, double max_width)
{
    std::vector<double> widths;
    const double limit = std::min(max_width / map.cell, double(std::min(map.z.rows, map.z.cols)));
    for (double width = kFirstWidth; width < limit; width *= kWidthRatio) widths.push_back(width);
    if (widths.empty()) widths.push_back(std::max(4.0, std::min(kFirstWidth, limit)));
    return widths;
}

/// Contrast and enclosure of a region of a residual, as rank; 0: no candidate.
double rank_of(const Image& residual, const Mask& domain, const Mask& mask, double sigma, double min_height)
{
    Mask padded;
    cv::copyMakeBorder(mask, padded, kShellOuter, kShellOuter, kShellOuter, kShellOuter, cv::BORDER_CONSTANT, 0);
    const int all = cv::countNonZero(dilated(padded, kShellOuter)) - cv::countNonZero(dilated(padded, kShellInner));
    const Mask shell = dilated(mask, kShellOuter) & ~dilated(mask, kShellInner) & domain;
    const std::vector<double> around = values_in(residual, shell);
    const double base = quantile_of(around, 0.5), top = quantile_of(values_in(residual, mask), 0.9);
    const double contrast = (top - base) / sigma;
    if (contrast <= kMinContrast || top - base < kMinHeightShare * min_height || all == 0) return 0;
    const auto level = std::ranges::count_if(
        around, [&](double value) { return std::abs(value - base) < kLevelShare * (top - base); });
    const double enclosure = double(level) / all;
    return enclosure > kMinEnclosure ? std::min(contrast, kMaxContrast) * enclosure * enclosure : 0;
}

/// A connected component over a threshold.
struct Region {
    cv::Rect box;
    Mask mask; ///< of the box's size
    int area;
};

/// The regions over a threshold within one over the threshold before it.
void add_regions(const Image& residual, const Region& below, double threshold, std::vector<Region>& regions)
{
    Mask high = residual(below.box) > threshold;
    high &= below.mask;
    if (cv::countNonZero(high) < kMinCells) return;
    const Components parts = components(high);
    for (int k = 1; k <= parts.count; ++k) {
        if (parts.area(k) < kMinCells) continue;
        const cv::Rect box = parts.box(k);
        regions.push_back({box + below.box.tl(), parts.labels(box) == k, parts.area(k)});
    }
}

/// Candidates of one residual: connected components over rising thresholds. Each threshold is applied within the
/// components over the one before it, which are small beside the map.
std::vector<Candidate> cut_out(const Image& residual, const Mask& domain, const HeightMap& map,
                               const SearchBounds& bounds)
{
    const double max_cells = kMaxAreaFactor * bounds.max_area / (map.cell * map.cell),
                 max_extent = kMaxExtentFactor * bounds.max_width / map.cell;
    std::vector<Candidate> candidates;
    std::vector<Region> below{{cv::Rect({0, 0}, residual.size()), Mask(residual.size(), 255), INT_MAX}};
    for (const double threshold : kThresholdSigmas) {
        std::vector<Region> regions;
        for (const Region& whole : below) {
            const std::size_t first = regions.size();
            add_regions(residual, whole, threshold * map.sigma, regions);
            for (std::size_t i = first; i < regions.size(); ++i) {
                const Region& region = regions[i];
                if (region.area > max_cells || std::max(region.box.width, region.box.height) > max_extent ||
                    region.area > kMaxNestedAreaShare * whole.area)
                    continue;
                const cv::Rect around = grown_box(region.box, kShellOuter, residual.size());
                Mask mask(around.size(), 0);
                region.mask.copyTo(mask(region.box - around.tl()));
                if (const double rank = rank_of(residual(around), domain(around), mask, map.sigma, bounds.min_height);
                    rank > 0)
                    candidates.push_back({around, mask, rank * std::pow(region.area, kAreaRankPower), region.area});
            }
        }
        below = std::move(regions);
    }
    return candidates;
}

/// Candidates of one sheet at one width of the filter.
std::vector<Candidate> candidates_of(const HeightMap& map, const Sheet& sheet, double width, const SearchBounds& bounds)
{
    const cv::Rect box = cv::boundingRect(sheet.domain);
    HeightMap part{map.z(box).clone(), map.cell, map.origin, sheet.domain(box).clone(), map.sigma};
    part.z.setTo(std::numeric_limits<float>::quiet_NaN(), ~part.seen);
    const Mask smooth = sheet.smooth(box);
    const Image rest = part.z - regression_filter(part.z, smooth, map.sigma, width);
    Image residual = smoothed(rest, part.seen, kResidualSmoothing);
    const double texture = robust_sd(values_in(residual, smooth));
    residual.setTo(kBelowAllThresholds, ~part.seen);
    std::vector<Candidate> candidates = cut_out(residual, part.seen, part, bounds);
    for (Candidate& candidate : candidates) {
        candidate.box += box.tl();
        candidate.texture = texture;
    }
    return candidates;
}

std::vector<Candidate> candidates_of_opening(const HeightMap& map, double width, const SearchBounds& bounds)
{
    const Image rest = map.z - ball_opening(map.z, map.cell, width);
    Image residual = smoothed(rest, map.seen, kResidualSmoothing);
    const double texture = robust_sd(values_in(residual, map.seen));
    residual.setTo(kBelowAllThresholds, ~map.seen);
    std::vector<Candidate> candidates = cut_out(residual, map.seen, map, bounds);
    for (Candidate& candidate : candidates) candidate.texture = texture;
    return candidates;
}

} // namespace

bool overlap(const Candidate& a, const Candidate& b, double share)
{
    const cv::Rect common = a.box & b.box;
    const auto is_more = [&](int both) { return both > share * std::max(1, a.cells + b.cells - both); };
    if (common.empty() || !is_more(std::min({a.cells, b.cells, common.area()}))) return false;
    return is_more(cv::countNonZero(a.mask(common - a.box.tl()) & b.mask(common - b.box.tl())));
}

std::vector<Candidate> find_candidates(const HeightMap& map, const SearchBounds& bounds)
{
    const std::vector<double> widths = filter_widths(map, bounds.max_width);
    std::vector<std::vector<Candidate>> found, of_openings(std::min<std::size_t>(2, widths.size()));
    tbb::task_group openings; // run while the sheets are found, on which they do not depend
    for (std::size_t i = 0; i < of_openings.size(); ++i)
        openings.run([&, i] { of_openings[i] = candidates_of_opening(map, widths[widths.size() - 1 - i], bounds); });
    const std::vector<Sheet> sheets = find_sheets(map, bounds.max_width / map.cell / 2);
    found.resize(sheets.size() * widths.size());
    tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t i) {
        found[i] = candidates_of(map, sheets[i / widths.size()], widths[i % widths.size()], bounds);
    });
    openings.wait();
    std::ranges::move(of_openings, std::back_inserter(found));
    std::vector<Candidate> all, unique;
    for (std::vector<Candidate>& some : found) std::ranges::move(some, std::back_inserter(all));
    std::ranges::stable_sort(all, std::greater{}, &Candidate::rank);
    for (Candidate& candidate : all) {
        if (unique.size() == kMaxCandidates) break;
        if (std::ranges::none_of(unique,
                                 [&](const Candidate& other) { return overlap(candidate, other, kDuplicateOverlap); }))
            unique.push_back(std::move(candidate));
    }
    return unique;
}

} // namespace fettle::find
