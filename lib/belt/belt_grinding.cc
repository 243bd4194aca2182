#include "belt/belt_grinding.h"

#include "core/error.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace fettle::belt {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Spreads the pressure evenly over the bounding rectangle of the cells in contact; the force stays the same.
MatrixXd spread_over_rectangle(const MatrixXd& pressure)
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
    MatrixXd result = MatrixXd::Zero(pressure.rows(), pressure.cols());
    if (last_row < 0) return result;
    auto rectangle = result.block(first_row, first_column, last_row - first_row + 1, last_column - first_column + 1);
    rectangle.setConstant(pressure.sum() / rectangle.size());
    return result;
}

/// A depth on the cells of a contact, at surfels, from means over squares around them. Where squares reach over the
/// border of the workpiece, the means are of what lies inside.
class SurfelDepth {
  public:
    /// @param depth  mm   @param coverage  of the cells   @param spacing  of the surfels, mm
    SurfelDepth(const ContactGrid& grid, const MatrixXd& depth, const MatrixXd& coverage, double spacing)
        : depth_(grid, depth.cwiseProduct(coverage)), spacing_(spacing)
    {
        if ((coverage.array() < 1).any()) uncovered_.emplace(grid, (1 - coverage.array()).matrix());
    }

    /// Largest distance from a surfel at which it loses something, along each axis, mm.
    double reach() const { return 1.5 * spacing_; }
    /// Mean over the square that a surfel represents: squares that tile the plane share all that is removed.
    double square_mean(const Eigen::Vector2d& place) const { return mean(place, spacing_); }
    /// Depth at the surfel. Of a smooth depth the mean over a square of side s is s²/24 times the second derivatives
    /// less, on a narrow contact a good part of it; that over a square three times as wide shows by how much. Beside
    /// the border of the contact the depth is a ramp instead, which begins within the square: a ramp that begins t
    /// sides before the surfel has the means s (t + 1/2)² / 2 and s (t + 3/2)² / 6 times its slope.
    double in_the_middle(const Eigen::Vector2d& place) const
    {
        const double narrow = mean(place, spacing_), wide = mean(place, 3 * spacing_);
        if (!(narrow > 0)) return 0;
        const double smooth = (9 * narrow - wide) / 8, root = std::sqrt(narrow / (3 * wide));
        const double t = (3 * root - 1) / (2 * (1 - root));
        if (t >= 0.5) return smooth;
        return t > 0 ? std::min(narrow * 2 * t / ((t + 0.5) * (t + 0.5)), smooth) : 0;
    }

  private:
    double mean(const Eigen::Vector2d& place, double side) const
    {
        constexpr double kMinCovered = 0.05; // less is the rounding of the border to cells
        const double inside = uncovered_ ? 1 - uncovered_->mean_around(place, side) : 1;
        return inside < kMinCovered ? 0 : depth_.mean_around(place, side) / inside;
    }

    BoxAverage depth_;
    std::optional<BoxAverage> uncovered_;
    double spacing_;
};

/// Depths that the surfels under the last contact lose at a point of the path.
/// @param depth  normal to the tangent plane, on the cells of the contact, mm
/// @param model  the global one's depth ends in a step, which surfels share
std::vector<SurfelRemoval> surfel_removals(const WheelContactSolver& solver, const WheelContact& contact,
                                           const MatrixXd& depth, BeltModel model, const Surfels& surfels,
                                           const Eigen::Vector3d& up, std::size_t point)
{
    const Eigen::Matrix3Xd& coordinates = solver.surfel_coordinates();
    const SurfelDepth surfel_depth(contact.grid, depth, contact.coverage, mean_spacing(coordinates));
    const Eigen::Vector2d reach = solver.contact_extent().array() + surfel_depth.reach();
    std::vector<SurfelRemoval> removals;
    std::vector<Index> in_contact;
    for (Index i = 0; i < coordinates.cols(); ++i) {
        if ((coordinates.col(i).head<2>().cwiseAbs().array() > reach.array()).any()) continue;
        removals.push_back({solver.surfels_in_grid()[i], point, 0});
        in_contact.push_back(i);
    }
    constexpr std::size_t kGrainSize = 1024; // surfels for one task
    using Range = tbb::blocked_range<std::size_t>;
    tbb::parallel_for(Range(0, in_contact.size(), kGrainSize), [&](const Range& range) {
        for (std::size_t k = range.begin(); k < range.end(); ++k) {
            const Eigen::Vector2d place = coordinates.col(in_contact[k]).head<2>();
            const double lost =
                model == BeltModel::local ? surfel_depth.in_the_middle(place) : surfel_depth.square_mean(place);
            removals[k].depth = lost * surfels.normal.col(removals[k].surfel).dot(up);
        }
    });
    return removals;
}

} // namespace

