#include "sampling/swept.h"

#include "core/error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fettle {

namespace {

// Frame D of this file: W turned so that the rulings run along X_d (coordinate u) and sections along Y_d (v).

// Choices as good as each other within this share of the size are a tie, which rounding must not decide.
constexpr double kTie = 1e-9;

// Lines are tried through every corner and at these shares of the gap between neighbouring corners: the middle is
// clear of both, the outer ones come near the best where it lies at a corner that the anomaly itself occupies.
constexpr std::array<double, 3> kSharesOfGap = {0.1, 0.5, 0.9};

// More corners than an operator touches (a boundary traced by a scanner) are thinned, to keep the search quick.
constexpr std::size_t kMostCorners = 200;

// A stretch of a section line, at u.
struct Stretch {
    double u;
    Interval v;

    double length() const { return v.second - v.first; }
};

struct Search {
    Boundaries both;     // D
    double least;        // shorter stretches are no use, mm
    double tie;          // mm
    Interval width;      // of the anomaly across the rulings: what the section has to cover
    double middle_u = 0; // of the anomaly
    double middle_v = 0;

    std::vector<Interval> free_along(double v) const { return free({0, v}, Eigen::Vector2d::UnitX()); }
    std::vector<Interval> free_across(double u) const { return free({u, 0}, Eigen::Vector2d::UnitY()); }

  private:
    std::vector<Interval> free(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction) const
    {
        return subtract(inside(both.sampling, origin, direction), inside(both.anomaly, origin, direction), least);
    }
};

Search search(const Job& job)
{
    const Eigen::Matrix2d turn = rotation_working_machine(job.direction);
    const Boundaries both = boundaries(job);
    Search result;
    result.both = {turn * both.anomaly, turn * both.sampling};
    result.least = job.probe.accuracy;
    const Eigen::Vector2d low = result.both.anomaly.rowwise().minCoeff();
    const Eigen::Vector2d high = result.both.anomaly.rowwise().maxCoeff();
    result.width = {low.y(), high.y()};
    result.middle_u = (low.x() + high.x()) / 2;
    result.middle_v = (low.y() + high.y()) / 2;
    result.tie = kTie * (result.both.sampling.rowwise().maxCoeff() - result.both.sampling.rowwise().minCoeff()).norm();
    return result;
}

// Corners, and places in the gaps between them.
std::vector<double> places_to_try(std::vector<double> corners)
{
    std::sort(corners.begin(), corners.end());
    if (corners.size() > kMostCorners) {
        std::vector<double> thinned;
        for (std::size_t i = 0; i < kMostCorners; ++i)
            thinned.push_back(corners[i * (corners.size() - 1) / (kMostCorners - 1)]);
        corners = thinned;
    }
    std::vector<double> places;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        places.push_back(corners[i]);
        if (i + 1 < corners.size())
            for (const double share : kSharesOfGap)
                places.push_back(corners[i] + share * (corners[i + 1] - corners[i]));
    }
    return places;
}

std::vector<double> corner_coordinates(const Search& s, int axis)
{
    std::vector<double> corners;
    for (const Polygon& polygon : {s.both.anomaly, s.both.sampling})
        for (Eigen::Index i = 0; i < polygon.cols(); ++i) corners.push_back(polygon(axis, i));
    return corners;
}

// Also where the sampling boundary crosses the limits of the width: there a line begins or ceases to cover it.
std::vector<double> section_places(const Search& s)
{
    std::vector<double> corners = corner_coordinates(s, 0);
    for (const double v : {s.width.first, s.width.second})
        for (const Interval& stretch : inside(s.both.sampling, {0, v}, Eigen::Vector2d::UnitX()))
            corners.insert(corners.end(), {stretch.first, stretch.second});
    return places_to_try(corners);
}

// Is (value, penalty) better than the best so far? Larger value, on a tie smaller penalty, on a tie the earlier one.
struct Best {
    double value = -std::numeric_limits<double>::infinity();
    double penalty = 0;

    bool improved_by(double other_value, double other_penalty, double tie)
    {
        const bool better = other_value > value + tie || (other_value > value - tie && other_penalty < penalty - tie);
        if (better) value = other_value, penalty = other_penalty;
        return better;
    }
};

// Step 3: along the rulings, v and the stretch of u.
std::optional<std::pair<double, Interval>> ruling_line(const Search& s)
{
    std::optional<std::pair<double, Interval>> longest;
    Best best;
    for (const double v : places_to_try(corner_coordinates(s, 1)))
        for (const Interval& u : s.free_along(v))
            if (best.improved_by(u.second - u.first, std::abs(v - s.middle_v), s.tie)) longest = {v, u};
    return longest;
}

