#pragma once

#include "cloud/ply.h"

#include <Eigen/Core>

#include <string>

namespace fettle::mesh {

/// Triangles of the faces of a PLY file. @return  3xT   @throws InputError for a face with more than kMaxPolygonCorners
Eigen::Matrix3Xi triangulate_faces(const cloud::Ply& ply, const std::string& source);

/// Checks what is left of a mesh without its triangles that have NaN or infinite corners.
/// @throws InputError if no triangle is left, or less than a tenth of them
void check_triangles_left(Eigen::Index left, Eigen::Index dropped, const std::string& source);

} // namespace fettle::mesh
