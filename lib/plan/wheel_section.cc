#include "plan/wheel_section.h"

#include <cmath>

namespace fettle::plan {

double WheelSection::rise(double d) const { return round ? radius - std::sqrt(radius * radius - d * d) : 0; }

WheelSections wheel_sections(double radius, double width, char axis)
{
    // A slope of 53° touches the wheel at 0.8 of its radius from the middle; steeper surfaces do not face up.
    constexpr double kCircleReachRadii = 0.8;
    const WheelSection edge{false, 0, width / 2};
    const WheelSection circle{true, radius, kCircleReachRadii * radius};
    return axis == 'y' ? WheelSections{edge, circle} : WheelSections{circle, edge};
}

Eigen::Matrix2d pass_axes(const job::Job& job)
{
    const Eigen::Matrix2d machine_working = job::rotation_working_machine(job.theta).transpose();
    return job.feed.axis == 'y' ? machine_working : Eigen::Matrix2d(machine_working.rowwise().reverse());
}

} // namespace fettle::plan
