#include "plan/wheel_section.h"

#include <cmath>

namespace fettle {

namespace {
// The wheel touches a slope of 53° at 0.8 of its radius from the middle; steeper surfaces do not face up.
constexpr double kReachOfCircle = 0.8;
} // namespace

double WheelSection::rise(double d) const { return round ? radius - std::sqrt(radius * radius - d * d) : 0; }

WheelSections wheel_sections(double radius, double width, char axis)
{
    const WheelSection edge{false, 0, width / 2};
    const WheelSection circle{true, radius, kReachOfCircle * radius};
    return axis == 'y' ? WheelSections{edge, circle} : WheelSections{circle, edge};
}

Eigen::Matrix2d pass_axes(const Job& job)
{
    const Eigen::Matrix2d machine_working = rotation_working_machine(job.theta).transpose();
    return job.feed.axis == 'y' ? machine_working : Eigen::Matrix2d(machine_working.rowwise().reverse());
}

} // namespace fettle
