#include "geometry/plane_normals.h"

#include "core/decompositions.h"
#include "geometry/point_index.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace fettle::geometry {
namespace {

constexpr Eigen::Index kNeighbours = 16; // see the header
constexpr std::size_t kLinks = 8;        // of a point: the surface hangs together, and normals agree along them

} // namespace

PlaneNormals plane_normals(const Eigen::Matrix3Xd& xyz)
{
    const PointIndex<3> index(xyz);
    PlaneNormals planes{Eigen::Matrix3Xd::Zero(3, xyz.cols()), {}};
    planes.links.resize(static_cast<std::size_t>(xyz.cols()));
    tbb::parallel_for(Eigen::Index{0}, xyz.cols(), [&](Eigen::Index i) {
        const std::vector<Eigen::Index> near = index.nearest(xyz.col(i), kNeighbours);
        if (near.size() < 3) return;
        Eigen::Matrix3Xd local = xyz(Eigen::all, near);
        local.colwise() -= Eigen::Vector3d(local.rowwise().mean());
        planes.normals.col(i) = core::symmetric_eigen<3>(local * local.transpose()).vectors.col(0);
        auto& links = planes.links[static_cast<std::size_t>(i)];
        for (std::size_t k = 1; k < std::min(kLinks + 1, near.size()); ++k)
            links.push_back(static_cast<std::uint32_t>(near[k]));
    });
    // Links are taken from the smaller index only.
    for (std::uint32_t a = 0; a < planes.links.size(); ++a)
        for (const std::uint32_t b : planes.links[a])
            if (b < a) planes.links[b].push_back(a);
    return planes;
}

} // namespace fettle::geometry
