#include "belt/belt_grinding.h"

#include "core/error.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// The pressure's force evenly over the rectangle about the cells that touch.
MatrixXd evened(const MatrixXd& pressure)
{
    Index first_row = pressure.rows(), last_row = -1, first_column = pressure.cols(), last_column = -1;
    for (Index j = 0; j < pressure.cols(); ++j)
        for (Index i = 0; i < pressure.rows(); ++i)
            if (pressure(i, j) > 0) {
                first_row = std::min(first_row, i);
                last_row = std::max(last_row, i);
                first_column = std::min(first_column, j);
                last_column = std::max(last_column, j);
            }
    MatrixXd even = MatrixXd::Zero(pressure.rows(), pressure.cols());
    if (last_row < 0) return even;
    auto box = even.block(first_row, first_column, last_row - first_row + 1, last_column - first_column + 1);
    box.setConstant(pressure.sum() / static_cast<double>(box.size()));
    return even;
}

/// Of the surfels under the wheel. @param depth  over the cells of the last contact, mm
void add_losses(const WheelPress& press, const ContactCells& cells, const MatrixXd& depth, const Surfels& surfels,
                const Eigen::Vector3d& up, std::size_t point, std::vector<BeltLoss>& losses)
{
    // A surfel stands for the square about it.
    const double side = spacing_of(press.places());
    const SquareMeans lost_on(cells, depth, side);
    const Eigen::Vector2d touched = press.reach().array() + side / 2;
    const std::size_t first = losses.size();
    std::vector<Index> under;
    for (Index i = 0; i < press.places().cols(); ++i) {
        if ((press.places().col(i).head<2>().cwiseAbs().array() > touched.array()).any()) continue;
        losses.push_back({press.under()[static_cast<std::size_t>(i)], point, 0});
        under.push_back(i);
    }
    constexpr std::size_t kTogether = 1024; // a share of work worth a thread
    using Range = tbb::blocked_range<std::size_t>;
    tbb::parallel_for(Range(0, under.size(), kTogether), [&](const Range& range) {
        for (std::size_t k = range.begin(); k < range.end(); ++k) {
            BeltLoss& loss = losses[first + k];
            loss.depth =
                lost_on.about(press.places().col(under[k]).head<2>()) * surfels.normal.col(loss.surfel).dot(up);
        }
    });
}

} // namespace

BeltGrinding::BeltGrinding(Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path,
                           const BeltOptions& options)
    : surfels_(surfels), wheel_(wheel), path_(path), options_(options), way_(ways(path)),
      press_(surfels, wheel, options.press)
{
    state_.run.removed.setZero(surfels.size());
    if (options.range) state_.error = running_error(surfels.displacement, *options.range);
}

BeltState BeltGrinding::state() const
{
    BeltState state = state_;
    state.press = press_.memory();
    return state;
}

void BeltGrinding::go_on(BeltState state)
{
    state_ = std::move(state);
    press_.remember(state_.press);
}

/// What the surfels lose, and the account of it.
void BeltGrinding::take(const Press& pressed, const MatrixXd& depth, double duration)
{
    BeltRun& run = state_.run;
    if (!options_.keeps_losses) run.losses.clear();
    const std::size_t first = run.losses.size();
    const Eigen::Vector3d up = path_[state_.next].T_part_tool.linear().col(2);
    add_losses(press_, pressed.cells, depth, surfels_, up, state_.next, run.losses);
    for (std::size_t i = first; i < run.losses.size(); ++i) {
        const BeltLoss& loss = run.losses[i];
        const double before = surfels_.displacement[loss.surfel];
        surfels_.displacement[loss.surfel] -= loss.depth;
        run.removed[loss.surfel] += loss.depth;
        if (state_.error) change(*state_.error, before, surfels_.displacement[loss.surfel]);
    }
    const Contact& contact = pressed.contact;
    const double volume = depth.sum() * pressed.cells.cell.prod();
    run.removed_volume += volume;
    run.work += contact.force * wheel_.belt_speed * duration;
    run.near_edge += pressed.is_near_edge ? 1 : 0;
    const double time = (run.trace.empty() ? 0 : run.trace.back().time) + duration;
    run.trace.push_back(
        {time, duration, contact.force, contact.indentation, contact.pressure.maxCoeff(), pressed.area(), volume});
}

void BeltGrinding::step()
{
    const std::size_t k = state_.next;
    const BeltPoint& point = path_[k];
    BeltRun& run = state_.run;
    if (point.begins_run) press_.lift();
    if (point.is_on()) {
        const Press* pressed = nullptr;
        try {
            pressed = &press_.at(point.T_part_tool, point.pressing);
        } catch (const InputError& error) {
            throw InputError("point " + std::to_string(k), error.what());
        }
        const double moving = way_[static_cast<Index>(k)] / point.feed;
        const double cutting = moving + std::pow(point.dwell, wheel_.law.dwell);
        const auto depth_of = [&](double p) {
            return removed_depth(wheel_.law, p, wheel_.belt_speed, point.feed, cutting, options_.worn + run.work);
        };
        const MatrixXd& pressure = pressed->contact.pressure;
        take(*pressed,
             options_.model == BeltModel::local ? pressure.unaryExpr(depth_of) : evened(pressure).unaryExpr(depth_of),
             moving + point.dwell);
    } else {
        constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
        run.trace.push_back({run.trace.empty() ? 0 : run.trace.back().time, kNan, kNan, kNan, kNan, kNan, kNan});
    }
    if (const auto& error = state_.error)
        run.errors.push_back({error->counts.gouge, error->counts.within, error->counts.undercut, error->mean(),
                              error->rms(), error->least});
    ++state_.next;
}

BeltRun grind(Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path,
              const BeltOptions& options, const Progress& progress)
{
    BeltGrinding grinding(surfels, wheel, path, options);
    while (!grinding.is_done()) {
        tell(progress, static_cast<double>(grinding.run().trace.size()) / static_cast<double>(path.size()));
        grinding.step();
    }
    BeltRun run = grinding.run();
    if (!options.keeps_losses) run.losses.clear();
    return run;
}

} // namespace fettle
