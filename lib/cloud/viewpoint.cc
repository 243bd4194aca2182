#include "cloud/viewpoint.h"

namespace fettle::cloud {

bool has_viewpoint(const Cloud& cloud)
{
    return !cloud.view_origin.isZero(0) ||
           cloud.view_orientation.coeffs() != Eigen::Quaterniond::Identity().coeffs(); // to the bit
}

void set_viewpoint(Cloud& cloud, const Eigen::Vector3d& origin, const Eigen::Quaterniond& orientation)
{
    cloud.view_origin = origin;
    const Eigen::Vector4d q = orientation.normalized().coeffs();
    cloud.view_orientation.coeffs() = (q.w() < 0 ? Eigen::Vector4d(-q) : q).array() + 0.0; // no -0
    if (!has_viewpoint(cloud)) cloud.view_orientation = Eigen::Quaterniond(-1, 0, 0, 0);
}

} // namespace fettle::cloud
