#pragma once

// For the files of this module alone.

#include <TopoDS_Face.hxx>

namespace fettle::cad {

/// Upper bound of the distances between a face and its triangles, mm.
///
/// Each point of the triangles is given a partner on the surface, by its parameters or, where that is not close enough
/// for the whole face, its foot. The partners of neighbouring triangles join, and so cover the face: the largest
/// distance of partners bounds those from the surface, too. It is taken over a grid of each triangle; between its
/// points the surface differs from the plane through three of them by at most a sixth of the largest second difference
/// (exact for quadratics), and the distance to what is flat is largest in a corner. Grids are refined while the bound
/// is beyond the tolerance. The edges' curves are compared with their chords likewise, by an eighth.
/// @param face  triangulated, with parameters
/// @param tolerance  mm: the bound need not be tight below it, and beyond it only says so
double deviation_bound(const TopoDS_Face& face, double tolerance);

} // namespace fettle::cad
