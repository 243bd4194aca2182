#include "plan/tool_path.h"

#include "core/constants.h"
#include "core/error.h"

#include <array>
#include <cmath>
#include <limits>

namespace fettle {

namespace {

// Places on the wheel where it is held against the surface. Between them the contact is found by a parabola, whose
// error is of the third order of their distance: below 1e-4 mm for a wheel of 25 mm on a slope of 0.3.
constexpr int kPlacesOnEdge = 9;
constexpr int kPlacesOnCircle = 41;
// The surface is sampled along the passes this often for each radius (or width) of the wheel.
constexpr double kSamplesPerRadius = 24;

// A length is a whole number of steps if it is within rounding: B turned, or in inches, gets the same points.
constexpr double kSameLength = 1e-9;

// Differences of height below the rounding of the interpolation do not make a better place, mm.
constexpr double kLiesOn = 1e-6;

int places(const WheelSection& section) { return section.round ? kPlacesOnCircle : kPlacesOnEdge; }

// Maximum of uniform samples, refined by the parabola through the largest and its neighbours. NaN: none there.
double greatest(const double* samples, int count)
{
    int top = -1;
    for (int i = 0; i < count; ++i)
        if (!std::isnan(samples[i]) && (top < 0 || samples[i] > samples[top])) top = i;
    if (top < 0) return std::numeric_limits<double>::quiet_NaN();
    if (top == 0 || top + 1 == count) return samples[top];
    const double rise = samples[top + 1] - samples[top - 1];
    const double bend = 2 * samples[top] - samples[top + 1] - samples[top - 1];
    return bend > 0 ? samples[top] + rise * rise / (8 * bend) : samples[top]; // false for NaN, too
}

template <typename Height>
double resting_height(const WheelSection& section, const Height& height)
{
    std::array<double, kPlacesOnCircle> gap{};
    const int n = places(section);
    for (int i = 0; i < n; ++i) {
        const double d = section.reach * (2.0 * i / (n - 1) - 1);
        gap[i] = height(d) - section.rise(std::abs(d));
    }
    return greatest(gap.data(), n);
}

} // namespace

// Quadratic through the three nearest samples; at an end or beside NaN, linear.
double ToolPath::Profile::at(double along) const
{
    const double x = (along - origin) / spacing;
    const int last = int(z.size()) - 1;
    const int i = std::clamp(int(std::lround(x)), 0, last);
    const double f = x - i, before = i > 0 ? z[i - 1] : z[i], after = i < last ? z[i + 1] : z[i];
    if (i > 0 && i < last && !std::isnan(before) && !std::isnan(after))
        return z[i] + 0.5 * f * (after - before) + 0.5 * f * f * (after - 2 * z[i] + before);
    return z[i] + (f > 0 ? f * (after - z[i]) : f * (z[i] - before));
}

ToolPath::ToolPath(const Job& job, const Surface& surface, const std::vector<Pass>& passes, double step)
    : surface_(&surface), axes_(pass_axes(job)), axis_(job.feed.axis), width_(job.wheel.width),
      wheel_(wheel_sections(job.wheel.radius, width_, axis_))
{
    for (std::size_t p = 0; p < passes.size(); ++p) {
        ToolPass pass;
        pass.line = passes[p].line;
        for (const Interval& touched : passes[p].intervals) {
            const int first = int(pass.along.size());
            const int count =
                std::max(2, int(std::ceil((touched.second - touched.first) / step * (1 - kSameLength))) + 1);
            pass.starts.push_back(first);
            for (int i = 0; i < count; ++i)
                pass.along.push_back(touched.first + (touched.second - touched.first) * i / (count - 1));
            stretches_.push_back({profile(pass.line, touched.first, touched.second), touched, int(p), first, count});
        }
        pass.points.resize(pass.along.size());
        passes_.push_back(std::move(pass));
    }
    for (const Stretch& stretch : stretches_) fill(stretch);
    for (const ToolPass& pass : passes_)
        for (const Eigen::Vector3d& point : pass.points)
            if (!point.allFinite())
                throw InputError(job.source, "the surface is not defined under the pass at " +
                                                 place(axes_ * Eigen::Vector2d(pass.line, pass.along[0]), job.units));
}

void ToolPath::set_radius(double radius)
{
    wheel_ = wheel_sections(radius, width_, axis_);
    for (Stretch& stretch : stretches_) {
        // The arc across the passes shapes the profile; the arc along them does not.
        if (wheel_.across.round)
            stretch.profile = profile(passes_[stretch.pass].line, stretch.touched.first, stretch.touched.second);
        fill(stretch);
    }
}

ToolPath::Profile ToolPath::profile(double line, double from, double to) const
{
    const WheelSection &along = wheel_.along, &across = wheel_.across;
    Profile result;
    result.spacing = (along.round ? along.radius : width_) / kSamplesPerRadius;
    // Twice the reach: the tool stands up to one reach beside the point that it touches.
    result.origin = from - 2 * along.reach;
    const int count = int(std::ceil((to + 2 * along.reach - result.origin) / result.spacing)) + 1;
    const int n = places(across);
    Eigen::Matrix2Xd xy(2, Eigen::Index(count) * n);
    for (int k = 0; k < count; ++k)
        for (int i = 0; i < n; ++i)
            xy.col(k * n + i) = axes_ * Eigen::Vector2d(line + across.reach * (2.0 * i / (n - 1) - 1),
                                                        result.origin + k * result.spacing);
    Eigen::VectorXd z = heights(*surface_, xy);
    for (int i = 0; i < n; ++i) {
        const double rise = across.rise(across.reach * std::abs(2.0 * i / (n - 1) - 1));
        for (int k = 0; k < count; ++k) z[k * n + i] -= rise;
    }
    result.z.resize(count);
    for (int k = 0; k < count; ++k) result.z[k] = greatest(z.data() + k * n, n);
    return result;
}

void ToolPath::fill(const Stretch& stretch)
{
    const WheelSection& along = wheel_.along;
    const Profile& profile = stretch.profile;
    const auto resting = [&](double tool) {
        return resting_height(along, [&](double d) { return profile.at(tool + d); });
    };
    // Where the wheel stands when it touches the surface at `touched`: in its plane the centre lies on the normal
    // there; with its straight edge it reaches from the inside as far as it can while it lies on.
    const auto tool_of = [&](double touched, double inwards) {
        if (along.round) {
            const double slope =
                (profile.at(touched + profile.spacing) - profile.at(touched - profile.spacing)) / (2 * profile.spacing);
            return touched - along.radius * slope / std::hypot(1, slope);
        }
        double best = touched, gap = kInfinity;
        for (int i = 0; i < kPlacesOnEdge; ++i) {
            const double tool = touched + inwards * along.reach * (1 - 2.0 * i / (kPlacesOnEdge - 1));
            const double standing = resting(tool) - profile.at(touched);
            if (standing < gap - kLiesOn) best = tool, gap = standing;
        }
        return best;
    };
    const double from = tool_of(stretch.touched.first, 1), to = tool_of(stretch.touched.second, -1);
    ToolPass& pass = passes_[stretch.pass];
    for (int i = 0; i < stretch.count; ++i) {
        const double tool = from + (to - from) * i / (stretch.count - 1);
        pass.points[stretch.first + i] << axes_ * Eigen::Vector2d(pass.line, tool), resting(tool);
    }
}

Eigen::Vector3d ToolPath::tool_point(const Eigen::Vector2d& across_along) const
{
    const Profile here = profile(across_along.x(), across_along.y(), across_along.y());
    Eigen::Vector3d point;
    point << axes_ * across_along,
        resting_height(wheel_.along, [&](double d) { return here.at(across_along.y() + d); });
    return point;
}

} // namespace fettle
