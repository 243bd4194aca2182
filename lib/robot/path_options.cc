#include "robot/path_options.h"

#include "core/file.h"
#include "robot/urdf.h"

namespace fettle::robot {

PathOptions::PathOptions(cli::Tool& tool)
    : track(tool.text("--track", PathArguments().track, "RULE",
                      "Position of the track: fixed (LENGTH), or following the tip (follow:LENGTH behind it along the "
                      "track); auto: the rule by which the whole path is reached, for fettle-collide clear, farthest "
                      "from singularities, a fixed "
                      "position if there is one")),
      table(tool.text("--table", PathArguments().table, "RULE",
                      "Angle of the table: DEG, follow:DEG (the tip's azimuth about its axis) or auto")),
      start(tool.text("--start", PathArguments().start, "DEG,...", "The path begins nearest to these joints")),
      jump(tool.number("--jump", PathArguments().jump_threshold_deg, "DEG",
                       "A larger turn of a joint from pose to pose is a jump", core::Range::positive()))
{
}

RobotOptions::RobotOptions(cli::Tool& of_tool)
    : tool(of_tool), file(tool.positional_file("ROBOT", "The robot, JSON or URDF")),
      packages(tool.text("--package", "", "NAME=DIR,…", "URDF: folders of the packages of its meshes")),
      srdf(tool.optional_file("--srdf", "FILE", "URDF: pairs of links that may touch")),
      tip(tool.text("--tip", "", "LINK",
                    "URDF: the link whose frame is the tool's, z out of the robot [tool0, or the "
                    "last]")),
      meshes(tool.choice("--link-meshes", "exact", {"exact", "hull"},
                         "URDF: collision meshes triangle by triangle, or as their convex hulls"))
{
}

Robot RobotOptions::read() const
{
    Robot robot = read_robot(file, {parse_packages(packages), srdf, tip, meshes == "exact"});
    for (const std::string& note : robot.notes) tool.warn(core::display_name(file) + ": " + note);
    return robot;
}

} // namespace fettle::robot
