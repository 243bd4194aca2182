#include "compare/survey.h"

#include <tbb/task_group.h>

#include <cstddef>
#include <exception>

namespace fettle::compare {

namespace {

// Size of the sample whose errors set the colours. The rank of its 99th percentile is good to a tenth of a percent.
constexpr std::size_t kMaxSamplePoints = 1 << 14;

Eigen::Matrix3Xd sample(const cloud::PointSource& points)
{
    const std::size_t step = (points.points + kMaxSamplePoints - 1) / kMaxSamplePoints;
    Eigen::Matrix3Xd chosen(3, step == 0 ? 0 : (points.points + step - 1) / step);
    cloud::for_each_block(points, [&](std::size_t b, const cloud::PointBlock& block) {
        const std::size_t first = b * points.block_size;
        for (std::size_t i = (step - first % step) % step; i < static_cast<std::size_t>(block.xyz.cols()); i += step)
            chosen.col((first + i) / step) = block.xyz.col(i);
    });
    return chosen;
}

} // namespace

struct Survey::State {
    Results results;
    tbb::task_group task;
};

Survey::Survey(const TestPoints& test, const DistanceOptions& options, bool sampled) : state_(std::make_unique<State>())
{
    state_->task.run([&results = state_->results, &test, options, sampled] {
        if (sampled) results.sample = sample(test.points);
        if (test.mesh)
            results.vertex_weights = volume_weights(*test.mesh, options);
        else
            results.plan_areas.emplace(test.points);
    });
}

Survey::~Survey()
{
    try {
        state_->task.wait();
    } catch (const std::exception&) { // results() was not called: nobody needs the error
    }
}

const Survey::Results& Survey::results()
{
    state_->task.wait();
    return state_->results;
}

} // namespace fettle::compare
