#pragma once

#include "compare/comparison.h"
#include "compare/reference_mesh.h"
#include "geometry/statistics.h"
#include "mesh/mesh.h"
#include "units/units.h"
#include "json/document.h"

#include <iosfwd>
#include <vector>

namespace fettle::compare {

/// All statistics and the points of the extremes. Here and below, lengths are written in `units`.
json::Value to_json(const geometry::Statistics& statistics, const units::Units& units);

/// Report: the statistics of all points as its own members, those of the regions under "regions", the histogram.
json::Value to_json(const Comparison& comparison, const units::Units& units);

/// Repairs of a mesh that serves as reference. @param reading  what its reader dropped
json::Value to_json(const ReferenceRepair& repair, const mesh::MeshRepair& reading, const units::Units& units);

/// Header row, then for each comparison a row for all points and one for each region. Columns are the members of the
/// report, points three columns each. Rows of all comparisons but the first are called reverse.
void write_csv(std::ostream& out, const std::vector<Comparison>& comparisons, const units::Units& units);

/// Header row, then a row for each bin.
void write_csv(std::ostream& out, const geometry::Histogram& histogram, const units::Units& units);

} // namespace fettle::compare
