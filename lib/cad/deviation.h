#pragma once

// For the files of this module alone.

#include "cad/face_triangle.h"

#include <TopoDS_Face.hxx>

#include <vector>

namespace fettle::cad {

/// Triangles of a face that is triangulated with parameters, where it is placed.
std::vector<FaceTriangle> triangles_of(const TopoDS_Face& face, const Adaptor3d_Surface& surface);

/// Upper bound of the distances between a face and its triangles, mm.
///
/// Each point of the triangles corresponds to one of the surface, by its parameters or, where that is not close enough
/// for the whole face, to its foot. Those of neighbouring triangles join, and so cover the face: the largest distance
/// between corresponding points bounds those from the surface, too. The edges are taken in as edges_bound() says.
/// @param face  triangulated, with parameters
/// @param tolerance  mm: the bound need not be tight below it, and beyond it only says so
double deviation_bound(const TopoDS_Face& face, double tolerance);

/// Upper bound of the distances between the curves of a face's edges and their chords, mm: over points of the curve,
/// and an eighth of the largest second difference between them. @param tolerance  as of deviation_bound()
double edges_bound(const TopoDS_Face& face, double tolerance);

} // namespace fettle::cad
