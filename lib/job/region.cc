#include "job/region.h"

#include "job/boundary.h"

#include <tbb/parallel_for.h>

namespace fettle::job {

std::vector<Region> classify_regions(const Job& job, const Eigen::Matrix3Xd& xyz)
{
    const Boundaries polygons = working_boundaries(job);
    const Eigen::Matrix2d R_working_machine = rotation_working_machine(job.theta);
    std::vector<Region> regions(xyz.cols(), Region::outside);
    tbb::parallel_for(Eigen::Index{0}, xyz.cols(), [&](Eigen::Index i) {
        if (!xyz.col(i).allFinite()) return;
        const Eigen::Vector2d point = R_working_machine * xyz.col(i).head<2>();
        Region& region = regions[i];
        if (contains(polygons.anomaly, point))
            region = Region::inside;
        else if (polygons.sampling.cols() > 0 && contains(polygons.sampling, point))
            region = Region::around;
    });
    return regions;
}

} // namespace fettle::job