BeltGrinding::BeltGrinding(Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path,
                           const BeltOptions& options)
    : surfels_(surfels), wheel_(wheel), path_(path), options_(options), tributary_lengths_(tributary_lengths(path)),
      solver_(surfels, wheel, options.contact, &state_.run.removed)
{
    state_.run.removed.setZero(surfels.size());
    if (options.range) state_.error = running_error(surfels.displacement, *options.range);
}

BeltState BeltGrinding::state() const
{
    BeltState state = state_;
    state.contact = solver_.state();
    return state;
}

void BeltGrinding::restore(BeltState state)
{
    state_ = std::move(state);
    solver_.restore(state_.contact);
}

/// Between cells farther apart than the surfels, the contact does not see how high single surfels stand.
void BeltGrinding::count_coarse_grid(const WheelContact& contact)
{
    const double ratio = contact.grid.cell_size.maxCoeff() / mean_spacing(solver_.surfel_coordinates());
    if (!(ratio > kMaxCellSpacings)) return;
    ++state_.run.coarse_grids;
    state_.run.max_cell_spacings = std::max(state_.run.max_cell_spacings, ratio);
}

/// Lowers the surfels and records the point's results.
void BeltGrinding::remove_material(const WheelContact& contact, const MatrixXd& depth, double duration)
{
    BeltRun& run = state_.run;
    const Eigen::Vector3d up = path_[state_.next_point].T_part_tool.linear().col(2);
    const std::vector<SurfelRemoval> removals =
        surfel_removals(solver_, contact, depth, options_.model, surfels_, up, state_.next_point);
    for (const SurfelRemoval& removal : removals) {
        const double before = surfels_.displacement[removal.surfel];
        surfels_.displacement[removal.surfel] -= removal.depth;
        run.removed[removal.surfel] += removal.depth;
        if (state_.error) state_.error->update(before, surfels_.displacement[removal.surfel]);
    }
    if (options_.keep_removals) run.removals.insert(run.removals.end(), removals.begin(), removals.end());
    const Contact& found = contact.contact;
    const bool is_local = options_.model == BeltModel::local;
    const double volume =
        (is_local ? depth.cwiseProduct(contact.coverage) : depth).sum() * contact.grid.cell_size.prod();
    run.removed_volume += volume;
    run.work += found.force * wheel_.belt_speed * duration;
    run.near_edge += contact.is_near_edge ? 1 : 0;
    count_coarse_grid(contact);
    const double time = (run.trace.empty() ? 0 : run.trace.back().time) + duration;
    run.trace.push_back(
        {time, duration, found.force, found.indentation, found.pressure.maxCoeff(), contact.area(), volume});
}

void BeltGrinding::step()
{
    const std::size_t k = state_.next_point;
    const BeltPoint& point = path_[k];
    BeltRun& run = state_.run;
    if (point.touches_down) solver_.reset();
    if (point.is_on_part()) {
        const double moving_time = tributary_lengths_[k] / point.feed;
        const double cutting_time = moving_time + std::pow(point.dwell, wheel_.law.dwell_exponent);
        const RemovalStep removal =
            removal_step(wheel_.law, wheel_.belt_speed, point.feed, cutting_time, options_.prior_work + run.work);
        const bool is_local = options_.model == BeltModel::local;
        const WheelContact* contact = nullptr;
        try {
            contact = &solver_.solve(point.T_part_tool, point.load, is_local ? removal : RemovalStep{});
        } catch (const core::InputError& error) {
            throw core::InputError("point " + std::to_string(k), error.what());
        }
        const auto depth_at = [&](double p) { return removal.depth(p); };
        remove_material(*contact,
                        is_local ? contact->workpiece_pressure().unaryExpr(depth_at)
                                 : spread_over_rectangle(contact->contact.pressure).unaryExpr(depth_at),
                        moving_time + point.dwell);
    } else {
        constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
        run.trace.push_back({run.trace.empty() ? 0 : run.trace.back().time, kNan, kNan, kNan, kNan, kNan, kNan});
    }
    if (const auto& error = state_.error)
        run.errors.push_back({error->counts.gouge, error->counts.within, error->counts.undercut, error->mean(),
                              error->rms(), error->min});
    ++state_.next_point;
}

BeltRun grind(Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path,
              const BeltOptions& options, const core::Progress& progress)
{
    BeltGrinding grinding(surfels, wheel, path, options);
    while (!grinding.is_done()) {
        core::report_progress(progress, grinding.progress());
        grinding.step();
    }
    return grinding.run();
}

} // namespace fettle::belt
