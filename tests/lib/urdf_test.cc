#include "core/error.h"
#include "core/file.h"
#include "robot/arm.h"
#include "robot/path_cloud.h"
#include "robot/urdf.h"

#include <gtest/gtest.h>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <urdf_parser/urdf_parser.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <variant>
#include <vector>

namespace fettle {
namespace urdf_test {

using robot::ArmKind;

constexpr const char* kFolder = "samples/robots/urdf/";

struct Sample {
    const char* name;
    ArmKind kind;
};
constexpr Sample kSamples[] = {
    {"abb_irb2400", ArmKind::spherical_wrist},
    {"abb_irb6640", ArmKind::spherical_wrist},
    {"fanuc_lrmate200id", ArmKind::spherical_wrist},
    {"fanuc_m10ia", ArmKind::spherical_wrist},
    {"kuka_kr16_2", ArmKind::spherical_wrist},
    {"kuka_kr210l150", ArmKind::spherical_wrist},
    {"kuka_kr120r2500pro", ArmKind::spherical_wrist},
    {"motoman_mh5", ArmKind::spherical_wrist},
    {"staubli_rx160", ArmKind::spherical_wrist},
    {"ur5", ArmKind::parallel_axes},
    {"ur10e", ArmKind::parallel_axes},
};

std::string source_folder()
{
    // Tests run in a folder of their own; SAMPLES names the samples.
    const char* samples = std::getenv("SAMPLES");
    return samples != nullptr ? std::string(samples) + "/robots/urdf/" : kFolder;
}

std::string text_of(const std::string& name) { return core::read_file(source_folder() + name + ".urdf"); }
robot::Robot robot_of(const std::string& name) { return robot::parse_urdf(text_of(name), name, {}); }

KDL::Frame to_kdl(const urdf::Pose& pose)
{
    const auto& [x, y, z, w] = pose.rotation;
    return {KDL::Rotation::Quaternion(x, y, z, w), KDL::Vector(pose.position.x, pose.position.y, pose.position.z)};
}

// The chain from the root to tool0, or to the last link, by liburdfdom and KDL alone.
KDL::Chain kdl_chain(const std::string& text)
{
    const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text);
    std::vector<const urdf::Joint*> joints;
    const urdf::Link* tip = model->getLink("tool0").get();
    for (const char* last : {"link_6", "link_t"})
        if (tip == nullptr) tip = model->getLink(last).get();
    for (const urdf::Link* at = tip; at->parent_joint != nullptr; at = at->getParent().get())
        joints.insert(joints.begin(), at->parent_joint.get());
    KDL::Chain chain;
    for (const urdf::Joint* joint : joints) {
        const KDL::Frame origin = to_kdl(joint->parent_to_joint_origin_transform);
        KDL::Joint moving(KDL::Joint::None);
        if (joint->type != urdf::Joint::FIXED)
            moving =
                KDL::Joint(joint->name, origin.p, origin.M * KDL::Vector(joint->axis.x, joint->axis.y, joint->axis.z),
                           KDL::Joint::RotAxis);
        chain.addSegment(KDL::Segment(joint->name, moving, origin));
    }
    return chain;
}

class Draws {
  public:
    robot::Joints in_range(const robot::Robot& robot)
    {
        robot::Joints joints;
        for (Eigen::Index k = 0; k < 6; ++k) {
            const robot::JointRange& range = robot.dh[k].range;
            joints[k] = range.min + (range.max - range.min) * uniform_(engine_);
        }
        return joints;
    }

  private:
    std::mt19937_64 engine_{5};
    std::uniform_real_distribution<double> uniform_{0, 1};
};

double pose_error(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b)
{
    return std::max((a.translation() - b.translation()).norm(), (a.linear() - b.linear()).norm());
}

// Reference: orocos-kdl on the same file; metres.
TEST(Urdf, forward_as_kdl)
{
    Draws draws;
    for (const Sample& sample : kSamples) {
        const robot::Robot robot = robot_of(sample.name);
        const KDL::Chain chain = kdl_chain(text_of(sample.name));
        KDL::ChainFkSolverPos_recursive solver(chain);
        ASSERT_EQ(chain.getNrOfJoints(), 6u) << sample.name;
        for (int i = 0; i < 200; ++i) {
            const robot::Joints q = draws.in_range(robot);
            KDL::JntArray joints(6);
            joints.data = q;
            KDL::Frame frame;
            ASSERT_GE(solver.JntToCart(joints, frame), 0);
            robot::CellJointsPath cell = robot::CellJointsPath::Zero(8, 1);
            cell.col(0).head<6>() = q;
            // The path's tool frame is turned half about x against the robot's.
            const Eigen::Isometry3d T = robot::forward_kinematics(robot, cell)[0] *
                                        Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX());
            for (int r = 0; r < 3; ++r) {
                EXPECT_NEAR(T.translation()[r] / 1000, frame.p(r), 1e-9) << sample.name;
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(T.linear()(r, c), frame.M(r, c), 1e-9) << sample.name;
            }
        }
    }
}

