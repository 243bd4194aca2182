#pragma once

#include "cloud/cloud.h"

#include <Eigen/Geometry>

namespace fettle::cloud {

/// Whether anything says where a cloud was seen from. `VIEWPOINT 0 0 0 1 0 0 0` is what writers of PCD put who know
/// nothing: it is unknown, and stays as it is when the cloud is moved. Many scanners do stand at the origin of their
/// own frame; who knows that writes `VIEWPOINT 0 0 0 -1 0 0 0`, the same place and rotation (q and -q), and not the
/// default. The readers of formats that state a scanner, PTX and E57, put it so into the cloud, too.
bool has_viewpoint(const Cloud& cloud);

/// Sets a viewpoint that is known, at the origin, too. @param orientation  of any length but 0
void set_viewpoint(Cloud& cloud, const Eigen::Vector3d& origin, const Eigen::Quaterniond& orientation);

} // namespace fettle::cloud
