#include "sampling/freeform.h"

#include "core/error.h"
#include "core/text.h"
#include "geometry/bounding_box.h"

#include <algorithm>
#include <cmath>

namespace fettle::sampling {

namespace {

// Estimated points needed per square inch of the rectangle, Wang 2007, eq. 4-3.
constexpr double kPointsPerSquareMm = 0.22 / 645.16;

// Subtracted before rounding up: the rounding of inches to mm must not add a line.
constexpr double kCeilingTolerance = 1e-9;

// Limits the number of lines across a very narrow rectangle to the range of int.
constexpr double kMaxCount = 1e9;

void check_count(const job::Job& job, const LineCount& count, const Eigen::Vector2d& sides)
{
    const int lines = std::max(count.across_a, count.across_b);
    if (lines <= kMaxProbingLines) return;
    const auto side = [&](double length) { return core::to_short_text(length / job.units.mm()); };
    throw core::InputError(job.source, "anomaly: its rectangle in the working frame, " + side(sides.x()) + " x " +
                                           side(sides.y()) + " " + units::to_string(job.units.length) + ", needs " +
                                           std::to_string(lines) + " lines across a side, at most " +
                                           std::to_string(kMaxProbingLines) +
                                           " are probed: choose a smaller or a wider region");
}

} // namespace

LineCount line_count(double a, double b)
{
    const auto round_up = [](double number) {
        return static_cast<int>(std::ceil(std::min(number, kMaxCount) - kCeilingTolerance));
    };
    const int n_a = round_up(std::sqrt(kPointsPerSquareMm * a * a + a / b));
    return {n_a, round_up(n_a * b / a)};
}

TouchPlan plan_freeform(const job::Job& job, const std::optional<LineCount>& lines)
{
    const job::Boundaries both = job::working_boundaries(job);
    const Eigen::AlignedBox2d box = geometry::bounding_box(both.anomaly);
    const Eigen::Vector2d min = box.min(), sides = box.sizes();
    const LineCount count = lines.value_or(line_count(sides.x(), sides.y()));
    check_count(job, count, sides);

    TouchPlan plan;
    int curve = 0;
    const auto add_lines = [&](int across, const Eigen::Vector2d& along_side, const Eigen::Vector2d& direction) {
        for (int i = 1; i <= across; ++i) {
            const Eigen::Vector2d start = min + along_side * i / (across + 1.0);
            // The difference of two touches closer than the probe's accuracy does not determine a slope.
            const auto t = crossings_around(both, start, direction, job.probe.accuracy);
            if (!t)
                throw NoRoomError(
                    job.source,
                    "sampling: no room to touch on both sides of the anomaly, on the line through " +
                        job::point_text(job::rotation_working_machine(job.theta).transpose() * start, job.units) +
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

} // namespace fettle::sampling