// Every solution leads back to the pose, and the joints that it was made from are among them.
TEST(Urdf, inverse_leads_back)
{
    Draws draws;
    for (const Sample& sample : kSamples) {
        const robot::Robot robot = robot_of(sample.name);
        EXPECT_EQ(robot.arm_kind, sample.kind) << sample.name;
        const robot::Arm arm(robot);
        for (int i = 0; i < 500; ++i) {
            const robot::Joints q = draws.in_range(robot);
            const Eigen::Isometry3d target = arm.flange(q);
            const robot::ArmSolutions found = arm.solve(target, robot::Joints::Zero(), robot::Ranges::ignore);
            double nearest = 10;
            for (const robot::ArmSolution& solution : found) {
                EXPECT_LT(pose_error(arm.flange(solution.joints), target), 1e-9) << sample.name;
                const robot::Joints off = (solution.joints - q).unaryExpr([](double angle) {
                    return std::abs(std::remainder(angle, 2 * std::numbers::pi));
                });
                nearest = std::min(nearest, off.maxCoeff());
            }
            if (arm.singularity(q).min() > 1e-3) {
                EXPECT_LT(nearest, 1e-6) << sample.name << " " << i;
            }
        }
    }
}

// As many solutions as a search from many starts finds, of which none is another one.
TEST(Urdf, all_branches_of_parallel_axes)
{
    Draws draws;
    robot::Robot robot = robot_of("ur5");
    robot::Robot searched = robot;
    searched.arm_kind = ArmKind::general;
    const robot::Arm arm(robot), search(searched);
    std::size_t eight = 0;
    for (int i = 0; i < 20; ++i) {
        const Eigen::Isometry3d target = arm.flange(draws.in_range(robot));
        const robot::ArmSolutions found = arm.solve(target, robot::Joints::Zero(), robot::Ranges::ignore);
        const robot::ArmSolutions roots = search.solve(target, robot::Joints::Zero(), robot::Ranges::ignore);
        for (const robot::ArmSolution& root : roots) {
            double nearest = 10;
            for (const robot::ArmSolution& solution : found)
                nearest =
                    std::min(nearest, (arm.frames(solution.joints)[3].matrix() - arm.frames(root.joints)[3].matrix())
                                          .cwiseAbs()
                                          .maxCoeff());
            EXPECT_LT(nearest, 1e-4) << i;
        }
        EXPECT_GE(found.size(), roots.size());
        eight += found.size() == 8 ? 1 : 0;
    }
    EXPECT_GT(eight, 10u);
}

// The Jacobian against differences of the flange, at the best of several steps.
TEST(Urdf, jacobian_as_differences)
{
    Draws draws;
    for (const char* name : {"ur5", "fanuc_m10ia"}) {
        const robot::Robot robot = robot_of(name);
        const robot::Arm arm(robot);
        const robot::Joints q = draws.in_range(robot);
        const auto J = arm.jacobian(q);
        for (Eigen::Index k = 0; k < 6; ++k) {
            double best = 1e9;
            for (const double step : {1e-4, 1e-5, 1e-6}) {
                robot::Joints before = q, after = q;
                before[k] -= step;
                after[k] += step;
                const Eigen::Vector3d slope =
                    (arm.flange(after).translation() - arm.flange(before).translation()) / (2 * step);
                best = std::min(best, (slope - J.col(k).head<3>()).norm());
            }
            EXPECT_LT(best, 1e-5) << name;
        }
    }
}

