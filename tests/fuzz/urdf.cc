// Robots as URDF. What was read is an arm: each solution of its inverse kinematics for a pose of its own reaches it.

#include "robot/urdf.h"
#include "fuzz.h"
#include "robot/arm.h"

using namespace fettle;

/// liburdfdom's links own their children: those of a loop, which it or parse_urdf refuses, are never freed.
extern "C" const char* __lsan_default_suppressions() { return "leak:liburdfdom_model"; }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    robot::Robot robot;
    if (!fuzz::is_read([&] { robot = robot::parse_urdf(std::string(fuzz::text_of(data, size)), "file", {}); }))
        return 0;
    const robot::Arm arm(robot);
    robot::Joints joints;
    for (Eigen::Index k = 0; k < 6; ++k) {
        const robot::JointRange range = robot.dh[static_cast<std::size_t>(k)].range;
        joints[k] = range.min + (0.3 + 0.07 * static_cast<double>(k)) * (range.max - range.min);
    }
    const Eigen::Isometry3d pose = arm.flange(joints);
    fuzz::require(pose.matrix().allFinite(), "the flange is somewhere");
    if (robot.arm_kind == robot::ArmKind::general) return 0; // numerically, which takes long
    const double tolerance = 1e-6 * (1 + pose.translation().norm());
    for (const robot::ArmSolution& solution : arm.solve(pose, joints, robot::Ranges::ignore))
        fuzz::require((arm.flange(solution.joints).translation() - pose.translation()).norm() < tolerance,
                      "a solution reaches the pose");
    return 0;
}
