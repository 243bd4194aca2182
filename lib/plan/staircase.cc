#include "plan/staircase.h"

#include "core/constants.h"
#include "core/error.h"
#include "core/text.h"
#include "geometry/bounding_box.h"

#include <algorithm>
#include <cmath>

namespace fettle::plan {

namespace {

// Coverage is tested on rows across the passes. A row represents the part of the region within half a row spacing.
constexpr int kRowCount = 32;
// Number of candidate lines per step-over.
constexpr int kLinesPerStepOver = 64;
// Tolerance for gaps between covered and required intervals, in units of the grid spacing: rounding.
constexpr double kGapToleranceCells = 1e-6;

// The union of intervals, ascending and disjoint.
std::vector<job::Interval> merge(std::vector<job::Interval> intervals)
{
    std::ranges::sort(intervals);
    std::vector<job::Interval> result;
    for (const job::Interval& next : intervals)
        if (!result.empty() && next.first <= result.back().second)
            result.back().second = std::max(result.back().second, next.second);
        else
            result.push_back(next);
    return result;
}

// A row across the passes.
struct Row {
    std::vector<job::Interval> required; ///< the part of the region that the row represents
    double frontier;                     ///< everything required below it is covered
    Eigen::VectorXd z;                   ///< surface heights at the grid points

    // First required position at or after `from`, infinity if there is none.
    double next_required(double from) const
    {
        for (const job::Interval& interval : required)
            if (interval.second > from) return std::max(interval.first, from);
        return core::kInfinity;
    }
};

// Uniform grid of positions across the passes; candidate lines are on grid points.
struct Grid {
    double origin, spacing;
    int count; ///< number of grid points
    int reach; ///< half the wheel's contact length, in grid spacings
    double at(int i) const { return origin + i * spacing; }
};

class Coverage {
  public:
    Coverage(Grid grid, const WheelSection& wheel, double max_scallop, std::vector<Row> rows)
        : grid_(grid), max_scallop_(max_scallop), rows_(std::move(rows)), rise_(2 * grid.reach + 1)
    {
        for (int d = -grid.reach; d <= grid.reach; ++d)
            rise_[d + grid.reach] = wheel.rise(std::min(std::abs(d) * grid.spacing, wheel.reach));
    }

    // The interval of a row that the wheel covers from line i: around its contact, as far as the gap between wheel and
    // surface stays within the scallop height.
    job::Interval covered_interval(const Row& row, int i) const
    {
        const int n = grid_.reach;
        int contact = -n;
        double wheel_z = -core::kInfinity;
        for (int d = -n; d <= n; ++d) {
            const double z = row.z[i + d] - rise_[d + n];
            if (z > wheel_z) wheel_z = z, contact = d; // false for NaN
        }
        const auto near = [&](int d) { return !(wheel_z + rise_[d + n] - row.z[i + d] > max_scallop_); };
        int min = contact, max = contact;
        while (min > -n && near(min - 1)) --min;
        while (max < n && near(max + 1)) ++max;
        return {grid_.at(i + min), grid_.at(i + max)};
    }

    bool done() const
    {
        return std::ranges::all_of(rows_, [](const Row& row) { return row.frontier == core::kInfinity; });
    }

    // Effect of a line at i.
    struct Effect {
        bool without_gap = true; ///< it leaves no gap before its covered interval
        bool completes = true;   ///< after it everything is covered
    };
    Effect effect_of(int i) const
    {
        Effect result;
        for (const Row& row : rows_) {
            if (row.frontier == core::kInfinity) continue;
            const auto [first, last] = covered_interval(row, i);
            if (first > row.frontier + kGapToleranceCells * grid_.spacing) return {false, false};
            if (row.next_required(last + kGapToleranceCells * grid_.spacing) < core::kInfinity)
                result.completes = false;
        }
        return result;
    }

    // Adds a line: advances the frontiers. Returns the newly covered strip, empty (first > second) if there is none.
    job::Interval add_line(int i)
    {
        job::Interval strip{core::kInfinity, -core::kInfinity};
        for (Row& row : rows_) {
            const double last = covered_interval(row, i).second;
            if (row.frontier == core::kInfinity || last <= row.frontier) continue;
            strip = {std::min(strip.first, row.frontier), std::max(strip.second, last)};
            row.frontier = row.next_required(last + kGapToleranceCells * grid_.spacing);
        }
        return strip;
    }

    // The next line after `previous`: the farthest one without a gap, or the nearest one that completes the coverage.
    int choose_line(int previous, int farthest) const
    {
        int chosen = -1;
        for (int i = farthest; i > previous; --i) {
            const Effect effect = effect_of(i);
            if (effect.without_gap && (chosen < 0 || effect.completes)) chosen = i;
            if (chosen >= 0 && !effect.completes) break;
        }
        return chosen < 0 ? previous + 1 : chosen;
    }