Eigen::Matrix2Xd at(double u, const Eigen::Vector4d& v)
{
    Eigen::Matrix2Xd points(2, 4);
    points << Eigen::RowVector4d::Constant(u), v.transpose();
    return points;
}

// (a) The line nearest to the anomaly that is free over its whole width.
std::optional<Eigen::Matrix2Xd> whole_width(const Search& s, const std::vector<double>& places)
{
    std::optional<Eigen::Matrix2Xd> section;
    Best best;
    for (const double u : places)
        for (const Interval& v : s.free_across(u)) {
            if (v.first > s.width.first + s.tie || v.second < s.width.second - s.tie) continue;
            if (best.improved_by(0, std::abs(u - s.middle_u), s.tie))
                section = at(u, Eigen::Vector4d::LinSpaced(s.width.first, s.width.second));
        }
    return section;
}

// One stretch only: its ends, then what is free on the same line nearest to the uncovered ends of the width.
Eigen::Matrix2Xd single_stretch(const Search& s, const Stretch& only)
{
    const double p = only.v.first, q = only.v.second;
    std::optional<double> below, above;
    for (const Interval& v : s.free_across(only.u)) {
        if (v.second < p - s.tie) below = v.second;
        if (v.first > q + s.tie && !above) above = v.first;
    }
    if (below && above) return at(only.u, {*below, p, q, *above});
    if (above) return at(only.u, {p, (p + q) / 2, q, *above});
    if (below) return at(only.u, {*below, p, (p + q) / 2, q});
    return at(only.u, Eigen::Vector4d::LinSpaced(p, q));
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
    // Together one stretch: their inner ends may coincide, so four uniform points, each on the line that is free there.
    const Eigen::Vector4d v = Eigen::Vector4d::LinSpaced(low.v.first, std::max(low.v.second, high.v.second));
    for (Eigen::Index i = 0; i < 4; ++i) points.col(i) << (v[i] <= low.v.second + s.tie ? low.u : high.u), v[i];
    return points;
}

// (b) The two stretches that together cover most of the width.
std::optional<Eigen::Matrix2Xd> part_of_width(const Search& s, const std::vector<double>& places)
{
    std::vector<Stretch> stretches;
    for (const double u : places)
        for (const Interval& v : intersect(s.free_across(u), {s.width}, s.least)) stretches.push_back({u, v});
    if (stretches.empty()) return std::nullopt;

    std::pair<std::size_t, std::size_t> chosen;
    Best best;
    for (std::size_t i = 0; i < stretches.size(); ++i)
        for (std::size_t j = i; j < stretches.size(); ++j) {
            const Stretch &p = stretches[i], &q = stretches[j];
            const double shared = std::min(p.v.second, q.v.second) - std::max(p.v.first, q.v.first);
            const double covered = p.length() + q.length() - std::max(shared, 0.0);
            // on one line the touches need no slope of the rulings to be compared
            const double apart = std::abs(p.u - q.u);
            const double away = std::abs(p.u - s.middle_u) + std::abs(q.u - s.middle_u);
            if (best.improved_by(covered, apart + away, s.tie)) chosen = {i, j};
        }
    return touches_on(s, stretches[chosen.first], stretches[chosen.second]);
}

// (c) The longest line across, where it crosses S and B.
std::optional<Eigen::Matrix2Xd> around_anomaly(const Search& s, const std::vector<double>& places)
{
    std::optional<Eigen::Matrix2Xd> section;
    Best best;
    for (const double u : places) {
        const auto v = crossings_around(s.both, {u, 0}, Eigen::Vector2d::UnitY(), s.least);
        if (v && best.improved_by((*v)[3] - (*v)[0], std::abs(u - s.middle_u), s.tie)) section = at(u, *v);
    }
    return section;
}

} // namespace

TouchPlan plan_swept(const Job& job)
{
    const Search s = search(job);
    const double theta = job.theta + job.direction; // from X_m to X_d
    const auto ruling = ruling_line(s);
    if (!ruling)
        throw InputError(job.source, "sampling: no line along the rulings is free of the anomaly: widen the sampling "
                                     "boundary");
    const std::vector<double> places = section_places(s);
    std::optional<Eigen::Matrix2Xd> section = whole_width(s, places);
    if (!section) section = part_of_width(s, places);
    if (!section) section = around_anomaly(s, places);
    if (!section)
        throw InputError(
            job.source, "sampling: no line across the rulings can be touched on both sides of the anomaly: "
                        "widen the sampling boundary near " +
                            place(rotation_working_machine(theta).transpose() * Eigen::Vector2d(s.middle_u, s.middle_v),
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

} // namespace fettle
