#include "sampling/swept.h"

#include "core/constants.h"
#include "core/error.h"
#include "geometry/bounding_box.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fettle::sampling {

namespace {

// Frame D of this file: W rotated so that the rulings are along X_d (coordinate u) and the sections along Y_d (v).

// Values that differ by less, relative to the size of the sampling boundary, are ties, which rounding must not decide.
constexpr double kTieTolerance = 1e-9;

// Lines are tried through every corner and at these fractions of the gap between adjacent corners: the middle is away
// from both, the outer ones are close to an optimum at a corner that the anomaly itself occupies.
constexpr std::array<double, 3> kGapFractions = {0.1, 0.5, 0.9};

// Boundaries with more corners, such as those traced by a scanner, are thinned to keep the search fast.
constexpr std::size_t kMaxCorners = 200;

// A free interval of the section line at u.
struct Stretch {
    double u;
    job::Interval v;

    double length() const { return v.second - v.first; }
};

struct Search {
    job::Boundaries both; // in D
    double min_length;    // of a usable stretch, mm
    double tie;           // mm
    job::Interval width;  // extent of the anomaly in v, which the section should cover
    double middle_u = 0;  // middle of the anomaly
    double middle_v = 0;

    std::vector<job::Interval> free_along(double v) const { return free({0, v}, Eigen::Vector2d::UnitX()); }
    std::vector<job::Interval> free_across(double u) const { return free({u, 0}, Eigen::Vector2d::UnitY()); }

  private:
    std::vector<job::Interval> free(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction) const
    {
        return job::subtract(job::intervals_inside(both.sampling, origin, direction),
                             job::intervals_inside(both.anomaly, origin, direction), min_length);
    }
};

Search make_search(const job::Job& job)
{
    const Eigen::Matrix2d rotation = job::rotation_working_machine(job.ruling_direction);
    const job::Boundaries both = job::working_boundaries(job);
    Search result;
    result.both = {rotation * both.anomaly, rotation * both.sampling};
    result.min_length = job.probe.accuracy;
    const Eigen::AlignedBox2d box = geometry::bounding_box(result.both.anomaly);
    result.width = {box.min().y(), box.max().y()};
    result.middle_u = box.center().x();
    result.middle_v = box.center().y();
    result.tie = kTieTolerance * geometry::bounding_box(result.both.sampling).sizes().norm();
    return result;
}

// Candidate coordinates of lines: those of the corners and some in the gaps between them.
std::vector<double> line_candidates(std::vector<double> corners)
{
    std::sort(corners.begin(), corners.end());
    if (corners.size() > kMaxCorners) {
        std::vector<double> thinned;
        for (std::size_t i = 0; i < kMaxCorners; ++i)
            thinned.push_back(corners[i * (corners.size() - 1) / (kMaxCorners - 1)]);
        corners = thinned;
    }
    std::vector<double> candidates;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        candidates.push_back(corners[i]);
        if (i + 1 < corners.size())
            for (const double fraction : kGapFractions)
                candidates.push_back(corners[i] + fraction * (corners[i + 1] - corners[i]));
    }
    return candidates;
}

std::vector<double> corner_coordinates(const Search& s, int axis)
{
    std::vector<double> corners;
    for (const job::Polygon& polygon : {s.both.anomaly, s.both.sampling})
        for (Eigen::Index i = 0; i < polygon.cols(); ++i) corners.push_back(polygon(axis, i));
    return corners;
}

// Candidates for the section line. They include the crossings of the sampling boundary with the limits of the width,
// where a line starts or ends to cover the width.
std::vector<double> section_candidates(const Search& s)
{
    std::vector<double> corners = corner_coordinates(s, 0);
    for (const double v : {s.width.first, s.width.second})
        for (const job::Interval& stretch : job::intervals_inside(s.both.sampling, {0, v}, Eigen::Vector2d::UnitX()))
            corners.insert(corners.end(), {stretch.first, stretch.second});
    return line_candidates(corners);
}

// The best (value, penalty) so far: the largest value; of ties the smallest penalty; of ties again the first.
struct Best {
    double value = -core::kInfinity;
    double penalty = 0;

    bool improved_by(double other_value, double other_penalty, double tie)
    {
        const bool better = other_value > value + tie || (other_value > value - tie && other_penalty < penalty - tie);
        if (better) value = other_value, penalty = other_penalty;
        return better;
    }
};

// The longest free interval along the rulings: its v, and the interval of u.
std::optional<std::pair<double, job::Interval>> ruling_line(const Search& s)
{
    std::optional<std::pair<double, job::Interval>> longest;
    Best best;
    for (const double v : line_candidates(corner_coordinates(s, 1)))
        for (const job::Interval& u : s.free_along(v))
            if (best.improved_by(u.second - u.first, std::abs(v - s.middle_v), s.tie)) longest = {v, u};
    return longest;
}

// Four points on the section line at u.
Eigen::Matrix2Xd section_points(double u, const Eigen::Vector4d& v)
{
    Eigen::Matrix2Xd points(2, 4);
    points << Eigen::RowVector4d::Constant(u), v.transpose();
    return points;
}