  private:
    Grid grid_;
    double max_scallop_;
    std::vector<Row> rows_;
    std::vector<double> rise_;
};

// Largest slope across the passes on a lattice over the region's bounding box.
double max_slope(const job::Polygon& region, const HeightsInPassFrame& heights)
{
    const Eigen::AlignedBox2d box = geometry::bounding_box(region);
    const Eigen::Vector2d size = box.sizes();
    Eigen::Matrix2Xd lattice(2, (kRowCount + 1) * (kRowCount + 1));
    for (int i = 0; i <= kRowCount; ++i)
        for (int j = 0; j <= kRowCount; ++j)
            lattice.col(i * (kRowCount + 1) + j) =
                box.min() + Eigen::Vector2d(size.x() * j / kRowCount, size.y() * i / kRowCount);
    const Eigen::VectorXd z = heights(lattice);
    double result = 0;
    for (Eigen::Index i = 1; i < z.size(); ++i)
        if (i % (kRowCount + 1) != 0) {
            const double slope = std::abs(z[i] - z[i - 1]) * kRowCount / size.x();
            if (slope > result) result = slope;
        }
    return result;
}

Grid make_grid(const job::Polygon& region, const HeightsInPassFrame& heights, const WheelSection& wheel,
               const StaircaseOptions& options)
{
    // A flat wheel leaves steps of slope · spacing; these must be within half of the scallop height.
    const double slope = wheel.round ? 0 : max_slope(region, heights);
    double spacing = options.step_over / kLinesPerStepOver;
    if (slope * spacing > options.max_scallop / 2) spacing = options.max_scallop / 2 / slope;
    Grid grid;
    grid.reach = int(std::min(std::ceil(wheel.reach / spacing), double(kMaxPasses)));
    grid.spacing = wheel.reach / grid.reach;
    const double low = region.row(0).minCoeff(), high = region.row(0).maxCoeff();
    const double lines = (high - low) / grid.spacing + 4.0 * grid.reach;
    if (lines > double(kMaxPasses))
        throw core::InputError("the surface is too steep across the passes, slope " + core::to_short_text(slope) +
                               ": more than " + std::to_string(kMaxPasses) + " lines to choose from");
    grid.origin = low - 2 * wheel.reach;
    grid.count = int(std::ceil(lines)) + 1;
    return grid;
}

std::vector<Row> make_rows(const job::Polygon& region, const HeightsInPassFrame& heights, const Grid& grid)
{
    const double low = region.row(1).minCoeff(), high = region.row(1).maxCoeff();
    const double spacing = (high - low) / kRowCount;
    std::vector<Row> rows;
    Eigen::Matrix2Xd points(2, grid.count);
    for (int r = 0; r < kRowCount; ++r) {
        const double from = low + r * spacing;
        Row row{strip_projection(region, 1, from, r + 1 == kRowCount ? high : from + spacing), 0, {}};
        row.frontier = row.next_required(-core::kInfinity);
        for (int i = 0; i < grid.count; ++i) points.col(i) << grid.at(i), from + spacing / 2;
        row.z = heights(points);
        rows.push_back(std::move(row));
    }
    return rows;
}

} // namespace

std::vector<job::Interval> strip_projection(const job::Polygon& polygon, int axis, double min, double max)
{
    std::vector<double> cuts{min, max};
    for (Eigen::Index i = 0; i < polygon.cols(); ++i)
        if (polygon(axis, i) > min && polygon(axis, i) < max) cuts.push_back(polygon(axis, i));
    std::ranges::sort(cuts);

    std::vector<job::Interval> result;
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        // Between two cuts the polygon consists of trapezoids, which are bounded by pairs of its sorted edges.
        const double a = cuts[k], b = cuts[k + 1], middle = 0.5 * (a + b);
        if (!(b > a)) continue;
        std::vector<std::array<double, 3>> edges; // other coordinate at the middle, a, b
        for (Eigen::Index i = 0; i < polygon.cols(); ++i) {
            const Eigen::Vector2d p = polygon.col(i), q = polygon.col((i + 1) % polygon.cols());
            if ((p[axis] < middle) == (q[axis] < middle)) continue;
            const double slope = (q[1 - axis] - p[1 - axis]) / (q[axis] - p[axis]);
            const auto at = [&](double c) { return p[1 - axis] + slope * (c - p[axis]); };
            edges.push_back({at(middle), at(a), at(b)});
        }
        std::ranges::sort(edges);
        for (std::size_t e = 0; e + 1 < edges.size(); e += 2)
            result.emplace_back(std::min(edges[e][1], edges[e][2]), std::max(edges[e + 1][1], edges[e + 1][2]));
    }
    return merge(std::move(result));
}

std::vector<Pass> staircase(const job::Polygon& region, const HeightsInPassFrame& heights,
                            const WheelSections& sections, const StaircaseOptions& options)
{
    const Grid grid = make_grid(region, heights, sections.across, options);
    Coverage coverage(grid, sections.across, options.max_scallop, make_rows(region, heights, grid));
    const double high = region.row(0).maxCoeff();
    const int first = grid.reach, last = grid.count - grid.reach - 1;
    const int step = std::max(1, int(std::floor(options.step_over / grid.spacing * (1 + kGapToleranceCells))));

    std::vector<Pass> passes;
    int line = first - 1;
    while (!coverage.done() && line < last) {
        // A line farther from the start of the region than the wheel's reach does not touch it.
        const int farthest = passes.empty() ? std::min(3 * grid.reach, last) : std::min(line + step, last);
        line = coverage.choose_line(line, farthest);
        const job::Interval strip = coverage.add_line(line);
        if (strip.first > strip.second) continue;
        passes.push_back({grid.at(line), strip_projection(region, 0, strip.first, std::min(strip.second, high))});
    }
    return passes;
}

} // namespace fettle::plan
