#include "job/open_side.h"

namespace fettle::job {
namespace {

// Metal beyond a corner of B is wider than this share of S's diagonal: about half a cell of a found S, which goes along
// the cells' edges where it is open.
constexpr double kMinRoomShare = 0.02;

} // namespace

std::vector<Eigen::Index> corners_on_metal(const Polygon& anomaly, const Polygon& sampling)
{
    double room = 0;
    if (sampling.cols() > 0)
        room = kMinRoomShare * (sampling.rowwise().maxCoeff() - sampling.rowwise().minCoeff()).norm();
    std::vector<Eigen::Index> corners;
    for (Eigen::Index i = 0; i < anomaly.cols(); ++i)
        if (sampling.cols() == 0 || distance_to_edge(sampling, anomaly.col(i)) > room) corners.push_back(i);
    return corners;
}

} // namespace fettle::job
