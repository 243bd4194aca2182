#pragma once

#include "job/job.h"

#include <Eigen/Core>

#include <string>

namespace fettle {

/// Does a part's bounding box look as if the file were in another unit than was taken, or the job for another part?
/// @param box  least and greatest corner, M, mm
/// @return a sentence for a warning, empty if the box is plausible
std::string implausible_box(const Eigen::Matrix<double, 3, 2>& box, const Job& job);

} // namespace fettle
