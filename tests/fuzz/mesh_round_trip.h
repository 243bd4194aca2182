#pragma once

// All that read_mesh() reads, recognised by content; what was read is written as STL and reads the same again.

#include "fuzz.h"
#include "mesh/mesh_file.h"

#include <sstream>

namespace fettle::fuzz {

/// As an STL has them: in single precision, triangle by triangle. 3x3T
inline Eigen::Matrix3Xf corners(const mesh::Mesh& mesh)
{
    return mesh.vertices(Eigen::all, mesh.triangles.reshaped()).cast<float>();
}

inline void check_mesh(std::string_view bytes)
{
    mesh::Mesh mesh;
    is_read([&] { mesh::parse_mesh(bytes, "file", units::Units::Length::m); });
    if (!is_read([&] { mesh = mesh::parse_mesh(bytes, "file"); })) return;
    require(mesh.triangles.cols() > 0 && mesh.vertices.allFinite() && mesh.triangles.minCoeff() >= 0 &&
                mesh.triangles.maxCoeff() < mesh.vertices.cols(),
            "a mesh has triangles, whose corners are there");
    std::ostringstream stl;
    mesh::write_stl(stl, mesh);
    require(corners(mesh::parse_mesh(stl.str(), "written")) == corners(mesh), "what was written reads the same");
}

} // namespace fettle::fuzz
