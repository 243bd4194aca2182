#pragma once

#include "find/find.h"
#include "job/job.h"
#include "mesh/cloud_mesh.h"

#include <span>
#include <string>

namespace fettle::find {

struct FoundJob {
    job::Job job;
    std::string wheel; ///< why its wheel is not the template's; empty: it is
};

/// Adds a doubt to anomalies where the metal around scatters by more than the tolerance of `settings` about the surface
/// through it, and does not determine the desired surface.
void add_scatter_doubts(FindResult& result, const job::Job& settings);

/// The job of an anomaly. Its frame is the anomaly's own; B and S are the anomaly's, with the heights of the part's
/// metal at their corners where that is seen; neither crosses an edge of the part. The surface is a plane if
/// is_plane_better() (plane_choice.h), and B then has as many corners, its touches, as the tolerance needs; else it is
/// free-form. The passes run along B's longer side. The safe height clears all of the part within the wheel's reach.
/// Probe, tolerance, wheel, forces, feed and removal are those of `settings`. If the surface is too curved for that
/// wheel, the job has the wheel of the first of `others` that fits, with its forces, feed and removal; if none does, a
/// narrower or smaller wheel.
/// @param part  in which the anomaly was found
/// @throws InputError as job::validated(), if the boundaries bound nothing
FoundJob job_for(const FoundAnomaly& anomaly, const mesh::CloudMesh& part, const job::Job& settings,
                 std::span<const job::Job> others = {});

} // namespace fettle::find