// (a) The line closest to the anomaly's middle that is free over the whole width.
std::optional<Eigen::Matrix2Xd> whole_width(const Search& s, const std::vector<double>& candidates)
{
    std::optional<Eigen::Matrix2Xd> section;
    Best best;
    for (const double u : candidates)
        for (const job::Interval& v : s.free_across(u)) {
            if (v.first > s.width.first + s.tie || v.second < s.width.second - s.tie) continue;
            if (best.improved_by(0, std::abs(u - s.middle_u), s.tie))
                section = section_points(u, Eigen::Vector4d::LinSpaced(s.width.first, s.width.second));
        }
    return section;
}

// One stretch only: its ends, and the closest free points on the same line beyond them.
Eigen::Matrix2Xd single_stretch(const Search& s, const Stretch& only)
{
    const double p = only.v.first, q = only.v.second;
    std::optional<double> below, above;
    for (const job::Interval& v : s.free_across(only.u)) {
        if (v.second < p - s.tie) below = v.second;
        if (v.first > q + s.tie && !above) above = v.first;
    }
    if (below && above) return section_points(only.u, {*below, p, q, *above});
    if (above) return section_points(only.u, {p, (p + q) / 2, q, *above});
    if (below) return section_points(only.u, {*below, p, (p + q) / 2, q});
    return section_points(only.u, Eigen::Vector4d::LinSpaced(p, q));
}

Eigen::Matrix2Xd touches_on(const Search& s, const Stretch& first, const Stretch& second)
{
    if (first.u == second.u && first.v == second.v) return single_stretch(s, first);
    const Stretch& low = first.v.first <= second.v.first ? first : second;
    const Stretch& high = &low == &first ? second : first;
    Eigen::Matrix2Xd points(2, 4);
    if (low.v.second < high.v.first - s.tie) {
        points << low.u, low.u, high.u, high.u, low.v.first, low.v.second, high.v.first, high.v.second;
        return points;
    }
    // The stretches overlap or touch, so their inner ends may coincide: four uniform points, each on the free line.
    const Eigen::Vector4d v = Eigen::Vector4d::LinSpaced(low.v.first, std::max(low.v.second, high.v.second));
    for (Eigen::Index i = 0; i < 4; ++i) points.col(i) << (v[i] <= low.v.second + s.tie ? low.u : high.u), v[i];
    return points;
}

// (b) The two stretches that together cover the largest part of the width.
std::optional<Eigen::Matrix2Xd> part_of_width(const Search& s, const std::vector<double>& candidates)
{
    std::vector<Stretch> stretches;
    for (const double u : candidates)
        for (const job::Interval& v : job::intersect(s.free_across(u), {s.width}, s.min_length))
            stretches.push_back({u, v});
    if (stretches.empty()) return std::nullopt;

    std::pair<std::size_t, std::size_t> chosen;
    Best best;
    for (std::size_t i = 0; i < stretches.size(); ++i)
        for (std::size_t j = i; j < stretches.size(); ++j) {
            const Stretch &p = stretches[i], &q = stretches[j];
            const double overlap = std::min(p.v.second, q.v.second) - std::max(p.v.first, q.v.first);
            const double covered = p.length() + q.length() - std::max(overlap, 0.0);
            // Stretches on the same line are preferred: their heights are comparable without the slope of the rulings.
            const double between = std::abs(p.u - q.u);
            const double off_middle = std::abs(p.u - s.middle_u) + std::abs(q.u - s.middle_u);
            if (best.improved_by(covered, between + off_middle, s.tie)) chosen = {i, j};
        }
    return touches_on(s, stretches[chosen.first], stretches[chosen.second]);
}

// (c) The longest line across the anomaly, at its crossings with S and B.
std::optional<Eigen::Matrix2Xd> around_anomaly(const Search& s, const std::vector<double>& candidates)
{
    std::optional<Eigen::Matrix2Xd> section;
    Best best;
    for (const double u : candidates) {
        const auto v = crossings_around(s.both, {u, 0}, Eigen::Vector2d::UnitY(), s.min_length);
        if (v && best.improved_by((*v)[3] - (*v)[0], std::abs(u - s.middle_u), s.tie)) section = section_points(u, *v);
    }
    return section;
}

} // namespace

TouchPlan plan_swept(const job::Job& job)
{
    const Search s = make_search(job);
    const double theta = job.theta + job.ruling_direction; // from X_m to X_d
    const auto ruling = ruling_line(s);
    if (!ruling)
        throw core::InputError(job.source,
                               "sampling: no line along the rulings is free of the anomaly: widen the sampling "
                               "boundary");
    const std::vector<double> candidates = section_candidates(s);
    std::optional<Eigen::Matrix2Xd> section = whole_width(s, candidates);
    if (!section) section = part_of_width(s, candidates);
    if (!section) section = around_anomaly(s, candidates);
    if (!section)
        throw core::InputError(job.source,
                               "sampling: no line across the rulings can be touched on both sides of the anomaly: "
                               "widen the sampling boundary near " +
                                   job::point_text(job::rotation_working_machine(theta).transpose() *
                                                       Eigen::Vector2d(s.middle_u, s.middle_v),
                                                   job.units));
    TouchPlan plan;
    Eigen::Matrix2Xd line(2, 3);
    const auto& [v, u] = *ruling;
    line << u.first, (u.first + u.second) / 2, u.second, v, v, v;
    append_line(plan, line, theta, 0, {Role::ruling_line, Role::ruling_line, Role::ruling_line});
    append_line(plan, *section, theta, 1,
                {Role::section_curve, Role::section_curve, Role::section_curve, Role::section_curve});
    return plan;
}

} // namespace fettle::sampling