// An arm without a closed form: a UR whose wrist is offset. Its joints are found, and it says that branches may be
// missing.
TEST(Urdf, general_arm)
{
    std::string text = text_of("ur5");
    text.replace(text.find("0 0.0823"), 1, "0.03");
    const robot::Robot robot = robot::parse_urdf(text, "offset", {});
    EXPECT_EQ(robot.arm_kind, ArmKind::general);
    ASSERT_EQ(robot.notes.size(), 1u);
    EXPECT_NE(robot.notes[0].find("branches may be missing"), std::string::npos);
    const robot::Arm arm(robot);
    Draws draws;
    for (int i = 0; i < 20; ++i) {
        const Eigen::Isometry3d target = arm.flange(draws.in_range(robot));
        const robot::ArmSolutions found = arm.solve(target, robot::Joints::Zero(), robot::Ranges::ignore);
        EXPECT_GE(found.size(), 2u);
        for (const robot::ArmSolution& solution : found)
            EXPECT_LT(pose_error(arm.flange(solution.joints), target), 1e-8);
    }
}

// Its distance from a singularity is the least motion of the flange, lengths over the arm's, that joints can bring
// about. Reference: differences of the flange; the wrist stretched, where axes 4 and 6 are one.
TEST(Urdf, singularity_of_a_general_arm)
{
    robot::Robot robot = robot_of("ur5");
    robot.arm_kind = ArmKind::general;
    const robot::Arm arm(robot);
    double reach = 1;
    for (const robot::DhRow& row : robot.dh) reach += std::abs(row.a) + std::abs(row.d);
    Draws draws;
    double largest = 0;
    for (int i = 0; i < 50; ++i) {
        robot::Joints q = draws.in_range(robot);
        const double distance = arm.singularity(q).min();
        largest = std::max(largest, distance);
        const robot::Joints motion = draws.in_range(robot).normalized();
        constexpr double kStep = 1e-6;
        const Eigen::Isometry3d before = arm.flange(q - kStep * motion), after = arm.flange(q + kStep * motion);
        const double moved = (after.translation() - before.translation()).norm() / (2 * kStep * reach);
        const double turned = (after.linear() - before.linear()).norm() / (std::sqrt(8.0) * kStep);
        EXPECT_LE(distance, std::hypot(moved, turned) + 1e-6) << i;
        q[4] = 0;
        EXPECT_LT(arm.singularity(q).min(), 1e-9) << i;
    }
    EXPECT_GT(largest, 0.02);
}

// With joint 5 at 0 the pose leaves joints 4 and 6 open but for their sum: joint 6 is taken from the seed.
TEST(Urdf, stretched_wrist_of_parallel_axes)
{
    const robot::Robot robot = robot_of("ur5");
    const robot::Arm arm(robot);
    Draws draws;
    for (int i = 0; i < 20; ++i) {
        robot::Joints q = draws.in_range(robot);
        q[4] = i % 2 == 0 ? 0 : std::numbers::pi;
        const Eigen::Isometry3d target = arm.flange(q);
        double nearest = 10;
        for (const robot::ArmSolution& solution : arm.solve(target, q, robot::Ranges::ignore)) {
            EXPECT_LT(pose_error(arm.flange(solution.joints), target), 1e-7) << i;
            const robot::Joints off = (solution.joints - q).unaryExpr([](double angle) {
                return std::abs(std::remainder(angle, 2 * std::numbers::pi));
            });
            nearest = std::min(nearest, off.maxCoeff());
        }
        EXPECT_LT(nearest, 1e-6) << i;
    }
}

// Out of the range of joint 5 alone a pose is within reach; too far away it is not.
TEST(Urdf, reach_of_parallel_axes)
{
    robot::Robot robot = robot_of("ur5");
    const robot::Joints q = (robot::Joints() << 0.3, -1.2, 1.5, -0.4, 0.9, 0.2).finished();
    Eigen::Isometry3d target = robot::Arm(robot).flange(q);
    robot.dh[4].range = {2.9, 3};
    const robot::Arm arm(robot);
    const robot::ArmSolutions near = arm.solve(target, q, robot::Ranges::respect);
    EXPECT_EQ(near.size(), 0u);
    EXPECT_TRUE(near.reachable);
    target.translation() *= 3;
    EXPECT_FALSE(arm.solve(target, q, robot::Ranges::respect).reachable);
}

