#include "program/languages.h"

#include "cloud/poses.h"
#include "core/error.h"
#include "irb1400.h"
#include "robot/arm.h"
#include "robot/path_cloud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <string>
#include <vector>

namespace fettle {
namespace program_test {

using program::StepKind;

/// A program refers to its robot, so the robot outlives it.
const robot::Robot& robot_of_tests()
{
    static const robot::Robot robot = irb1400();
    return robot;
}

robot::SolvedPath solved(const robot::Robot& robot, const robot::CellJointsPath& joints)
{
    robot::SolvedPath path;
    path.path = robot::evaluate_joints(robot, joints, 10);
    path.poses = robot::forward_kinematics(robot, joints);
    return path;
}

// A path of N poses with the motions given, at 50 mm/s.
program::Program program_of(const robot::Robot& robot, const robot::CellJointsPath& joints,
                            const std::vector<double>& motions = {}, const std::vector<double>& anomalies = {},
                            program::ProgramOptions options = {})
{
    cloud::Cloud path;
    const robot::SolvedPath given = solved(robot, joints);
    path.xyz.resize(3, joints.cols());
    cloud::set_poses(path, given.poses);
    if (!motions.empty()) cloud::set_field(path, "motion", Eigen::VectorXd::Map(motions.data(), motions.size()));
    if (!anomalies.empty()) cloud::set_field(path, "anomaly", Eigen::VectorXd::Map(anomalies.data(), anomalies.size()));
    options.speeds = Eigen::VectorXd::Constant(joints.cols(), 50);
    options.turn_rate = 500 * kDegree;
    options.remark = "UNCHECKED for collisions";
    return program::make_program(robot, path, given, options);
}

robot::CellJointsPath some_joints(int count)
{
    robot::CellJointsPath joints = robot::CellJointsPath::Zero(8, count);
    for (int i = 0; i < count; ++i) joints.col(i).head<6>() = degrees(i, 2 * i, -i, 10, 30, 3 * i);
    return joints;
}

// Reference: what an ABB arm shows at home, tool z ahead: q = 0.7071, 0, 0.7071, 0; and its quadrants.
TEST(Rapid, TargetsOfTheHomePose)
{
    robot::Robot robot = irb1400();
    robot::CellJointsPath joints = robot::CellJointsPath::Zero(8, 2);
    joints.col(1).head<6>() = degrees(-100, 0, 0, 95, 30, 200);
    const std::string module = program::rapid_text(program_of(robot, joints));
    const auto has = [](const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
    };
    has(module, "p1 := [[1155,0,1095],[0.707106781,0,0.707106781,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];");
    has(module, "tooldata fettle_tool := [TRUE,[[100,0,200],[1,0,0,0]],");
    has(module, ",[-2,1,2,0],[");
    has(module, "speeddata v_50 := [50,500,5000,1000];");
    has(module, "MoveL p2, v_50, fine, fettle_tool");
    EXPECT_TRUE(module.starts_with("MODULE fettle_path ! UNCHECKED"));
    robot.track = robot::Track{Eigen::Vector3d::UnitY(), {0, 2000}, {}};
    robot.table = robot::Table{{1000, 0, 400}, Eigen::Vector3d::UnitZ(), {-360 * kDegree, 360 * kDegree}, {}, "TURN"};
    joints(6, 0) = 1500;
    joints(7, 0) = 90 * kDegree;
    const std::string cell = program::rapid_text(program_of(robot, joints));
    has(cell, "[1500,90,9E9,9E9,9E9,9E9]");
    has(cell, "wobjdata fettle_part := [FALSE,FALSE,\"TURN\",[[0,0,0],[1,0,0,0]],[[-1000,0,-400],[1,0,0,0]]]");
}

TEST(Rapid, EightBranchesOfASerialArm)
{
    const robot::Robot robot = irb1400(robot::Coupling::serial);
    const auto configuration = [&](const robot::Joints& q) {
        return program::rapid_configuration(robot, robot.coupling, q)[3];
    };
    EXPECT_EQ(configuration(degrees(0, 0, 0, 0, 30, 0)), 0);
    EXPECT_EQ(configuration(degrees(0, 0, 0, 0, -30, 0)), 1);
    EXPECT_EQ(configuration(degrees(0, 60, -150, 0, 30, 0)),
              2); // forearm folded back over the arm, which leans far ahead
    EXPECT_EQ(configuration(degrees(0, -90, 70, 0, 30, 0)),
              0); // the arm lies back, the forearm points ahead past axis 1
    EXPECT_EQ(configuration(degrees(0, -70, -10, 0, 30, 0)),
              4); // the arm leans back, the forearm points upwards from it
    EXPECT_EQ(configuration(degrees(0, -80, -100, 0, 30, 0)), 6); // and lies back, too
    EXPECT_EQ(configuration(degrees(0, -80, -100, 0, -30, 0)), 7);
    EXPECT_EQ(program::rapid_configuration(irb1400(), robot::Coupling::parallelogram, degrees(0, 0, 0, 0, -30, 0))[3],
              0);
}

// Process and force are switched where the tool stands: the process off the part, the force at the ends of each stroke.
TEST(Program, Hooks)
{
    program::ProgramOptions options;
    options.force = 20;
    // travel, lead, approach, first contact, two on the stroke, retract, lead; another stroke; end
    const std::vector<double> motions = {3, 2, 1, 1, 0, 0, 1, 2, 3, 2, 1, 0, 1, 2};
    const program::Program made = program_of(robot_of_tests(), some_joints(14), motions, {}, options);
    ASSERT_EQ(made.routines.size(), 1u);
    std::string order;
    for (const program::Step& step : made.routines[0].steps) {
        const std::string letters = "JLPpFf";
        order += letters[static_cast<std::size_t>(step.kind)];
        if (step.is_move() && step.stops) order += '.';
    }
    EXPECT_EQ(order, "J.L.PLL.FLL.fLLLLL.FL.fL.pL.");
}

// What each language says of the force where it is switched: once each time, and its end as often.
TEST(Program, ForceInEachLanguage)
{
    program::ProgramOptions options;
    options.force = 20;
    const std::vector<double> motions = {1, 0, 0, 1, 0, 0};
    const program::Program made = program_of(robot_of_tests(), some_joints(6), motions, {}, options);
    const auto expect_twice = [](const std::string& text, const std::vector<std::string>& parts) {
        for (const std::string& part : parts) {
            int count = 0;
            for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++count;
            EXPECT_EQ(count, 2) << part << "\n" << text;
        }
    };
    expect_twice(program::rapid_text(made), {"FCPress1LStart presses with 20 N along the tool\n", "FCPressEnd\n"});
    expect_twice(program::krl_text(made, "cell"),
                 {"press with 20 N along the tool from here\n", "  ; force control: off\n"});
    expect_twice(program::urscript_text(made, "cell"),
                 {"    force_mode(get_actual_tcp_pose(), [0, 0, 1, 0, 0, 0], [0.0, 0.0, 20, 0.0, 0.0, 0.0], 2,",
                  "    end_force_mode()\n"});
    expect_twice(program::fanuc_files(made, "cell")[1].text, {"!Force Control (option): 20 N", "!Force Control: off"});
}

TEST(Program, PathsWithObstaclesAreRefused)
{
    const robot::Robot& robot = robot_of_tests();
    robot::CellJointsPath joints = some_joints(3);
    joints(0, 2) = 171 * kDegree;
    try {
        program_of(robot, joints);
        ADD_FAILURE() << "joint 1 is out of its range";
    } catch (const core::InputError& error) {
        EXPECT_EQ(std::string(error.what()),
                  "pose 2: joint 1 would be at 171 degrees, out of its range of -170 to 170");
    }
}

// A routine for each anomaly, called in the order of the path; one that the path comes back to has one each time.
TEST(Program, OneRoutineForEachAnomaly)
{
    const program::Program made = program_of(robot_of_tests(), some_joints(6), {}, {1, 1, 2, 2, 1, 1});
    ASSERT_EQ(made.routines.size(), 3u);
    EXPECT_EQ(made.routines[0].name, "anomaly_1");
    EXPECT_EQ(made.routines[1].name, "anomaly_2");
    EXPECT_EQ(made.routines[2].name, "part_3");
    const std::string krl = program::krl_text(made, "cell");
    EXPECT_NE(krl.find("  anomaly_1( )\n  anomaly_2( )\n  part_3( )\nEND"), std::string::npos) << krl;
    const auto files = program::fanuc_files(made, "cell");
    ASSERT_EQ(files.size(), 4u);
    EXPECT_EQ(files[0].name, "CELL.ls");
    EXPECT_NE(files[0].text.find("CALL CELL_2"), std::string::npos);
}

// Joint 3 of Fanuc is the forearm's angle to the horizontal: with it held, joint 2 does not turn the forearm.
TEST(Fanuc, Joint3IsRelativeToTheHorizontal)
{
    const robot::Robot serial = irb1400(robot::Coupling::serial);
    const robot::Arm arm(serial);
    const robot::Joints q = degrees(10, 20, -30, 0, 40, 0);
    robot::Joints tilted = q;
    tilted[1] += 15 * kDegree; // the forearm turns, too,
    tilted[2] -= 15 * kDegree; // and back
    EXPECT_LT((arm.frames(q)[3].linear() - arm.frames(tilted)[3].linear()).norm(), 1e-12);
    EXPECT_NEAR(program::fanuc_joints(serial, q)[2], program::fanuc_joints(serial, tilted)[2], 1e-9);
    EXPECT_NEAR(program::fanuc_joints(serial, q)[2], -10, 1e-9);
    // With a parallelogram the file counts so already; with axes that turn against each other it is a difference.
    EXPECT_NEAR(program::fanuc_joints(irb1400(), q)[2], -30, 1e-9);
    robot::Robot opposite = serial;
    opposite.dh[2].sign = -1;
    EXPECT_NEAR(program::fanuc_joints(opposite, q)[2], -50, 1e-9);
}

// World begins at the height of axis 2 (475 mm over the base of the IRB 1400), moves by joints have per cent, files are
// ASCII.
TEST(Fanuc, HeightsPerCentAscii)
{
    program::ProgramOptions options;
    options.joint_speed = 35;
    robot::CellJointsPath joints = robot::CellJointsPath::Zero(8, 3);
    joints(0, 1) = 0.1;
    program::Program made = program_of(robot_of_tests(), joints, {}, {}, options);
    made.options.remark = "UNCHECKED — ü";
    const auto files = program::fanuc_files(made, "home");
    ASSERT_EQ(files.size(), 2u);
    EXPECT_NE(files[1].text.find("J P[1] 35% FINE"), std::string::npos) << files[1].text;
    std::smatch height;
    ASSERT_TRUE(std::regex_search(files[1].text, height, std::regex("Z = ([0-9.]+) mm")));
    EXPECT_NEAR(std::stod(height[1]), 1095 - 475, 1.01e-4); // as finely as it is written
    EXPECT_NE(files[0].text.find("   1:  !UNCHECKED"), std::string::npos);
    for (const program::ProgramFile& file : files)
        for (const char c : file.text) EXPECT_TRUE(c == '\n' || c == '\t' || (c >= ' ' && c <= '~'));
}

// Long routines are split, and lines are counted beyond what an int holds.
TEST(Fanuc, LongPrograms)
{
    const auto files = program::fanuc_files(program_of(robot_of_tests(), some_joints(50) * 0.3), "long", 20);
    EXPECT_EQ(files.size(), 4u); // 51 lines in files of 20, with a remark in each
    std::size_t moves = 0;
    for (const program::ProgramFile& file : files)
        for (std::size_t at = 0; (at = file.text.find("P[", at)) != std::string::npos; ++at)
            if (file.text.compare(at - 2, 2, "L ") == 0 || file.text.compare(at - 2, 2, "J ") == 0) ++moves;
    EXPECT_EQ(moves, 50u);
    EXPECT_EQ(program::fanuc_line_number(1), "   1:");
    EXPECT_EQ(program::fanuc_line_number((std::uint64_t{1} << 31) + 1), "2147483649:");
}

TEST(Krl, SpeedsInMetresAndExternalAxes)
{
    robot::Robot robot = irb1400();
    robot.track = robot::Track{Eigen::Vector3d::UnitY(), {0, 2000}, {}};
    robot::CellJointsPath joints = some_joints(4);
    joints.row(6).setConstant(1200.5);
    program::ProgramOptions options;
    options.zone = {"z1", 1};
    const std::string text = program::krl_text(program_of(robot, joints, {}, {}, options), "cell");
    EXPECT_NE(text.find("$VEL.CP=0.05\n"), std::string::npos) << text;
    EXPECT_NE(text.find("$APO.CDIS=1\n"), std::string::npos);
    EXPECT_NE(text.find(",E1 1200.5} C_DIS"), std::string::npos);
    EXPECT_TRUE(std::regex_search(text, std::regex(R"(PTP \{E6AXIS: A1 0,.*,E1 1200\.5\})")));
    EXPECT_TRUE(
        std::regex_search(text, std::regex(R"(E1 1200\.5\}\n  \$OUT\[1\]=FALSE\nEND)"))); // the last target is met
}

// On a table the part lies in the frame of the turning plate, and the table is the axis behind the track's, if there is
// one.
TEST(Program, TablesAreExternalAxes)
{
    robot::Robot robot = irb1400();
    robot.table = robot::Table{{1000, 0, 400}, Eigen::Vector3d::UnitZ(), {-360 * kDegree, 360 * kDegree}, {}, ""};
    robot::CellJointsPath joints = some_joints(2);
    joints.row(7).setConstant(90 * kDegree);
    const auto expect_axis = [&](const std::string& krl_axes, const std::string& fanuc_axis) {
        const program::Program made = program_of(robot, joints);
        const std::string krl = program::krl_text(made, "cell"), fanuc = program::fanuc_files(made, "cell")[1].text;
        EXPECT_NE(
            krl.find("  $BASE=EK(MACHINE_DEF[2].ROOT,MACHINE_DEF[2].MECH_TYPE,{X -1000,Y 0,Z -400,A 0,B 0,C 0})\n"),
            std::string::npos)
            << krl;
        EXPECT_NE(krl.find(krl_axes + "}\n"), std::string::npos) << krl;
        EXPECT_NE(fanuc.find(fanuc_axis + "\n};"), std::string::npos) << fanuc;
    };
    expect_axis(",E1 90", ",\n\tE1 = 90 deg");
    robot.track = robot::Track{Eigen::Vector3d::UnitY(), {0, 2000}, {}};
    joints.row(6).setConstant(1200.5);
    expect_axis(",E1 1200.5,E2 90", ",\n\tE1 = 1200.5 mm,\n\tE2 = 90 deg");
}

// A blend radius is shorter than half the way to either neighbour, so that no two of them overlap.
TEST(UrScript, BlendRadii)
{
    program::ProgramOptions options;
    options.zone = {"z10", 10};
    const robot::CellJointsPath joints = some_joints(8) * 0.05;
    const program::Program made = program_of(robot_of_tests(), joints, {}, {}, options);
    const std::string text = program::urscript_text(made, "cell");
    std::vector<double> radii;
    const std::regex radius(R"(, r=([0-9.]+)\))");
    for (auto match = std::sregex_iterator(text.begin(), text.end(), radius); match != std::sregex_iterator(); ++match)
        radii.push_back(1000 * std::stod((*match)[1]));
    ASSERT_EQ(radii.size(), 7u);
    std::vector<Eigen::Vector3d> places;
    for (const program::Step& step : made.routines[0].steps)
        if (step.is_move()) places.push_back(program::target_in_world(irb1400(), step).translation());
    ASSERT_EQ(places.size(), 8u);
    for (std::size_t i = 1; i + 1 < places.size(); ++i) {
        EXPECT_GT(radii[i - 1], 0);
        EXPECT_LE(radii[i - 1], 10);
        EXPECT_LT(radii[i - 1], (places[i] - places[i - 1]).norm() / 2);
        EXPECT_LT(radii[i - 1], (places[i + 1] - places[i]).norm() / 2);
    }
    EXPECT_EQ(radii.back(), 0);
    EXPECT_TRUE(text.starts_with("# UNCHECKED"));
    robot::Robot tracked = irb1400();
    tracked.track = robot::Track{Eigen::Vector3d::UnitY(), {0, 2000}, {}};
    robot::CellJointsPath moving = joints;
    moving(6, 3) = 1;
    EXPECT_THROW(program::urscript_text(program_of(tracked, moving), "cell"), core::InputError);
}

TEST(Program, Angles)
{
    for (const double b : {-90.0, -30.0, 0.0, 89.0, 90.0})
        for (const double a : {-170.0, 20.0})
            for (const double c : {-60.0, 130.0}) {
                const auto turn = [](const Eigen::Vector3d& angles) {
                    return Eigen::Matrix3d(Eigen::AngleAxisd(angles[0] * kDegree, Eigen::Vector3d::UnitZ()) *
                                           Eigen::AngleAxisd(angles[1] * kDegree, Eigen::Vector3d::UnitY()) *
                                           Eigen::AngleAxisd(angles[2] * kDegree, Eigen::Vector3d::UnitX()));
                };
                const Eigen::Matrix3d R = turn({a, b, c});
                EXPECT_LT((turn(program::z_y_x_angles(R)) - R).norm(), 1e-8);
            }
    EXPECT_EQ(program::program_name("out/2 parts-of.mod"), "p2_parts_of");
}

} // namespace program_test
} // namespace fettle
