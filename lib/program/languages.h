#pragma once

#include "program/program.h"

#include <string>
#include <vector>

namespace fettle::program {

/// An ABB RAPID module: a constant robtarget for each pose with orientation q1 to q4 = w, x, y, z, configuration and
/// external axes (eax_a the track, mm; eax_b the table, degrees), the tool, and the part's frame as work object; a
/// procedure for each routine, and main, which calls them.
/// (ABB, Technical reference manual RAPID instructions, functions and data types, 3HAC050917)
std::string rapid_text(const Program& program);

/// The joints with joint 3 as the angle of the forearm to the horizontal, so that moving joint 2 alone leaves it. With
/// the coupling "parallelogram" the robot file counts it so already.
robot::Joints from_horizontal(const robot::Robot& robot, robot::Joints joints);

/// RAPID's confdata (ABB, RAPID reference manual, "confdata"; its table of cfx is repeated in AXIS_CONFIGURATION.md of
/// github.com/CEAD-group/py-opw-kinematics): the quadrants of joints 1, 4 and 6 (0: 0 to 90 degrees, -1: -90 to 0, …),
/// and for serial arms the branch: 4 if the wrist centre lies behind axis 1, + 2 if it lies behind the lower arm, + 1
/// if joint 5 is negative. It is 0 with a parallelogram, where controllers determine the branch from the quadrants.
Eigen::Vector4i rapid_configuration(const robot::Robot& robot, robot::Coupling coupling, const robot::Joints& joints);

/// A KUKA KRL source file (.src): positions with A, B, C about z, y, x, and E1, E2 for track and table; $VEL.CP in m/s;
/// C_DIS with $APO.CDIS for the zone. @param name  of the program
std::string krl_text(const Program& program, const std::string& name);

/// Fanuc LS files, ASCII: the first calls the others. Fanuc counts heights from axis 2, joint 3 from the horizontal,
/// and speeds of moves by joints in per cent. A routine of more than `max_lines` lines is split.
/// @param name  of the first program, upper case in the files
/// @throws InputError if a URDF has the controller's world frame at another height
std::vector<ProgramFile> fanuc_files(const Program& program, const std::string& name, std::uint64_t max_lines = 5000);

/// The beginning of line `number` of an LS program, "   1:". Programs may have more lines than an int counts.
std::string fanuc_line_number(std::uint64_t number);

/// Fanuc's joints, degrees: joint 3 is the angle to the horizontal.
Eigen::VectorXd fanuc_joints(const robot::Robot& robot, const robot::Joints& joints);

/// A Universal Robots URScript program: poses p[x, y, z, rx, ry, rz], m and rotation vectors, from the base; blend
/// radii shorter than half the way to either neighbour.
/// @throws InputError if a track or a table moves along the path: the controller has none
std::string urscript_text(const Program& program, const std::string& name);

} // namespace fettle::program
