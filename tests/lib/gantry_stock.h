// Stocks, a job and a drive for tests and benchmarks of the gantries.
#pragma once

#include "gantry/machine.h"
#include "job/job.h"
#include "removal/height_field.h"

#include <cmath>
#include <functional>

namespace fettle {

inline constexpr double kTop = 10; // z of the flat stock

inline job::Job small_job()
{
    job::Job job;
    job.wheel = {.radius = 25.4, .width = 6.4, .min_radius = 12.7};
    job.force = {.min = 20, .down = 40, .max = 60, .stiffness = 35, .preload = 0};
    job.removal_coefficient = 7.4;
    job.safe_height = 30;
    return job;
}

/// A drive of 80 kg that moves at up to 100 mm/s. @param following_error  at which it stops, mm
inline gantry::Drive drive_of_80_kg(double following_error)
{
    return {.mass = 0.08,
            .damping = 1.5,
            .gain = 12,
            .load = 0,
            .voltage = 60,
            .current = 40,
            .emf = 0.05,
            .encoder = 0.0005,
            .speed = 100,
            .acceleration = 1000,
            .min_position = -500,
            .max_position = 500,
            .following_error = following_error};
}

/// 16 mm along X_w, 140 mm along Y_w. @param height  over W
inline removal::HeightField stock(const std::function<double(double, double)>& height, double cell = 0.1,
                                  double theta = 0, const Eigen::Vector2d& shift = {0, 0})
{
    const Eigen::AlignedBox2d box(Eigen::Vector2d(-8, -70), Eigen::Vector2d(8, 70));
    removal::HeightField field = removal::empty_height_field(box.translated(shift), {0, 0}, theta, cell);
    for (Eigen::Index j = 0; j < field.rows(); ++j)
        for (Eigen::Index i = 0; i < field.columns(); ++i) {
            const Eigen::Vector2d at = field.centre(i, j) - shift;
            field.z(i, j) = height(at.x(), at.y());
        }
    return field;
}

inline removal::HeightField flat(double cell = 0.1)
{
    return stock([](double, double) { return kTop; }, cell);
}

/// A ramp and a bump, smooth.
inline double hills(double x, double y) { return 8 + 2 * std::exp(-(x * x + y * y) / 200) + 0.02 * y; }

} // namespace fettle
