#pragma once

// Whatever read_mesh() takes, told by content; what was read is written as STL and reads the same again.

#include "fuzz.h"
#include "mesh/mesh_file.h"

#include <sstream>

namespace fettle::fuzz {

/// As an STL has them: in single precision, triangle by triangle. 3x3T
inline Eigen::Matrix3Xf corners(const Mesh& mesh)
{
    return mesh.vertices(Eigen::all, mesh.triangles.reshaped()).cast<float>();
}

inline void check_mesh(std::string_view bytes)
{
    Mesh mesh;
    is_read([&] { parse_mesh(bytes, "file", Units::Length::m); });
    if (!is_read([&] { mesh = parse_mesh(bytes, "file"); })) return;
    require(mesh.triangles.cols() > 0 && mesh.vertices.allFinite() && mesh.triangles.minCoeff() >= 0 &&
                mesh.triangles.maxCoeff() < mesh.vertices.cols(),
            "a mesh has triangles, whose corners are there");
    std::ostringstream stl;
    write_stl(stl, mesh);
    require(corners(parse_mesh(stl.str(), "written")) == corners(mesh), "what was written reads the same");
}

} // namespace fettle::fuzz
