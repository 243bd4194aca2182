#include "machining/path_options.h"

#include "core/direction.h"
#include "core/file.h"
#include "core/text.h"
#include "machining/limits.h"

namespace fettle::machining {

ToolPathOptions::ToolPathOptions(cli::Tool& tool)
    : points(tool.choice("--points", "cl", {"cl", "cc"},
                         "Points of a path are cutter locations (cl: the tip) or cutter contacts (cc: with normals)")),
      axis_text(tool.text("--axis", "0,0,1", "X,Y,Z",
                          "Tool axis, from tip to holder (3+2 axes); a program is then in the tilted frame, which is "
                          "rotated by the smallest angle so that this axis is +Z")),
      feed(tool.number("--feed", 10, "MM/S", "Feed of points without one", kSpeedRange)),
      start(
          tool.text("--start", "", "X,Y,Z",
                    "Where the tip is before a program's first move, in the program's coordinates, mm; else the first "
                    "moves are rapid until X, Y and Z are known"))
{
}

Eigen::Vector3d ToolPathOptions::axis() const { return core::parse_direction(axis_text, "--axis"); }

ToolPath ToolPathOptions::read(const std::string& file, const Cutter& cutter) const
{
    ToolPathReading reading{contacts(), feed, axis()};
    if (!start.empty())
        reading.start = core::with_error_prefix("--start", [&] {
            return core::parse_number_list(start, {"x", "y", "z"});
        });
    return parse_tool_path(core::read_file(file), core::display_name(file), cutter, reading);
}

Cutter parse_cutter_option(const std::string& text)
{
    return core::with_error_prefix("--cutter", [&] { return parse_cutter(text); });
}

} // namespace fettle::machining