// Links of one length, folded so that axis 4 lies on axis 2: any joint 2 will do, and the seed's is taken.
TEST(Urdf, folded_links_of_parallel_axes)
{
    robot::Robot robot = robot_of("ur5");
    robot.dh[1].a = robot.dh[2].a = -400;
    for (const std::size_t row : {1u, 2u, 3u, 4u, 5u}) robot.dh[row].d = 0;
    const robot::Arm arm(robot);
    const robot::Joints seed = (robot::Joints() << 0.3, -1.2, 0, 0, 0, 0.2).finished();
    Eigen::Isometry3d target(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
    target.translation().z() = robot.dh[0].d;
    const robot::ArmSolutions found = arm.solve(target, seed, robot::Ranges::ignore);
    ASSERT_GT(found.size(), 0u);
    for (const robot::ArmSolution& solution : found) {
        EXPECT_LT(pose_error(arm.flange(solution.joints), target), 1e-9);
        EXPECT_NEAR(std::remainder(solution.joints[1] - seed[1], 2 * std::numbers::pi), 0, 1e-12);
    }
}

// A calibrated arm, whose axes are not quite at right angles: the closed form's solutions are corrected.
TEST(Urdf, inverse_of_calibrated_arms)
{
    Draws draws;
    for (const char* name : {"ur5", "abb_irb2400"}) {
        robot::Robot robot = robot_of(name);
        robot.dh[0].alpha += 3e-4;
        robot.dh[3].a += 0.1;
        robot.dh[4].alpha -= 2e-4;
        const robot::Arm arm(robot);
        for (int i = 0; i < 50; ++i) {
            const robot::Joints q = draws.in_range(robot);
            if (arm.singularity(q).min() < 0.1) continue;
            const Eigen::Isometry3d target = arm.flange(q);
            double nearest = 10;
            for (const robot::ArmSolution& solution : arm.solve(target, q, robot::Ranges::respect)) {
                EXPECT_LT(pose_error(arm.flange(solution.joints), target), 1e-8) << name;
                EXPECT_TRUE(arm.in_range(solution.joints)) << name;
                const robot::Joints off = (solution.joints - q).unaryExpr([](double angle) {
                    return std::abs(std::remainder(angle, 2 * std::numbers::pi));
                });
                nearest = std::min(nearest, off.maxCoeff());
            }
            EXPECT_LT(nearest, 1e-8) << name << " " << i;
        }
    }
}

std::string refusal(const std::string& text, const robot::UrdfOptions& options = {})
{
    try {
        robot::parse_urdf(text, "r.urdf", options);
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "";
}

std::string changed(const std::string& from, const std::string& to)
{
    std::string text = text_of("ur5");
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

TEST(Urdf, refusals)
{
    EXPECT_EQ(refusal(text_of("ur5")), "");
    EXPECT_NE(refusal("<robot xmlns:xacro=\"x\"><xacro:macro/></robot>").find("is a xacro file"), std::string::npos);
    EXPECT_NE(refusal("<robot").find("r.urdf: "), std::string::npos);
    EXPECT_NE(refusal("<html></html>").find("r.urdf: "), std::string::npos);
    EXPECT_NE(refusal(changed("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 0\"/>")).find("its axis is 0"),
              std::string::npos);
    EXPECT_NE(refusal(changed("<limit lower", "<limits lower")).find("shoulder_pan_joint"), std::string::npos);
    EXPECT_NE(refusal(changed("type=\"revolute\"", "type=\"fixed\"")).find("5 joints turn, expected 6"),
              std::string::npos);
    EXPECT_NE(refusal(changed("type=\"revolute\"", "type=\"prismatic\"")).find("neither turns nor is fixed"),
              std::string::npos);
    // two links that hang on each other, apart from the root
    EXPECT_NE(
        refusal(changed("</robot>", "<link name=\"a\"/><link name=\"b\"/><joint name=\"ab\" type=\"fixed\"><parent "
                                    "link=\"a\"/><child link=\"b\"/></joint><joint name=\"ba\" type=\"fixed\"><parent "
                                    "link=\"b\"/><child link=\"a\"/></joint></robot>"))
            .find("loop"),
        std::string::npos);
    const auto with_mesh = [&](const std::string& file) {
        return changed("<link name=\"forearm_link\"/>",
                       "<link name=\"forearm_link\"><collision><geometry><mesh filename=\"" + file +
                           "\"/></geometry></collision></link>");
    };
    EXPECT_NE(refusal(with_mesh("package://ur/forearm.stl")).find("--package ur=DIR"), std::string::npos);
    EXPECT_NE(
        refusal(with_mesh("package://ur/forearm.stl"), {{{"ur", "/nowhere"}}, "", ""}).find("/nowhere/forearm.stl"),
        std::string::npos);
    EXPECT_NE(refusal(with_mesh("forearm.dae")).find("COLLADA"), std::string::npos);
    EXPECT_NE(refusal(with_mesh("file:///nowhere/forearm.stl")).find("there is no mesh /nowhere/forearm.stl"),
              std::string::npos);
    EXPECT_NE(refusal(text_of("ur5"), {{}, "", "finger"}).find("--tip: no link is called 'finger'"), std::string::npos);
    EXPECT_NE(refusal(changed("</robot>", "<link name=\"alone\"/></robot>")).find("Two root links found"),
              std::string::npos);
    EXPECT_NE(refusal(changed("effort=\"150\" velocity=\"3.141592653589793\"/>",
                              "effort=\"150\" velocity=\"3.141592653589793\"/><mimic joint=\"elbow_joint\"/>"))
                  .find("mimics 'elbow_joint': a joint of the arm must move by itself"),
              std::string::npos);
    EXPECT_NE(refusal(changed("upper=\"6.283185307179586\"", "upper=\"-7\"")).find("are no range within 720 degrees"),
              std::string::npos);
    EXPECT_NE(refusal(changed("0 0 0.089159", "0 0 101")).find("a place is not finite, or beyond 100 m"),
              std::string::npos);
    EXPECT_NE(refusal(changed("rpy=\"1.570796327 0 0\"", "rpy=\"0 0 0\"")).find("the axes of joints 1 and 2 coincide"),
              std::string::npos);
    EXPECT_NE(refusal(changed("<link name=\"forearm_link\"/>",
                              "<link name=\"forearm_link\"><collision><geometry><box size=\"0.1 -0.2 0.3\"/></geometry>"
                              "</collision></link>"))
                  .find("link 'forearm_link': a length of its collision shape is -0.2 m"),
              std::string::npos);
}

TEST(Urdf, boxes_have_half_their_sides)
{
    const robot::Robot robot =
        robot::parse_urdf(changed("<link name=\"base_link\"/>",
                                  "<link name=\"base_link\"><collision><origin xyz=\"0 0 0.5\"/><geometry><box "
                                  "size=\"0.1 0.2 0.3\"/></geometry></collision></link>"),
                          "box", {});
    ASSERT_EQ(robot.bodies.size(), 1u);
    const auto* box = std::get_if<robot::solid::Box>(&robot.bodies[0].solid);
    ASSERT_NE(box, nullptr);
    EXPECT_LT((box->half - Eigen::Vector3d(50, 100, 150)).norm(), 1e-9);
    EXPECT_LT((robot.T_cell_base * box->T_body_box.translation() - Eigen::Vector3d(0, 0, 500)).norm(), 1e-9);
}

// A prismatic joint before the six is the track: in metres, as URDFs are.
TEST(Urdf, track)
{
    const auto with_track = [](const std::string& limits) {
        return changed("</robot>",
                       "<link name=\"rail\"/><joint name=\"slide\" type=\"prismatic\"><parent "
                       "link=\"rail\"/><child link=\"base_link\"/><axis xyz=\"0 2 0\"/><limit effort=\"1\" " +
                           limits + "/></joint></robot>");
    };
    const robot::Robot robot = robot::parse_urdf(with_track("lower=\"-0.5\" upper=\"2\" velocity=\"0.3\""), "rail", {});
    ASSERT_TRUE(robot.track);
    EXPECT_EQ(robot.track->axis, Eigen::Vector3d::UnitY());
    EXPECT_NEAR(robot.track->range.min, -500, 1e-9);
    EXPECT_NEAR(robot.track->range.max, 2000, 1e-9);
    EXPECT_NEAR(robot.track->max_speed.value_or(0), 300, 1e-9);
    for (const char* limits : {"lower=\"1\" upper=\"0\" velocity=\"1\"", "lower=\"0\" upper=\"101\" velocity=\"1\""})
        EXPECT_NE(refusal(with_track(limits)).find("joint 'slide': its limits are no range within 100 m"),
                  std::string::npos);
}

// Without a URDF's options only a robot file is read, as with them.
TEST(Urdf, robot_files_without_options)
{
    const std::string folder = source_folder();
    const std::string file = folder + "../irb2400.json";
    EXPECT_EQ(robot::read_robot(file).digest, robot::read_robot(file, robot::UrdfOptions{}).digest);
    EXPECT_THROW(robot::read_robot(folder + "ur5.urdf"), core::InputError);
}

} // namespace urdf_test
} // namespace fettle
