#include "find/jobs.h"

#include "core/constants.h"
#include "core/text.h"
#include "find/job_outlines.h"
#include "find/plane_choice.h"
#include "find/ring_fit.h"
#include "find/view.h"
#include "job/boundary.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fettle::find {
namespace {

// Radius in cells of the square about a corner of a boundary whose median is the corner's height.
constexpr int kCornerReach = 1;

// The part departs from a surface where its distance exceeds so many standard deviations of the metal around.
constexpr double kLeavingSds = 4;
constexpr int kMaxDegree = 3; // of that surface: a fourth degree would follow a fillet

// Beyond an edge the part lies at least this far below that surface, which is more than a sloped surface falls per
// cell.
constexpr double kFallCells = 2;

/// Corners with the height of the part at each; NaN where nothing is seen.
Eigen::Matrix3Xd with_heights(const Eigen::Matrix2Xd& polygon, const HeightMap& map)
{
    Eigen::Matrix3Xd corners(3, polygon.cols());
    const cv::Rect whole(0, 0, map.z.cols, map.z.rows);
    for (Eigen::Index k = 0; k < polygon.cols(); ++k) {
        const cv::Point cell = map.cell_of(polygon.col(k));
        const cv::Rect about =
            cv::Rect(cell.x - kCornerReach, cell.y - kCornerReach, 2 * kCornerReach + 1, 2 * kCornerReach + 1) & whole;
        const std::vector<double> heights =
            about.empty() ? std::vector<double>() : values_in(map.z(about), finite(map.z(about)));
        corners.col(k) << polygon.col(k), heights.empty() ? core::kNaN : quantile_of(heights, 0.5);
    }
    return corners;
}

/// The places between B and S as the part's map has them, 3xN.
Eigen::Matrix3Xd metal_around(const FoundAnomaly& anomaly, const HeightMap& map)
{
    std::vector<Eigen::Vector3d> places;
    for (int y = 0; y < map.z.rows; ++y)
        for (int x = 0; x < map.z.cols; ++x) {
            const Eigen::Vector2d p = map.point_at(x, y);
            if (!std::isnan(map.z(y, x)) && job::contains(anomaly.sampling, p) && !job::contains(anomaly.boundary, p))
                places.emplace_back(p.x(), p.y(), double(map.z(y, x)));
        }
    return job::columns_to_matrix(places);
}

/// The robust surface through the metal between B and S; nothing if that is too little.
std::optional<RingFit> surface_beneath(const FoundAnomaly& anomaly, const HeightMap& map)
{
    const Eigen::Matrix3Xd metal = metal_around(anomaly, map);
    Eigen::VectorXd weights(metal.cols());
    for (Eigen::Index i = 0; i < metal.cols(); ++i) {
        const Eigen::Vector2d place = metal.col(i).head<2>();
        const double distance = (nearest_on(anomaly.boundary, place) - place).norm();
        weights[i] = 1 / (1 + distance / map.cell); // the metal near B determines the surface beneath it
    }
    return fit_ring({metal.topRows<2>(), metal.row(2), weights}, map.sigma, kMaxDegree);
}

/// The seen cells and single gaps between them, without the sides of the part beyond its edges.
Mask cells_of_part(const HeightMap& map, const std::optional<RingFit>& surface)
{
    Mask part = closed(finite(map.z), 1);
    if (!surface) return part;
    const double fall = std::max(kLeavingSds * std::max(surface->sd, map.sigma), kFallCells * map.cell);
    for (int y = 0; y < part.rows; ++y)
        for (int x = 0; x < part.cols; ++x) {
            const Eigen::Vector2d place = map.point_at(x, y);
            if (double(map.z(y, x)) < surface->z_at(place.x(), place.y()) - fall) part(y, x) = 0; // false for NaN
        }
    return part;
}

/// S with each corner moved towards B until no edge, fillet or hole lies between: a place where nothing is seen, or
/// where the part departs from the robust surface through the metal between B and S. The anomaly's frame may be oblique
/// to the view in which it was found, and edges then have other places.
Eigen::Matrix2Xd before_edges(const FoundAnomaly& anomaly, const HeightMap& map, const Mask& part,
                              const RingFit& surface)
{
    const double limit = kLeavingSds * std::max(surface.sd, map.sigma);
    const auto is_on_surface = [&](const Eigen::Vector2d& place) {
        const cv::Point cell = map.cell_of(place);
        if (!cv::Rect({0, 0}, map.z.size()).contains(cell)) return false;
        return std::abs(double(map.z(cell)) - surface.z_at(place.x(), place.y())) <= limit; // false for NaN
    };
    return sampling_before_edges(anomaly, map, part, is_on_surface);
}

/// Largest height that the wheel may meet: that of the part within the wheel's radius about S, mm.
double highest_under_wheel(const FoundAnomaly& anomaly, const HeightMap& map, double radius)
{
    const cv::Point low = map.cell_of(anomaly.sampling.rowwise().minCoeff().array() - radius),
                    high = map.cell_of(anomaly.sampling.rowwise().maxCoeff().array() + radius);
    const Image way = map.z(cv::Rect(low, high + cv::Point(1, 1)) & cv::Rect(0, 0, map.z.cols, map.z.rows));
    double highest = 0;
    if (cv::countNonZero(finite(way)) > 0) cv::minMaxLoc(way, nullptr, &highest, nullptr, nullptr, finite(way));
    return highest;
}

// A pass has no sense of direction: half a turn changes nothing on a gantry, but a robot's wrist would flip between
// jobs whose wheels look opposite ways. So all wheels' axes look along this direction of the part, not against it. It
// is none that axes of a part's faces and edges are often normal to.
const Eigen::Vector3d kCommonDirection(3, 2, 1);

/// θ with which the feed's axis runs along the longer side of the smallest rectangle about B, rad.
double theta_along(const Eigen::Matrix2Xd& boundary, char feed_axis, const Eigen::Matrix3d& R_part_job)
{
    std::vector<cv::Point2f> corners;
    for (const auto& corner : boundary.colwise())
        corners.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
    const cv::RotatedRect box = cv::minAreaRect(corners);
    const double quarter = core::kRadPerDegree * 90;
    const double along = core::kRadPerDegree * double(box.angle) + (box.size.width >= box.size.height ? 0 : quarter);
    const double theta = feed_axis == 'x' ? along : along - quarter;
    const Eigen::Vector3d axis = R_part_job * Eigen::Vector3d(std::cos(theta), std::sin(theta), 0);
    return std::remainder(axis.dot(kCommonDirection) < 0 ? theta + 2 * quarter : theta, 4 * quarter);
}

// A fitted surface is locally more curved than this one, so only these shares of sag and radius are allowed.
constexpr double kSagShare = 0.4, kRadiusShare = 0.8;
constexpr int kCurvaturePoints = 12; // along the longer side of B

/// The largest wheel that fits a surface; infinity: any does.
struct WheelLimits {
    double width = core::kInfinity, radius = core::kInfinity; ///< mm

