#include "plan/wheel_fit.h"

#include "core/error.h"
#include "core/text.h"
#include "job/boundary.h"

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {

// B is looked at every quarter of the wheel's smaller dimension, but no finer than this across.
constexpr double kPlacesPerWheel = 4;
constexpr int kMostPlacesAcross = 64;
// Curvature is taken over this share of the wheel's dimension: shorter bumps, the wheel bridges.
constexpr double kCurvatureSpan = 0.03125;
// Surfaces are fitted to touches; a radius equal to the wheel's within rounding fits.
constexpr double kRounding = 1e-9;

// Points of W inside B: its corners and a lattice.
Eigen::Matrix2Xd places_inside(const Polygon& region, double spacing)
{
    const Eigen::Vector2d low = region.rowwise().minCoeff(), size = region.rowwise().maxCoeff() - low;
    const double step = std::max(spacing, size.maxCoeff() / kMostPlacesAcross);
    std::vector<Eigen::Vector2d> places;
    for (Eigen::Index i = 0; i < region.cols(); ++i) places.emplace_back(region.col(i));
    for (double y = low.y(); y <= low.y() + size.y(); y += step)
        for (double x = low.x(); x <= low.x() + size.x(); x += step)
            if (contains(region, {x, y})) places.emplace_back(x, y);
    Eigen::Matrix2Xd result(2, Eigen::Index(places.size()));
    for (std::size_t i = 0; i < places.size(); ++i) result.col(Eigen::Index(i)) = places[i];
    return result;
}

// Of the vertical sections through the points, positive in a hollow, 1/mm. @param h  distance of before, here, after
Eigen::ArrayXd curvatures(const Eigen::ArrayXd& here, const Eigen::ArrayXd& before, const Eigen::ArrayXd& after,
                          double h)
{
    const Eigen::ArrayXd slope = (after - before) / (2 * h);
    return (after - 2 * here + before) / (h * h) / (1 + slope.square()).sqrt().cube();
}

} // namespace

void check_wheel_fits(const Job& job, const Surface& surface)
{
    const double radius = job.wheel.radius, width = job.wheel.width;
    const Eigen::Matrix2d machine_working = rotation_working_machine(job.theta).transpose();
    const Eigen::Matrix2Xd xy =
        machine_working * places_inside(boundaries(job).anomaly, std::min(radius, width) / kPlacesPerWheel);
    const Eigen::VectorXd z = heights(surface, xy);
    for (Eigen::Index i = 0; i < z.size(); ++i)
        if (std::isnan(z[i]))
            throw InputError(job.source,
                             "the surface is not defined at " + place(xy.col(i), job.units) + " inside the anomaly");

    const auto beside = [&](int axis, double distance) -> Eigen::VectorXd {
        return heights(surface, xy.colwise() + distance * machine_working.col(axis));
    };
    const Eigen::ArrayXd hollow =
        curvatures(z, beside(1, -kCurvatureSpan * radius), beside(1, kCurvatureSpan * radius), kCurvatureSpan * radius);
    const Eigen::ArrayXd bend =
        curvatures(z, beside(0, -kCurvatureSpan * width), beside(0, kCurvatureSpan * width), kCurvatureSpan * width);
    const auto in_units = [&](double length) { return to_short_text(length / job.units.mm()); };
    for (Eigen::Index i = 0; i < z.size(); ++i) {
        if (hollow[i] * radius > 1 + kRounding)
            throw InputError(job.source, "wheel.radius: " + in_units(radius) + " does not fit the hollow of radius " +
                                             in_units(1 / hollow[i]) + " at " + place(xy.col(i), job.units));
        const double sag = width * width * std::abs(bend[i]) / 8;
        if (sag > job.tolerance * (1 + kRounding))
            throw InputError(job.source, "wheel.width: " + in_units(width) + " across a curvature of radius " +
                                             in_units(1 / std::abs(bend[i])) + " at " + place(xy.col(i), job.units) +
                                             " stands off by " + in_units(sag) + ", more than the tolerance " +
                                             in_units(job.tolerance));
    }
}

} // namespace fettle
