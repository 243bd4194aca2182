#pragma once

#include "job/job.h"

#include <Eigen/Core>

#include <string>

namespace fettle {

/// Does a part's bounding box look as if the file were in another unit than was taken, or the job for another part?
/// @param box  least and greatest corner, M, mm
/// @return a sentence for a warning, empty if the box is plausible
std::string implausible_box(const Eigen::Matrix<double, 3, 2>& box, const Job& job);

/// Do touches lie higher or lower than the job's boundary points by more than the boundary is long, as if the part were
/// in another unit than was taken, or lay elsewhere when the job was taught?
/// @param touches  3xN, M, mm; NaN: none
/// @return a sentence for a warning, empty if not, or if no boundary point has a z
std::string implausible_height(const Eigen::Matrix3Xd& touches, const Job& job);

} // namespace fettle
