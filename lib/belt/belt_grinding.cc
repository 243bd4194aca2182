#include "belt/belt_grinding.h"

#include "core/error.h"

#include <cmath>
#include <limits>
#include <string>

namespace fettle {

namespace {

using Eigen::Index;

bool is_on(const BeltPoint& point) { return point.T_part_tool.matrix().allFinite(); }

/// Half the ways to both neighbours, at the feed; and the dwell.
double duration_at(const std::vector<BeltPoint>& path, std::size_t k)
{
    const auto way = [&](std::size_t a, std::size_t b) {
        return is_on(path[a]) && is_on(path[b])
                   ? (path[a].T_part_tool.translation() - path[b].T_part_tool.translation()).norm()
                   : 0;
    };
    double half = 0;
    if (k > 0) half += way(k - 1, k) / 2;
    if (k + 1 < path.size()) half += way(k, k + 1) / 2;
    return half / path[k].feed + path[k].dwell;
}

} // namespace

BeltRun grind(Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path,
              const PressOptions& options, double worn, const Progress& progress)
{
    BeltRun run;
    run.removed.setZero(surfels.size());
    WheelPress press(surfels, wheel, options);
    double time = 0;
    for (std::size_t k = 0; k < path.size(); ++k) {
        tell(progress, static_cast<double>(k) / static_cast<double>(path.size()));
        const BeltPoint& point = path[k];
        if (!is_on(point)) {
            constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
            run.trace.push_back({time, kNan, kNan, kNan, kNan, kNan, kNan});
            press.lift();
            continue;
        }
        const Press* pressed = nullptr;
        try {
            pressed = &press.at(point.T_part_tool, point.pressing);
        } catch (const InputError& error) {
            throw InputError("point " + std::to_string(k), error.what());
        }
        const Contact& contact = pressed->contact;
        const ContactCells& cells = pressed->cells;
        const double duration = duration_at(path, k);
        const Eigen::MatrixXd depth = contact.pressure.unaryExpr([&](double p) {
            return removed_depth(wheel.law, p, wheel.belt_speed, point.feed, duration, worn + run.removed_volume);
        });
        // A surfel stands for the square about it.
        const double side = spacing_of(press.places());
        const SquareMeans lost_on(cells, depth, side);
        const Eigen::Vector2d touched = press.reach().array() + side / 2;
        const Eigen::Vector3d up = point.T_part_tool.linear().col(2);
        for (std::size_t i = 0; i < press.under().size(); ++i) {
            const Eigen::Vector2d place = press.places().col(static_cast<Index>(i)).head<2>();
            if ((place.cwiseAbs().array() > touched.array()).any()) continue;
            const Index surfel = press.under()[i];
            const double lost = lost_on.about(place) * surfels.normal.col(surfel).dot(up);
            surfels.displacement[surfel] -= lost;
            run.removed[surfel] += lost;
        }
        const double volume = depth.sum() * cells.cell.prod();
        time += duration;
        run.removed_volume += volume;
        run.near_edge += pressed->is_near_edge ? 1 : 0;
        run.trace.push_back(
            {time, duration, contact.force, contact.indentation, contact.pressure.maxCoeff(), pressed->area(), volume});
    }
    return run;
}

} // namespace fettle
