#include "sampling/freeform.h"

#include "core/error.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {

// Wang 2007, eq. 4-3: estimated points needed for each square inch of the rectangle.
constexpr double kPointsPerSquareMm = 0.22 / 645.16;

// Taken off before rounding up: a change from inches to mm and back must not add a line.
constexpr double kBeforeCeiling = 1e-9;

// Keeps the number of lines across a needle within the range of int.
constexpr double kCountless = 1e9;

void check_count(const Job& job, const LineCount& count, const Eigen::Vector2d& sides)
{
    const int most = std::max(count.across_a, count.across_b);
    if (most <= kMostLines) return;
    const auto side = [&](double length) { return to_short_text(length / job.units.mm()); };
    throw InputError(job.source, "anomaly: its rectangle in the working frame, " + side(sides.x()) + " x " +
                                     side(sides.y()) + " " + to_string(job.units.length) + ", needs " +
                                     std::to_string(most) + " lines across a side, at most " +
                                     std::to_string(kMostLines) + " are probed: choose a smaller or a wider region");
}

} // namespace

LineCount line_count(double a, double b)
{
    const auto up = [](double number) {
        return static_cast<int>(std::ceil(std::min(number, kCountless) - kBeforeCeiling));
    };
    const int n_a = up(std::sqrt(kPointsPerSquareMm * a * a + a / b));
    return {n_a, up(n_a * b / a)};
}

TouchPlan plan_freeform(const Job& job, const std::optional<LineCount>& lines)
{
    const Boundaries both = boundaries(job);
    const Eigen::Vector2d least = both.anomaly.rowwise().minCoeff();
    const Eigen::Vector2d sides = both.anomaly.rowwise().maxCoeff() - least;
    const LineCount count = lines.value_or(line_count(sides.x(), sides.y()));

    check_count(job, count, sides);

    TouchPlan plan;
    int curve = 0;
    const auto add_lines = [&](int across, const Eigen::Vector2d& along_side, const Eigen::Vector2d& direction) {
        for (int i = 1; i <= across; ++i) {
            const Eigen::Vector2d start = least + along_side * i / (across + 1.0);
            // nearer together than the probe is exact, two touches tell nothing of the slope
            const auto t = crossings_around(both, start, direction, job.probe.accuracy);
            if (!t)
                throw InputError(job.source,
                                 "sampling: no room to touch on both sides of the anomaly, on the line through " +
                                     place(rotation_working_machine(job.theta).transpose() * start, job.units) +
                                     ": widen the sampling boundary there");
            const Eigen::Matrix2Xd points = start.replicate<1, 4>() + direction * t->transpose();
            append_line(
                plan, points, job.theta, curve++,
                {Role::near_sampling_boundary, Role::near_anomaly, Role::near_anomaly, Role::near_sampling_boundary});
        }
    };
    add_lines(count.across_a, {sides.x(), 0}, Eigen::Vector2d::UnitY());
    add_lines(count.across_b, {0, sides.y()}, Eigen::Vector2d::UnitX());
    return plan;
}

} // namespace fettle
