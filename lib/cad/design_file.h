#pragma once

// The document that OpenCASCADE reads a file into: for the files of this module alone.

#include <Standard_Handle.hxx>
#include <TDocStd_Document.hxx>

#include <string>

namespace fettle::cad {

struct DesignFile {
    Handle(TDocStd_Document) document; ///< mm
    std::string unit;                  ///< of length, as the file names it
};

/// Reads a STEP or IGES file; the content decides which.
/// @param path  a file, or "-" for stdin
/// @throws InputError as read_design(), but for solids
DesignFile read_design_file(const std::string& path);

} // namespace fettle::cad
