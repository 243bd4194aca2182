#include "job/plausible.h"

#include "core/error.h"
#include "core/text.h"
#include "geometry/bounding_box.h"
#include "geometry/quantiles.h"
#include "geometry/stray_point.h"
#include "job/boundary.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace fettle::job {

namespace {
// A part is rarely a hundred times as long as the boundary of one anomaly on it; a wrong unit (m for mm, mm for m)
// changes the ratio by a factor of a thousand.
constexpr double kMaxPartPerBoundary = 100;

/// Minimum and maximum without NaN; NaN if all are NaN.
Eigen::Vector2d range(const Eigen::RowVectorXd& z)
{
    return {z.minCoeff<Eigen::PropagateNumbers>(), z.maxCoeff<Eigen::PropagateNumbers>()};
}
/// "the part, 80 x 60 x 20 mm"
std::string describe(const std::string& part, const Eigen::Vector3d& size, const units::Units& units)
{
    const auto text = [&](double length) { return core::to_short_text(length / units.mm()); };
    return part + ", " + text(size.x()) + " x " + text(size.y()) + " x " + text(size.z()) + " " +
           units::to_string(units.length);
}

/// Is the touch the job's own measurement of a point of S, which griddata takes (fit/griddata.h)? It may have been
/// written to a file in the job's unit and read again.
bool is_taught(const Eigen::Vector3d& touch, const Job& job)
{
    constexpr double kRelativeRounding = 1e-9;
    return ((job.sampling.colwise() - touch).colwise().norm().array() <= kRelativeRounding * (1 + touch.norm())).any();
}

/// The touches on good metal that were probed for this fit: neither corners of B and S, which the job itself gives, nor
/// estimated points.
Eigen::Matrix3Xd probed(const PlacedTouches& touches, const Job& job)
{
    constexpr int kCorner = 0, kEstimated = 3;
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < touches.xyz.cols(); ++i)
        if (touches.roles[i] != kCorner && touches.roles[i] != kEstimated && touches.xyz.col(i).allFinite() &&
            !is_taught(touches.xyz.col(i), job))
            kept.push_back(i);
    return touches.xyz(Eigen::all, kept);
}

std::string in_job_unit(double length, const Job& job)
{
    return core::to_short_text(length / job.units.mm()) + " " + units::to_string(job.units.length);
}
} // namespace

std::string stray_point_warning(const Eigen::Matrix3Xd& points, const units::Units& units)
{
    const std::optional<geometry::StrayPoint> stray = geometry::find_stray_point(points);
    if (!stray) return {};
    const auto text = [&](int axis) { return core::to_short_text(points(axis, stray->index) / units.mm()); };
    return "a point at (" + text(0) + ", " + text(1) + ", " + text(2) + ") " + units::to_string(units.length) +
           " lies " + core::to_short_text(stray->ratio) +
           " times as far from the middle as half of them: is the file damaged?";
}

void require_no_stray_point(const Eigen::Matrix3Xd& points, const units::Units& units, const std::string& source)
{
    const std::string stray = stray_point_warning(points, units);
    if (!stray.empty()) throw core::InputError(source, stray);
}

std::string size_warning(const Eigen::AlignedBox3d& box, Eigen::Index points, const units::Units& units)
{
    constexpr double kMinLength = 5, kMaxLength = 100e3; // mm
    constexpr Eigen::Index kMinPoints = 20;
    const double longest = box.sizes().maxCoeff();
    const bool is_short = longest > 0 && longest < kMinLength;
    if (points < kMinPoints || !(is_short || longest > kMaxLength)) return {};
    return describe("the part", box.sizes(), units) + ", is " + (is_short ? "under 5 mm" : "over 100 m") +
           " long: is its unit right?";
}

std::string scale_warning(const std::string& part, const Eigen::Vector3d& size, const units::Units& units,
                          const LengthScale& scale)
{
    const double ratio = size.head<2>().norm() / scale.length;
    const bool is_long = ratio > scale.max_ratio;
    if (!is_long && !(ratio < scale.min_ratio)) return {};
    return describe(part, size, units) + ", is " + (is_long ? "over " : "less than ") +
           core::to_short_text(is_long ? scale.max_ratio : scale.min_ratio) + " times as long as " + scale.name +
           ": is its unit right?";
}

