#pragma once

#include "compare/comparison.h"
#include "compare/reference_mesh.h"
#include "compare/statistics.h"
#include "mesh/mesh.h"
#include "units/units.h"
#include "json/document.h"

#include <iosfwd>
#include <vector>

namespace fettle {

/// All of its numbers, and where the extremes are, in `units`, as are all numbers below.
json::Value to_json(const Statistics& statistics, const Units& units);

/// The members of a report: of all points, flat; of the regions, under "regions"; and the histogram.
json::Value to_json(const Comparison& comparison, const Units& units);

/// What was mended of a mesh as reference. @param reading  what reading it dropped
json::Value to_json(const ReferenceRepair& repair, const MeshRepair& reading, const Units& units);

/// A row for all points and for each region of some comparisons, with a row of names; the members of the report, places
/// as three columns. All comparisons but the first are called reverse.
void write_csv(std::ostream& out, const std::vector<Comparison>& comparisons, const Units& units);

/// A row for each bin, with a row of names.
void write_csv(std::ostream& out, const Histogram& histogram, const Units& units);

} // namespace fettle
