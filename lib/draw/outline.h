#pragma once

#include "job/job.h"
#include "mesh/shape_file.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace fettle::draw {

/// A boundary of a job, drawn on a part.
struct Outline {
    std::string name;         ///< "B" or "S"
    Eigen::Matrix3Xd corners; ///< 3xN, M, as in the job; z is that of the part where the job has none
    Eigen::Matrix3Xd line;    ///< closed, 3xN, M: along the edges, on the part's surface as it is seen from above
};

/// The outlines of a job's B and S, as far as it has them. Where there is no part beneath an edge, the line goes
/// straight from height to height.
std::vector<Outline> outlines_on(const mesh::MeshOrCloud& part, const job::Job& job);

} // namespace fettle::draw
