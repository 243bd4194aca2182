#include "compare/survey.h"

#include <tbb/task_group.h>

#include <cstddef>

namespace fettle {

namespace {

// Points whose errors set the colours: their 99th percentile is then good to a tenth of the percent beyond it.
constexpr std::size_t kSample = 1 << 14;

/// Every so-many-th point.
Eigen::Matrix3Xd sample(const PointSource& points)
{
    const std::size_t step = (points.points + kSample - 1) / kSample;
    Eigen::Matrix3Xd some(3, static_cast<Eigen::Index>(step == 0 ? 0 : (points.points + step - 1) / step));
    for_each_block(points, [&](std::size_t b, const PointBlock& block) {
        const std::size_t first = b * points.block;
        for (std::size_t i = (step - first % step) % step; i < static_cast<std::size_t>(block.xyz.cols()); i += step)
            some.col(static_cast<Eigen::Index>((first + i) / step)) = block.xyz.col(static_cast<Eigen::Index>(i));
    });
    return some;
}

} // namespace

struct Survey::State {
    Found found;
    tbb::task_group task;
};

Survey::Survey(const TestPoints& test, const DistanceOptions& options, bool sampled) : state_(std::make_unique<State>())
{
    state_->task.run([&found = state_->found, &test, options, sampled] {
        if (sampled) found.sample = sample(test.points);
        if (test.mesh)
            found.of_vertices = volume_areas(*test.mesh, options);
        else
            found.plan.emplace(test.points);
    });
}

Survey::~Survey()
{
    try {
        state_->task.wait();
    } catch (...) { // nobody asked for it
    }
}

const Survey::Found& Survey::found()
{
    state_->task.wait();
    return state_->found;
}

} // namespace fettle
