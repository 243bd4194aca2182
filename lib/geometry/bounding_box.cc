#include "geometry/bounding_box.h"

#include "core/constants.h"

namespace fettle::geometry {

Eigen::AlignedBox3d finite_bounding_box(const Eigen::Matrix3Xd& points)
{
    Eigen::AlignedBox3d box;
    for (const auto& point : points.colwise())
        if (point.allFinite()) box.extend(point);
    if (box.isEmpty()) box.min() = box.max() = Eigen::Vector3d::Constant(core::kNaN);
    return box;
}

} // namespace fettle::geometry
