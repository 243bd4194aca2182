#include "plan/staircase.h"

#include "core/constants.h"
#include "core/error.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {

// The coverage is judged on rows across the passes; the region's part around a row is taken whole.
constexpr int kRows = 32;
// Candidate lines for each step-over.
constexpr int kLinesPerStep = 64;
// Share of the grid by which a covered stretch may miss a needed one and still count: rounding.
constexpr double kGridSlack = 1e-6;

std::vector<Interval> merged(std::vector<Interval> intervals)
{
    std::sort(intervals.begin(), intervals.end());
    std::vector<Interval> result;
    for (const Interval& next : intervals)
        if (!result.empty() && next.first <= result.back().second)
            result.back().second = std::max(result.back().second, next.second);
        else
            result.push_back(next);
    return result;
}

// The row's part of the region, what of it is still to be covered, and the surface's heights over the grid.
struct Row {
    std::vector<Interval> needed;
    double frontier; ///< everything needed below it is covered
    Eigen::VectorXd z;

    // The first place at or after `from` that is needed.
    double next(double from) const
    {
        for (const Interval& interval : needed)
            if (interval.second > from) return std::max(interval.first, from);
        return kInfinity;
    }
};

// Lines and places across the passes.
struct Grid {
    double origin, spacing;
    int count; ///< of places
    int reach; ///< of the wheel, in places
    double at(int i) const { return origin + i * spacing; }
};

class Coverage {
  public:
    Coverage(Grid grid, const WheelSection& wheel, double leftover, std::vector<Row> rows)
        : grid_(grid), leftover_(leftover), rows_(std::move(rows)), rise_(2 * grid.reach + 1)
    {
        for (int d = -grid.reach; d <= grid.reach; ++d)
            rise_[d + grid.reach] = wheel.rise(std::min(std::abs(d) * grid.spacing, wheel.reach));
    }

    // What the wheel covers on a row from the line at place i: around where it touches, as far as it stays within
    // the leftover of the surface.
    Interval covered(const Row& row, int i) const
    {
        const int n = grid_.reach;
        int touch = -n;
        double level = -kInfinity;
        for (int d = -n; d <= n; ++d) {
            const double z = row.z[i + d] - rise_[d + n];
            if (z > level) level = z, touch = d; // false for NaN
        }
        const auto near = [&](int d) { return !(level + rise_[d + n] - row.z[i + d] > leftover_); };
        int least = touch, most = touch;
        while (least > -n && near(least - 1)) --least;
        while (most < n && near(most + 1)) ++most;
        return {grid_.at(i + least), grid_.at(i + most)};
    }

    bool done() const
    {
        return std::all_of(rows_.begin(), rows_.end(), [](const Row& row) { return row.frontier == kInfinity; });
    }

    // Would a line at i leave nothing behind, and would it leave nothing at all?
    struct Judgement {
        bool closes = true, completes = true;
    };
    Judgement judge(int i) const
    {
        Judgement result;
        for (const Row& row : rows_) {
            if (row.frontier == kInfinity) continue;
            const Interval reach = covered(row, i);
            if (reach.first > row.frontier + kGridSlack * grid_.spacing) return {false, false};
            if (row.next(reach.second + kGridSlack * grid_.spacing) < kInfinity) result.completes = false;
        }
        return result;
    }

    // Moves the frontiers; the strip that the line newly covers, empty (least > most) if none.
    Interval take(int i)
    {
        Interval strip{kInfinity, -kInfinity};
        for (Row& row : rows_) {
            const Interval reach = covered(row, i);
            if (row.frontier == kInfinity || reach.second <= row.frontier) continue;
            strip = {std::min(strip.first, row.frontier), std::max(strip.second, reach.second)};
            row.frontier = row.next(reach.second + kGridSlack * grid_.spacing);
        }
        return strip;
    }

    // The line to take after `previous`: the farthest that leaves nothing behind; the nearest one that completes.
    int choose(int previous, int farthest) const
    {
        int chosen = -1;
        for (int i = farthest; i > previous; --i) {
            const Judgement judgement = judge(i);
            if (judgement.closes && (chosen < 0 || judgement.completes)) chosen = i;
            if (chosen >= 0 && !judgement.completes) break;
        }
        return chosen < 0 ? previous + 1 : chosen;
    }

  private:
    Grid grid_;
    double leftover_;
    std::vector<Row> rows_;
    std::vector<double> rise_;
};

