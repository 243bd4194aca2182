#include "robot/path_options.h"

namespace fettle::robot {

PathOptions::PathOptions(cli::Tool& tool)
    : track(tool.text("--track", PathArguments().track, "RULE",
                      "Position of the track: fixed (LENGTH), or following the tip (follow:LENGTH behind it along the "
                      "track); auto: the rule by which the whole path is reached farthest from singularities, a fixed "
                      "position if there is one")),
      table(tool.text("--table", PathArguments().table, "RULE",
                      "Angle of the table: DEG, follow:DEG (the tip's azimuth about its axis) or auto")),
      start(tool.text("--start", PathArguments().start, "DEG,…", "The path begins nearest to these joints")),
      jump(tool.number("--jump", PathArguments().jump_threshold_deg, "DEG",
                       "A larger turn of a joint from pose to pose is a jump", core::Range::positive()))
{
}

} // namespace fettle::robot
