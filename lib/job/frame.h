#pragma once

#include "job/job.h"
#include "mesh/shape_file.h"

namespace fettle::job {

// A job may have a frame of its own (Job::T_part_job), in which its anomaly faces up. Boundaries, touches, surface and
// plan are in that frame; scans, stocks and references are in the part's. Each tool moves what it reads into the job's
// frame, and labels what it writes with it (`# frame job`), so that the next tool does not move it again. Without a
// pose both frames are the same, and nothing is moved or labelled.

/// Moves points with their normals, or a mesh, from the part's frame to the job's, unless they are there already.
void move_to_job_frame(cloud::Cloud& cloud, const Job& job);
void move_to_job_frame(mesh::Mesh& mesh, const Job& job);
void move_to_job_frame(mesh::MeshOrCloud& shape, const Job& job);

/// The points as they are, labelled as being in the job's frame.
cloud::Cloud in_job_frame(cloud::Cloud cloud, const Job& job);

/// True if move_to_job_frame() would move what is in this frame.
bool must_be_moved(cloud::Frame frame, const Job& job);

} // namespace fettle::job
