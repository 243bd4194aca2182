#pragma once

// Whatever read_mesh() takes, told by content; what was read is written as STL and reads the same again.

#include "fuzz.h"
#include "mesh/mesh_file.h"

#include <sstream>

namespace fettle::fuzz {

inline std::string written(const Mesh& mesh)
{
    std::ostringstream out;
    write_stl(out, mesh);
    return out.str();
}

inline void check_mesh(std::string_view bytes)
{
    Mesh mesh;
    is_read([&] { parse_mesh(bytes, "file", Units::Length::m); });
    if (!is_read([&] { mesh = parse_mesh(bytes, "file"); })) return;
    require(mesh.triangles.cols() > 0 && mesh.vertices.allFinite() && mesh.triangles.minCoeff() >= 0 &&
                mesh.triangles.maxCoeff() < mesh.vertices.cols(),
            "a mesh has triangles, whose corners are there");
    const std::string stl = written(mesh);
    require(written(parse_mesh(stl, "written")) == stl, "what was written reads the same");
}

} // namespace fettle::fuzz
