#include "machining/tool_path.h"

#include "cloud/pcd.h"
#include "core/content.h"
#include "core/error.h"
#include "machining/tilt.h"

#include <utility>

namespace fettle::machining {

ToolPath parse_tool_path(std::string bytes, const std::string& source, const Cutter& cutter,
                         const ToolPathReading& options)
{
    ToolPath path;
    core::refuse_other_content(bytes, source, "points or a program");
    if (looks_like_nc_program(bytes)) {
        if (options.contacts) throw core::InputError(source, "a program has no contact points");
        path.program = parse_nc_program(bytes, source, options.start);
        path.text = std::move(bytes);
        return path;
    }
    if (options.start) throw core::InputError(source, "points; --start belongs to a program");
    path.points = rotated(cloud::parse_cloud(bytes, source).cloud, rotation_tilted_machine(options.axis));
    path.program.moves = moves_from_points(*path.points, cutter, options.contacts, options.feed, source, options.axis);
    return path;
}

} // namespace fettle::machining
