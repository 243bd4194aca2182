#pragma once

#include "cad/design.h"
#include "core/progress.h"
#include "mesh/mesh.h"
#include "units/units.h"

#include <iosfwd>
#include <vector>

namespace fettle::cad {

/// The triangles of a design, and how far they are from its surfaces at most.
struct Triangulation {
    mesh::Mesh mesh;          ///< equal corners of neighbouring faces are one vertex
    std::vector<int> face_of; ///< of each triangle, index of Design::faces()
    std::vector<double>
        deviation; ///< of each face, mm: its triangles from its surface, and its surface and edges from them
    std::vector<Eigen::Index> triangles; ///< of each face
    Eigen::Index open_edges = 0;         ///< edges that do not join exactly two triangles
};

/// Triangulates all faces so that each is within a tolerance, which is computed, not assumed (deviation.h): parts with
/// a face beyond it are triangulated again, finer.
/// @param tolerance  mm
/// @throws InputError that names the first face that cannot be triangulated, or not within the tolerance
Triangulation triangulate(const Design& design, double tolerance, const core::Progress& progress = {});

/// Writes a binary PLY whose faces have the properties `face` (index of Design::faces()) and, if any face of the design
/// has a colour, red, green and blue; white where it has none.
void write_faces_ply(std::ostream& out, const Design& design, const Triangulation& triangulation,
                     units::Units::Length unit);

} // namespace fettle::cad
