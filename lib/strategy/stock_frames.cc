#include "strategy/stock_frames.h"

#include "cloud/cloud.h"
#include "draw/figures.h"
#include "draw/picture.h"
#include "surface/surface.h"

#include <algorithm>

namespace fettle::strategy {

void add_frames(draw::Frames& frames, const std::vector<TraceRow>& trace, const plan::Plan& plan,
                const removal::HeightField& stock)
{
    constexpr double kScaleTolerances = 4; // errors within the tolerance are pale
    draw::PictureOptions options;
    constexpr int kWidth = 480; // pixels
    options.width = kWidth;
    options.field = "error";
    options.units = plan.job.units;
    options.job = plan.job;
    options.scale = kScaleTolerances * plan.job.tolerance / plan.job.units.mm();
    std::vector<double> ends;
    for (const TraceRow& row : trace) ends.push_back(row.time);
    removal::HeightField now = stock;
    Eigen::VectorXd desired; // the same places in every picture
    std::size_t from = 0;
    for (const std::size_t step : frames.steps(ends)) {
        now = replay_removal({trace.begin() + Eigen::Index(from), trace.begin() + Eigen::Index(step) + 1}, plan.job,
                             std::move(now));
        from = step;
        cloud::Cloud cloud = removal::to_cloud(stock, now);
        if (desired.size() == 0) desired = surface::heights(plan.surface, cloud.xyz.topRows<2>());
        cloud::set_field(cloud, "error", cloud.xyz.row(2).transpose() - desired);
        options.title = draw::duration_text(trace[step].time) + ", layer " + std::to_string(trace[step].layer);
        frames.add(trace[step].time, draw::picture(cloud, options));
    }
}

} // namespace fettle::strategy