    bool allow(const job::GrindingWheel& wheel) const { return wheel.width <= width && wheel.radius <= radius; }
};

/// The limits of a job's wheel (as plan/wheel_fit.h): over the width the surface may sag by the tolerance, and no
/// hollow may be sharper than the wheel.
WheelLimits wheel_limits(const job::Job& job, const RingFit& surface)
{
    const job::Polygon boundary = job::working_boundaries(job).anomaly;
    const Eigen::Matrix2d R = job::rotation_working_machine(job.theta).transpose(); // columns: the wheel's axis, feed
    const Eigen::AlignedBox2d box(boundary.rowwise().minCoeff(), boundary.rowwise().maxCoeff());
    const double step = box.sizes().maxCoeff() / kCurvaturePoints;
    const auto curvature = [&](const Eigen::Vector2d& at, const Eigen::Vector2d& along, double h) {
        const auto z = [&](double t) { return surface.z_at(at.x() + t * along.x(), at.y() + t * along.y()); };
        const double slope = (z(h) - z(-h)) / (2 * h);
        return (z(h) - 2 * z(0) + z(-h)) / (h * h) / std::pow(1 + slope * slope, 1.5);
    };
    double across = 0, hollow = 0; // largest curvatures along the axis, and concave ones along the feed, 1/mm
    for (double y = box.min().y(); y <= box.max().y(); y += step)
        for (double x = box.min().x(); x <= box.max().x(); x += step) {
            if (!job::contains(boundary, {x, y})) continue;
            const Eigen::Vector2d at = R * Eigen::Vector2d(x, y);
            across = std::max(across, std::abs(curvature(at, R.col(0), job.wheel.width / 2)));
            hollow = std::max(hollow, curvature(at, R.col(1), step));
        }
    WheelLimits limits;
    if (across > 0) limits.width = std::sqrt(8 * kSagShare * job.tolerance / across);
    if (hollow > 0) limits.radius = kRadiusShare / hollow;
    return limits;
}

void copy_wheel_settings(const job::Job& other, job::Job& job)
{
    job.wheel = other.wheel;
    job.feed.rate = other.feed.rate;
    job.feed.step_over = other.feed.step_over;
    job.force = other.force;
    job.removal_coefficient = other.removal_coefficient;
}

/// Chooses the first wheel that fits; if none does, the template's becomes as narrow and as small as it must be.
/// @return  why it is not the template's own; empty: it is
std::string fit_wheel(job::Job& job, const RingFit& surface, std::span<const job::Job> others)
{
    const auto in_units = [&](double length) {
        return core::to_short_text(length / job.units.mm()) + " " + units::to_string(job.units.length);
    };
    const WheelLimits limits = wheel_limits(job, surface);
    if (limits.allow(job.wheel)) return "";
    const std::string why = limits.width < job.wheel.width
                                ? "the surface bends too much across a wheel " + in_units(job.wheel.width) + " wide"
                                : "the surface is too hollow for a wheel of radius " + in_units(job.wheel.radius);
    for (const job::Job& other : others) {
        job::Job tried = job;
        copy_wheel_settings(other, tried);
        if (!wheel_limits(tried, surface).allow(tried.wheel)) continue;
        job = tried;
        return why + ": that of " + other.source + " fits";
    }
    const double narrower = std::min(1.0, limits.width / job.wheel.width),
                 smaller = std::min(1.0, limits.radius / job.wheel.radius);
    job.wheel.width *= narrower;
    job.feed.step_over *= narrower;
    job.wheel.radius *= smaller;
    job.wheel.min_radius *= smaller;
    return why + ": it takes one of radius " + in_units(job.wheel.radius) + " and width " + in_units(job.wheel.width);
}

} // namespace

