#pragma once

#include "belt/sampling.h"
#include "belt/stock.h"
#include "units/units.h"
#include "json/document.h"

#include <optional>
#include <string>

namespace fettle::belt {

/// Reads a design and samples it: patches (JSON), a mesh or a scan, as its content says.
/// @param path  a file, or "-" for stdin
/// @param unit  of a mesh or a scan; nothing: mm
/// @throws InputError as sample_surfels(), or for an option that such a design has no use for
SampledDesign read_design(const std::string& path, const std::optional<units::Units::Length>& unit,
                          const SurfelSampling& options);

/// Report of a workpiece: the statistics of its displacements, and counts; mm.
json::Value to_json(const SampledDesign& design, const StockRays& rays);

} // namespace fettle::belt
