#pragma once

#include "find/find.h"
#include "job/job.h"
#include "mesh/cloud_mesh.h"

namespace fettle::find {

/// The job of an anomaly. Its frame is the anomaly's own; B and S are the anomaly's, with the heights of the part's
/// metal at their corners where that is seen. A surface is a plane if the metal between B and S is one within its
/// noise, else free-form. The passes run along B's longer side. The wheel travels above all of the part that lies under
/// its way. Probe, tolerance, wheel, forces, feed and removal are those of `settings`; a surface that is too curved for
/// its wheel gets a narrower or a smaller one in its place, and the step-over that goes with it.
/// @param part   in which the anomaly was found   @param noise  standard deviation of its points, mm
/// @throws InputError as job::validated(), if the boundaries bound nothing
job::Job job_for(const FoundAnomaly& anomaly, const mesh::CloudMesh& part, double noise, const job::Job& settings);

} // namespace fettle::find
