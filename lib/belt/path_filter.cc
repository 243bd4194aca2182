#include "belt/path_filter.h"

#include "belt/surfel_index.h"
#include "geometry/point_index.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace fettle::belt {

namespace {

using Eigen::Index;

/// Is a point in the wheel less its layer?
/// @param p  in the tool frame
bool is_in_hub(const ContactWheel& wheel, const Eigen::Vector3d& p)
{
    const double profile = wheel_profile(wheel, 0, p.y()); // infinite beside the wheel
    return std::hypot(p.x(), wheel.radius - p.z()) < wheel.radius - wheel.layer.thickness - profile;
}

} // namespace

PathSelection select_high_stock(const Surfels& surfels, const ContactPath& path, double radius, double height)
{
    std::vector<Index> high;
    for (Index i = 0; i < surfels.size(); ++i)
        if (surfels.displacement[i] > height) high.push_back(i);
    const geometry::PointIndex<3> index(surfels.position(Eigen::all, high));
    PathSelection selection;
    for (const Eigen::Isometry3d& pose : path.poses)
        selection.push_back(index.nearest_within(pose.translation(), radius).has_value());
    return selection;
}

PathSelection select_by_room(const Surfels& surfels, const ContactPath& path, const ContactWheel& wheel)
{
    const SurfelIndex index(surfels, wheel.radius / 4);
    const Eigen::AlignedBox3d box(Eigen::Vector3d(-wheel.radius, -wheel.width / 2, 0),
                                  Eigen::Vector3d(wheel.radius, wheel.width / 2, 2 * wheel.radius));
    std::vector<char> has_room(path.poses.size());
    tbb::parallel_for(std::size_t{0}, path.poses.size(), [&](std::size_t k) {
        std::vector<Index> near;
        index.box_search(path.poses[k], box, near);
        const Eigen::Isometry3d T_tool_part = path.poses[k].inverse();
        has_room[k] = std::ranges::none_of(
            near, [&](Index i) { return is_in_hub(wheel, T_tool_part * surfels.position.col(i)); });
    });
    return {has_room.begin(), has_room.end()};
}

ContactPath select_points(const ContactPath& path, const PathSelection& selection)
{
    ContactPath selected;
    selected.skipped_patches = path.skipped_patches;
    int pass = -1;
    for (std::size_t k = 0; k < path.poses.size(); ++k) {
        if (!selection[k]) continue;
        if (k == 0 || !selection[k - 1] || path.pass[k] != path.pass[k - 1]) ++pass;
        selected.poses.push_back(path.poses[k]);
        selected.pass.push_back(pass);
    }
    return selected;
}

} // namespace fettle::belt
