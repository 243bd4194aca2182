#pragma once

#include <STEPControl_Reader.hxx>

#include <string>

namespace fettle::cad {

/// Checks how the mapped items of a STEP file that has been transferred are placed. OpenCASCADE leaves out a placement
/// whose frames it does not find among the items of their representations, and the scale of a transformation operator,
/// and makes a turn of a reflection. (ISO 10303-43, mapped_item; 10303-42, cartesian_transformation_operator_3d)
/// @throws InputError for one that it would not place as the file says
void check_step_placements(const STEPControl_Reader& reader, const std::string& source);

} // namespace fettle::cad
