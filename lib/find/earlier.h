#pragma once

#include "find/find.h"
#include "job/job.h"

#include <string>
#include <vector>

namespace fettle::find {

/// A job of an earlier casting of the same kind.
struct EarlierJob {
    std::string file;
    job::Job job;
};

/// Reads all jobs of a folder, by name; frames of jobs without a pose are the part's.
/// @throws InputError if the folder cannot be read or has none, or as job::read_job()
std::vector<EarlierJob> read_earlier_jobs(const std::string& folder);

/// Takes what was found where an earlier job is for the same anomaly again: its row names that job, has no doubt, and
/// has the job's own frame, B and S if B is around all of it, else those that were found. Finds within one B become one
/// row. Rows elsewhere stay if they are probable by themselves. `absent` becomes the jobs at whose places is nothing.
/// @param T_earlier_part   puts the part onto the one for which the jobs were made
/// @param min_probability  of rows where no job is
void match_earlier(FindResult& result, const mesh::CloudMesh& part, const std::vector<EarlierJob>& jobs,
                   const Eigen::Isometry3d& T_earlier_part, double min_probability);

} // namespace fettle::find