// Largest slope across the passes over the region's bounding box, by a lattice.
double steepest(const Polygon& region, const HeightsAcross& heights)
{
    const Eigen::Vector2d low = region.rowwise().minCoeff();
    const Eigen::Vector2d size = region.rowwise().maxCoeff() - low;
    Eigen::Matrix2Xd lattice(2, (kRows + 1) * (kRows + 1));
    for (int i = 0; i <= kRows; ++i)
        for (int j = 0; j <= kRows; ++j)
            lattice.col(i * (kRows + 1) + j) = low + Eigen::Vector2d(size.x() * j / kRows, size.y() * i / kRows);
    const Eigen::VectorXd z = heights(lattice);
    double result = 0;
    for (Eigen::Index i = 1; i < z.size(); ++i)
        if (i % (kRows + 1) != 0) {
            const double slope = std::abs(z[i] - z[i - 1]) * kRows / size.x();
            if (slope > result) result = slope;
        }
    return result;
}

Grid make_grid(const Polygon& region, const HeightsAcross& heights, const WheelSection& wheel,
               const StaircaseOptions& options)
{
    // A step of slope · spacing within half of the leftover can then be met.
    const double slope = wheel.round ? 0 : steepest(region, heights);
    double spacing = options.step_over / kLinesPerStep;
    if (slope * spacing > options.leftover / 2) spacing = options.leftover / 2 / slope;
    Grid grid;
    grid.reach = int(std::min(std::ceil(wheel.reach / spacing), double(kMostPasses)));
    grid.spacing = wheel.reach / grid.reach;
    const double low = region.row(0).minCoeff(), high = region.row(0).maxCoeff();
    const double lines = (high - low) / grid.spacing + 4.0 * grid.reach;
    if (lines > double(kMostPasses))
        throw InputError("the surface is too steep across the passes, slope " + to_short_text(slope) + ": more than " +
                         std::to_string(kMostPasses) + " lines to choose from");
    grid.origin = low - 2 * wheel.reach;
    grid.count = int(std::ceil(lines)) + 1;
    return grid;
}

std::vector<Row> make_rows(const Polygon& region, const HeightsAcross& heights, const Grid& grid)
{
    const double low = region.row(1).minCoeff(), high = region.row(1).maxCoeff();
    const double spacing = (high - low) / kRows;
    std::vector<Row> rows;
    Eigen::Matrix2Xd places(2, grid.count);
    for (int r = 0; r < kRows; ++r) {
        const double from = low + r * spacing;
        Row row{strip_projection(region, 1, from, r + 1 == kRows ? high : from + spacing), 0, {}};
        row.frontier = row.next(-kInfinity);
        for (int i = 0; i < grid.count; ++i) places.col(i) << grid.at(i), from + spacing / 2;
        row.z = heights(places);
        rows.push_back(std::move(row));
    }
    return rows;
}

} // namespace

std::vector<Interval> strip_projection(const Polygon& polygon, int axis, double least, double most)
{
    std::vector<double> cuts{least, most};
    for (Eigen::Index i = 0; i < polygon.cols(); ++i)
        if (polygon(axis, i) > least && polygon(axis, i) < most) cuts.push_back(polygon(axis, i));
    std::sort(cuts.begin(), cuts.end());

    std::vector<Interval> result;
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        // Between two cuts the polygon is trapezoids: its edges there, from below, bound them in pairs.
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
        std::sort(edges.begin(), edges.end());
        for (std::size_t e = 0; e + 1 < edges.size(); e += 2)
            result.emplace_back(std::min(edges[e][1], edges[e][2]), std::max(edges[e + 1][1], edges[e + 1][2]));
    }
    return merged(std::move(result));
}

std::vector<Pass> staircase(const Polygon& region, const HeightsAcross& heights, const WheelSections& sections,
                            const StaircaseOptions& options)
{
    const Grid grid = make_grid(region, heights, sections.across, options);
    Coverage coverage(grid, sections.across, options.leftover, make_rows(region, heights, grid));
    const double high = region.row(0).maxCoeff();
    const int first = grid.reach, last = grid.count - grid.reach - 1;
    const int step = std::max(1, int(std::floor(options.step_over / grid.spacing * (1 + kGridSlack))));

    std::vector<Pass> passes;
    int line = first - 1;
    while (!coverage.done() && line < last) {
        // No line touches the region's beginning from farther than the wheel reaches.
        const int farthest = passes.empty() ? std::min(3 * grid.reach, last) : std::min(line + step, last);
        line = coverage.choose(line, farthest);
        const Interval strip = coverage.take(line);
        if (strip.first > strip.second) continue;
        passes.push_back({grid.at(line), strip_projection(region, 0, strip.first, std::min(strip.second, high))});
    }
    return passes;
}

} // namespace fettle
