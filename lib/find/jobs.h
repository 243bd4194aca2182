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

/// Adds a doubt to anomalies where the metal around scatters about the surface through it by more than the tolerance of
/// `settings`: it does not show what is to be ground to.
void doubt_scatter(FindResult& result, const job::Job& settings);

/// The job of an anomaly. Its frame is the anomaly's own; B and S are the anomaly's, with the heights of the part's
/// metal at their corners where that is seen; neither goes over an edge of the part. A surface is a plane if that is
/// expected to leave no more than a free-form surface does, by the bend of the robust surface through the metal between
/// B and S, and to cut nothing by more than the tolerance, else free-form; a plane's B has as many corners, its
/// touches, as the tolerance needs. The passes run along B's longer side. The wheel travels above all of the part that
/// lies under its way. Probe, tolerance, wheel, forces, feed and removal are those of `settings`. A surface that is too
/// curved for its wheel gets that of the first of `others` that fits, with the forces, feed and removal that go with
/// it; without one, a narrower or smaller one than the template's.
/// @param part  in which the anomaly was found
/// @throws InputError as job::validated(), if the boundaries bound nothing
FoundJob job_for(const FoundAnomaly& anomaly, const mesh::CloudMesh& part, const job::Job& settings,
                 std::span<const job::Job> others = {});

} // namespace fettle::find
