#include "machining/tool_path.h"

#include "cloud/pcd.h"
#include "core/error.h"
#include "machining/tilt.h"

#include <utility>

namespace fettle {

ToolPath parse_tool_path(std::string bytes, const std::string& source, const Cutter& cutter,
                         const PointMeaning& meaning)
{
    ToolPath path;
    if (looks_like_nc_program(bytes)) {
        if (meaning.contacts) throw InputError(source, "a program has no contact points");
        path.program = parse_nc_program(bytes, source);
        path.text = std::move(bytes);
        return path;
    }
    path.points = turned(parse_cloud(bytes, source).cloud, rotation_tilted_machine(meaning.axis));
    path.program.moves = moves_through(*path.points, cutter, meaning.contacts, meaning.feed, source, meaning.axis);
    return path;
}

} // namespace fettle