std::string part_box_warning(const Eigen::AlignedBox3d& box, const Job& job)
{
    const Eigen::AlignedBox2d boundary =
        geometry::bounding_box((job.sampling.cols() > 0 ? job.sampling : job.anomaly).topRows<2>());
    const std::string warning = scale_warning("the part", box.sizes(), job.units,
                                              {"the job's boundary", boundary.sizes().norm(), 0, kMaxPartPerBoundary});
    if (!warning.empty()) return warning;
    if (!Eigen::AlignedBox2d(box.min().head<2>(), box.max().head<2>()).contains(boundary))
        return describe("the part", box.sizes(), job.units) +
               ", does not contain the job's boundary: is its unit right?";
    return {};
}

std::string touch_height_warning(const Eigen::Matrix3Xd& touches, const Job& job)
{
    Eigen::Matrix3Xd boundary(3, job.anomaly.cols() + job.sampling.cols());
    boundary << job.anomaly, job.sampling;
    const Eigen::Vector2d taught = range(boundary.row(2)), touched = range(touches.row(2));
    const double length = geometry::bounding_box(boundary.topRows<2>()).sizes().norm();
    const double above = touched[0] - taught[1], below = taught[0] - touched[1];
    if (!(std::max(above, below) > length)) return {}; // also for NaN: no heights
    return "the touches lie " + core::to_short_text(std::max(above, below) / job.units.mm()) + " " +
           units::to_string(job.units.length) + (above > 0 ? " above" : " below") +
           " the job's boundary points: is the part's unit right, does it lie where the job was taught?";
}

std::string check_touch_places(const PlacedTouches& touches, const Job& job, const std::string& source)
{
    if (job.sampling.cols() == 0) return {};
    const Polygon sampling = working_boundaries(job).sampling;
    const Eigen::Matrix3Xd xyz = probed(touches, job);
    const Eigen::Matrix2d R_working_machine = rotation_working_machine(job.theta);
    // A ball touches a slope up to its radius beside its middle.
    const double allowed = job.probe.accuracy + job.probe.tip_radius;
    Eigen::Index count = 0, farthest = -1;
    double max_distance = 0;
    for (Eigen::Index i = 0; i < xyz.cols(); ++i) {
        const Eigen::Vector2d xy = R_working_machine * xyz.col(i).head<2>();
        const double distance = contains(sampling, xy) ? 0 : distance_to_edge(sampling, xy);
        if (distance <= allowed) continue;
        ++count;
        if (distance > max_distance) {
            max_distance = distance;
            farthest = i;
        }
    }
    if (count == 0) return {};
    const std::string found = std::to_string(count) + " of " + std::to_string(xyz.cols()) +
                              " touches lie outside the job's sampling boundary, the one at " +
                              point_text(xyz.col(farthest).head<2>(), job.units) + " by " +
                              in_job_unit(max_distance, job);
    if (2 * count >= xyz.cols())
        throw core::InputError(source, found + ": are they this job's, does the part lie where the job was taught?");
    return found + "; they are used";
}

std::string boundary_height_warning(const PlacedTouches& touches, const Job& job)
{
    constexpr double kMaxSlope = 1; // 45°: a part's surface is mostly flatter, and half of the points may be steeper
    const Eigen::Matrix3Xd xyz = probed(touches, job);
    if (xyz.cols() == 0) return {};
    Eigen::Matrix3Xd boundary(3, job.anomaly.cols() + job.sampling.cols());
    boundary << job.anomaly, job.sampling;
    std::vector<double> above;
    std::size_t wrong = 0;
    for (const Eigen::Vector3d& point : boundary.colwise()) {
        if (std::isnan(point.z())) continue;
        Eigen::Index nearest = 0;
        const double squared =
            (xyz.topRows<2>().colwise() - point.head<2>()).colwise().squaredNorm().minCoeff(&nearest);
        above.push_back(point.z() - xyz(2, nearest));
        wrong += std::abs(above.back()) > kMaxSlope * std::sqrt(squared) + job.tolerance;
    }
    if (2 * wrong <= above.size()) return {};
    const double offset = geometry::median(above);
    return "the job's boundary points lie " + in_job_unit(std::abs(offset), job) + (offset > 0 ? " above" : " below") +
           " the touches next to them: is their z right, does the part lie where the job was taught?";
}

} // namespace fettle::job
