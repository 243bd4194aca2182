#include "plan/wheel_fit.h"

#include "core/error.h"
#include "core/text.h"
#include "geometry/bounding_box.h"
#include "job/boundary.h"

#include <algorithm>
#include <cmath>

namespace fettle::plan {

namespace {

// Number of test points per smaller dimension of the wheel, and their largest number along a side of B.
constexpr double kPointsPerWheel = 4;
constexpr int kMaxPointsPerSide = 64;
// Step of the finite differences for the curvature at a point, relative to the wheel's dimension.
constexpr double kRelativeStep = 0.03125;
// Relative rounding: a fitted surface with exactly the wheel's radius must pass.
constexpr double kRelativeRounding = 1e-9;

// Test points in W: the corners of B and a lattice inside.
Eigen::Matrix2Xd test_points(const job::Polygon& region, double spacing)
{
    const Eigen::AlignedBox2d box = geometry::bounding_box(region);
    const Eigen::Vector2d low = box.min(), size = box.sizes();
    const double step = std::max(spacing, size.maxCoeff() / kMaxPointsPerSide);
    std::vector<Eigen::Vector2d> points;
    for (Eigen::Index i = 0; i < region.cols(); ++i) points.emplace_back(region.col(i));
    for (double y = low.y(); y <= low.y() + size.y(); y += step)
        for (double x = low.x(); x <= low.x() + size.x(); x += step)
            if (job::contains(region, {x, y})) points.emplace_back(x, y);
    return Eigen::Map<Eigen::Matrix2Xd>(points[0].data(), 2, points.size());
}

// Curvatures of vertical sections through the points, positive if concave, 1/mm. @param h  step of the differences, mm
Eigen::ArrayXd curvatures(const Eigen::ArrayXd& here, const Eigen::ArrayXd& before, const Eigen::ArrayXd& after,
                          double h)
{
    const Eigen::ArrayXd slope = (after - before) / (2 * h);
    return (after - 2 * here + before) / (h * h) / (1 + slope.square()).sqrt().cube();
}

} // namespace

void check_wheel_fits(const job::Job& job, const surface::Surface& surface)
{
    const double radius = job.wheel.radius, width = job.wheel.width;
    const Eigen::Matrix2d machine_working = job::rotation_working_machine(job.theta).transpose();
    const Eigen::Matrix2Xd xy =
        machine_working * test_points(job::working_boundaries(job).anomaly, std::min(radius, width) / kPointsPerWheel);
    const Eigen::VectorXd z = surface::heights(surface, xy);
    for (Eigen::Index i = 0; i < z.size(); ++i)
        if (std::isnan(z[i]))
            throw core::InputError(job.source, "the surface is not defined at " +
                                                   job::point_text(xy.col(i), job.units) + " inside the anomaly");

    const auto curvatures_along = [&](int axis, double h) {
        const Eigen::Vector2d step = h * machine_working.col(axis);
        return curvatures(z, surface::heights(surface, xy.colwise() - step),
                          surface::heights(surface, xy.colwise() + step), h);
    };
    const Eigen::ArrayXd in_plane = curvatures_along(1, kRelativeStep * radius);
    // The mean curvature over the wheel's width: the edge spans waves that are shorter than it is. Beyond the border of
    // the surface, where it is not defined, the curvature at the point.
    const Eigen::ArrayXd over_width = curvatures_along(0, width / 2);
    const Eigen::ArrayXd along_axis = over_width.isNaN().select(curvatures_along(0, kRelativeStep * width), over_width);
    const auto in_units = [&](double length) { return core::to_short_text(length / job.units.mm()); };
    for (Eigen::Index i = 0; i < z.size(); ++i) {
        if (in_plane[i] * radius > 1 + kRelativeRounding)
            throw core::InputError(job.source, "wheel.radius: " + in_units(radius) +
                                                   " does not fit the hollow of radius " + in_units(1 / in_plane[i]) +
                                                   " at " + job::point_text(xy.col(i), job.units));
        const double sag = width * width * std::abs(along_axis[i]) / 8;
        if (sag > job.tolerance * (1 + kRelativeRounding))
            throw core::InputError(job.source, "wheel.width: " + in_units(width) + " across a curvature of radius " +
                                                   in_units(1 / std::abs(along_axis[i])) + " at " +
                                                   job::point_text(xy.col(i), job.units) + " stands off by " +
                                                   in_units(sag) + ", more than the tolerance " +
                                                   in_units(job.tolerance));
    }
}

} // namespace fettle::plan
