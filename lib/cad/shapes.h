#pragma once

// The shapes of a design in the types of OpenCASCADE: for the files of this module alone.

#include "cad/design.h"

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

#include <string>
#include <vector>

namespace fettle::cad {

struct Shapes {
    std::vector<Face> faces;
    std::vector<TopoDS_Face> placed; ///< where the assemblies place them, in the order of `faces`
    std::vector<TopoDS_Shape> parts; ///< each once, wherever it is placed: what is triangulated
    int solids = 0;
    int loose_faces = 0; ///< that belong to no solid, and were left out
    std::string file_unit;
    std::string source; ///< name of the file in messages
};

} // namespace fettle::cad
