#include "plan/tool_path.h"

#include "core/constants.h"
#include "core/error.h"

#include <array>
#include <cmath>

namespace fettle::plan {

namespace {

// Number of samples of a wheel section. Between them the contact is interpolated by a parabola, whose error is of third
// order in their distance: below 1e-4 mm for a wheel of 25 mm on a slope of 0.3.
constexpr int kEdgeSamples = 9;
constexpr int kCircleSamples = 41;
// Number of samples of the surface along the passes per radius (or width) of the wheel.
constexpr double kSamplesPerRadius = 24;

// Relative rounding of a length that is a whole number of steps: B rotated, or in inches, must get the same points.
constexpr double kLengthRounding = 1e-9;

// Rounding of interpolated heights, mm: smaller differences do not make a better position.
constexpr double kHeightRounding = 1e-6;

int sample_count(const WheelSection& section) { return section.round ? kCircleSamples : kEdgeSamples; }

// Maximum of uniform samples, refined by the parabola through the largest one and its neighbours; NaN if all are NaN.
double interpolated_max(const double* samples, int count)
{
    int top = -1;
    for (int i = 0; i < count; ++i)
        if (!std::isnan(samples[i]) && (top < 0 || samples[i] > samples[top])) top = i;
    if (top < 0) return core::kNaN;
    if (top == 0 || top + 1 == count) return samples[top];
    const double rise = samples[top + 1] - samples[top - 1];
    const double curvature = 2 * samples[top] - samples[top + 1] - samples[top - 1];
    return curvature > 0 ? samples[top] + rise * rise / (8 * curvature) : samples[top]; // false for NaN, too
}

// Height of the wheel's lowest point when it rests on the profile height(d), d from the middle of the section.
template <typename Height>
double resting_height(const WheelSection& section, const Height& height)
{
    std::array<double, kCircleSamples> z{};
    const int n = sample_count(section);
    for (int i = 0; i < n; ++i) {
        const double d = section.reach * (2.0 * i / (n - 1) - 1);
        z[i] = height(d) - section.rise(std::abs(d));
    }
    return interpolated_max(z.data(), n);
}

} // namespace

// Quadratic interpolation of the three nearest samples; linear at an end or next to NaN.
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

ToolPath::ToolPath(const job::Job& job, const surface::Surface& surface, const std::vector<Pass>& passes, double step)
    : surface_(&surface), axes_(pass_axes(job)), axis_(job.feed.axis), width_(job.wheel.width),
      wheel_(wheel_sections(job.wheel.radius, width_, axis_))
{
    for (std::size_t p = 0; p < passes.size(); ++p) {
        ToolPass pass;
        pass.line = passes[p].line;
        for (const job::Interval& contacts : passes[p].intervals) {
            const auto [from, to] = contacts;
            const int first = int(pass.along.size());
            const int count = std::max(2, int(std::ceil((to - from) / step * (1 - kLengthRounding))) + 1);
            pass.starts.push_back(first);
            for (int i = 0; i < count; ++i) pass.along.push_back(from + (to - from) * i / (count - 1));
            contact_intervals_.push_back({profile(pass.line, from, to), contacts, int(p), first, count});
        }
        pass.points.resize(pass.along.size());
        passes_.push_back(std::move(pass));
    }
    for (const ContactInterval& interval : contact_intervals_) set_points(interval);
    for (const ToolPass& pass : passes_)
        for (const Eigen::Vector3d& point : pass.points)
            if (!point.allFinite())
                throw core::InputError(
                    job.source, "the surface is not defined under the pass at " +
                                    job::point_text(axes_ * Eigen::Vector2d(pass.line, pass.along[0]), job.units));
}

void ToolPath::set_radius(double radius)
{
    wheel_ = wheel_sections(radius, width_, axis_);
    for (ContactInterval& interval : contact_intervals_) {
        // Only the section across the passes is part of the profile.
        if (wheel_.across.round)
            interval.profile = profile(passes_[interval.pass].line, interval.contacts.first, interval.contacts.second);
        set_points(interval);
    }
}

ToolPath::Profile ToolPath::profile(double line, double from, double to) const
{
    const WheelSection &along = wheel_.along, &across = wheel_.across;
    Profile result;
    result.spacing = (along.round ? along.radius : width_) / kSamplesPerRadius;
    // The tool is up to one reach beside its contact, and the wheel extends one reach beyond the tool.
    result.origin = from - 2 * along.reach;
    const int count = int(std::ceil((to + 2 * along.reach - result.origin) / result.spacing)) + 1;
    const int n = sample_count(across);
    Eigen::Matrix2Xd xy(2, Eigen::Index(count) * n);
    for (int k = 0; k < count; ++k)
        for (int i = 0; i < n; ++i)
            xy.col(k * n + i) = axes_ * Eigen::Vector2d(line + across.reach * (2.0 * i / (n - 1) - 1),
                                                        result.origin + k * result.spacing);
    Eigen::VectorXd z = surface::heights(*surface_, xy);
    for (int i = 0; i < n; ++i) {
        const double rise = across.rise(across.reach * std::abs(2.0 * i / (n - 1) - 1));
        for (int k = 0; k < count; ++k) z[k * n + i] -= rise;
    }
    result.z.resize(count);
    for (int k = 0; k < count; ++k) result.z[k] = interpolated_max(z.data() + k * n, n);
    return result;
}

void ToolPath::set_points(const ContactInterval& interval)
{
    const WheelSection& along = wheel_.along;
    const Profile& profile = interval.profile;
    const auto tool_height = [&](double tool) {
        return resting_height(along, [&](double d) { return profile.at(tool + d); });
    };
    // Tool position for a contact. The centre of the circle is on the surface normal of the contact. The straight edge
    // is placed as far inwards as it can be without lifting off the contact.
    const auto tool_at = [&](double contact, double inwards) {
        if (along.round) {
            const double slope =
                (profile.at(contact + profile.spacing) - profile.at(contact - profile.spacing)) / (2 * profile.spacing);
            return contact - along.radius * slope / std::hypot(1, slope);
        }
        double best = contact, min_gap = core::kInfinity;
        for (int i = 0; i < kEdgeSamples; ++i) {
            const double tool = contact + inwards * along.reach * (1 - 2.0 * i / (kEdgeSamples - 1));
            const double gap = tool_height(tool) - profile.at(contact);
            if (gap < min_gap - kHeightRounding) best = tool, min_gap = gap;
        }
        return best;
    };
    const double from = tool_at(interval.contacts.first, 1), to = tool_at(interval.contacts.second, -1);
    ToolPass& pass = passes_[interval.pass];
    for (int i = 0; i < interval.count; ++i) {
        const double tool = from + (to - from) * i / (interval.count - 1);
        pass.points[interval.first + i] << axes_ * Eigen::Vector2d(pass.line, tool), tool_height(tool);
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

} // namespace fettle::plan
