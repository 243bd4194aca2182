#pragma once

// For the files of this module alone.

#include <TopoDS_Face.hxx>

namespace fettle::cad {

/// Splits triangles of a face in the middle of those of their edges that are farthest from the surface until each
/// triangle is within a tolerance of it (triangle_bound()). The chords of the face's edges stay as they are, so that
/// neighbouring faces still join. OpenCASCADE's own control of the inner deflection leaves some triangles beyond it,
/// however fine it is, and takes much longer.
/// @param face  triangulated, with parameters; its triangulation is changed
/// @param tolerance  mm
void refine_triangles(const TopoDS_Face& face, double tolerance);

} // namespace fettle::cad