void add_scatter_doubts(FindResult& result, const job::Job& settings)
{
    const double mm = settings.units.mm();
    for (FoundAnomaly& anomaly : result.anomalies) {
        const double sd = anomaly.height / anomaly.significance;
        if (!(sd > settings.tolerance)) continue;
        anomaly.doubt += (anomaly.doubt.empty() ? "" : "; ") + std::string("the metal around scatters by ") +
                         core::to_short_text(sd / mm) + ", more than the tolerance of --template, " +
                         core::to_short_text(settings.tolerance / mm) + " " + units::to_string(settings.units.length) +
                         ": merge more scans, or state a larger tolerance";
    }
}

FoundJob job_for(const FoundAnomaly& found, const mesh::CloudMesh& part, const job::Job& settings,
                 std::span<const job::Job> others)
{
    FoundAnomaly anomaly = found;
    HeightMap map = height_map(part, anomaly.T_anomaly_part);
    clean(map, !part.is_mesh()); // single holes are no edges
    const std::optional<RingFit> beneath = surface_beneath(anomaly, map);
    const Mask seen = cells_of_part(map, beneath);
    anomaly.boundary = clipped_to_part(anomaly.boundary, map, seen);
    if (beneath) anomaly.sampling = before_edges(anomaly, map, seen, *beneath);
    job::Job job = settings;
    job.T_part_job = anomaly.T_anomaly_part.inverse();
    job.theta = theta_along(anomaly.boundary, settings.feed.axis, job.T_part_job->linear());
    job.surface = job::SurfaceType::freeform;
    if (beneath) {
        FoundAnomaly touched = anomaly;
        touched.boundary = with_plane_corners(anomaly, map, *beneath, settings);
        if (is_plane_better(touched, map, *beneath, settings)) {
            job.surface = job::SurfaceType::plane;
            anomaly.boundary = touched.boundary;
        }
    }
    job.anomaly = with_heights(anomaly.boundary, map);
    job.sampling = with_heights(anomaly.sampling, map);
    const std::string wheel = beneath ? fit_wheel(job, *beneath, others) : "";
    job.is_safe_height_known = true;
    job.safe_height = highest_under_wheel(anomaly, map, job.wheel.radius) + job::kTravelClearance;
    return {job::validated(job, "row " + std::to_string(anomaly.number)), wheel};
}

} // namespace fettle::find
