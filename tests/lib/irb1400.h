#pragma once

#include "robot/robot.h"

#include <numbers>

namespace fettle {

constexpr double kDegree = std::numbers::pi / 180;

/// The arm of Chen & Wei, table 1, with joint 2 counted from the vertical and joint 3 by `coupling`.
inline robot::Robot irb1400(robot::Coupling coupling = robot::Coupling::parallelogram)
{
    robot::Robot robot;
    const double table[6][6] = {{-90, 150, 475, 0, -170, 170}, {0, -600, 0, 90, -70, 70}, {90, -120, 0, 0, -65, 70},
                                {-90, 0, 720, 0, -150, 150},   {90, 0, 0, 0, -115, 115},  {0, 0, 85, 0, -300, 300}};
    for (std::size_t i = 0; i < 6; ++i) {
        const double* row = table[i];
        robot.dh[i] = {row[0] * kDegree, row[1], row[2], row[3] * kDegree, {row[4] * kDegree, row[5] * kDegree}, {}};
    }
    robot.coupling = coupling;
    robot.T_flange_tool =
        robot::dh_transform(0, 200, 100, 0) * Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX());
    return robot;
}

inline robot::Joints degrees(double q1, double q2, double q3, double q4, double q5, double q6)
{
    return kDegree * (robot::Joints() << q1, q2, q3, q4, q5, q6).finished();
}

} // namespace fettle
