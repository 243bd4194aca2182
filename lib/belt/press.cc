#include "belt/press.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace fettle::belt {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;

constexpr Index kCoarseCells = 24;       // per side, to find the extent of the contact
constexpr double kMaxRadiusShare = 0.99; // of the radius for the grid: beyond it the wheel's profile is too steep

/// Half length of the wheel's intersection with a plane at a tenth of the layer's thickness, and half its width.
Vector2d initial_half_size(const ContactWheel& wheel)
{
    return {std::min(std::sqrt(2 * wheel.radius * wheel.layer.thickness / 10), kMaxRadiusShare * wheel.radius),
            wheel.width / 2};
}

ContactGrid square_grid(const Vector2d& half, Index count) { return {2 * half / count, count, count}; }

/// A grid of count x count; under a contact that is long in the direction of the feed, as on a bead, up to twice as
/// many along it, where the pressure varies less, and three quarters as many across. In multiples of the sizes for
/// which convolutions are quick.
ContactGrid fitted_grid(const Vector2d& half, Index count)
{
    constexpr double kMaxSquareRatio = 4, kMaxCellRatio = 2, kMaxStretch = 2, kLongColumns = 0.75;
    constexpr Index kSizeMultiple = 8;
    const double ratio = half.x() / half.y();
    if (ratio <= kMaxSquareRatio) return square_grid(half, count);
    const auto multiple = [](double size) { return kSizeMultiple * std::max(1L, std::lround(size / kSizeMultiple)); };
    const auto size = static_cast<double>(count);
    const Index columns = multiple(kLongColumns * size);
    const Index rows = multiple(std::min(static_cast<double>(columns) * ratio / kMaxCellRatio, kMaxStretch * size));
    return {{2 * half.x() / static_cast<double>(rows), 2 * half.y() / static_cast<double>(columns)}, rows, columns};
}

/// Does what reaches so far from the middle of the width come near the layer's sides? At this distance from a side
/// rubber of ν = 0.49 yields 0.5 % more than without one, at a sixth of it 5 %.
bool is_near_edge(double extent, const ContactWheel& wheel)
{
    constexpr double kEdgeZoneThicknesses = 1.5;
    return extent > wheel.width / 2 - kEdgeZoneThicknesses * wheel.layer.thickness;
}

/// Converts points from the tool frame to coordinates along the wheel's arc, along its axis, and inwards from the arc.
void unroll_arc(double radius, Eigen::Matrix3Xd& points)
{
    for (auto p : points.colwise()) {
        const double below = radius - p.z(), x = p.x();
        p.x() = radius * std::atan2(x, below);
        p.z() = radius - std::hypot(x, below);
    }
}

} // namespace

WheelContactSolver::WheelContactSolver(const Surfels& surfels, const ContactWheel& wheel,
                                       const WheelContactOptions& options, const Eigen::VectorXd* removed)
    : surfels_(surfels), wheel_(wheel), removed_(removed), options_(options),
      index_(surfels, initial_half_size(wheel).minCoeff() / 4),
      max_displacement_(surfels.displacement.array().isNaN().select(0, surfels.displacement.array().abs()).maxCoeff())
{
}

/// @param sees_edges  of LayerSolver::layer
void WheelContactSolver::set_grid(const ContactGrid& grid, LayerSolver solver, bool sees_edges)
{
    contact_.grid = grid;
    if (solver == LayerSolver::fem) {
        contact_.arc_radius = wheel_.radius;
        layer_.emplace(
            layer_mesh(wheel_.layer, wheel_.radius, wheel_.width, grid.cell_size, grid.columns, options_.elements),
            grid.rows);
    } else {
        contact_.arc_radius = std::numeric_limits<double>::infinity();
        if (sees_edges && grid.columns <= kMaxEdgeCells && is_near_edge(grid.half_size().y(), wheel_)) {
            if (!edges_) edges_.emplace(wheel_.layer, wheel_.radius, wheel_.width);
            layer_.emplace(wheel_.layer, *edges_, grid.cell_size, grid.rows, grid.columns);
        } else {
            layer_.emplace(wheel_.layer, grid.cell_size, grid.rows, grid.columns);
        }
    }
    reset();
}

void WheelContactSolver::reset()
{
    contact_.contact.pressure.resize(0, 0);
    previous_pressure_.resize(0, 0);
}

WheelContactState WheelContactSolver::state() const
{
    return {contact_.grid, contact_.contact.pressure, previous_pressure_};
}

void WheelContactSolver::restore(const WheelContactState& state)
{
    layer_.reset();
    contact_.grid = state.grid;
    if (state.grid.rows > 0) set_grid(state.grid, options_.solver, true);
    contact_.contact.pressure = state.pressure;
    previous_pressure_ = state.previous;
}

void WheelContactSolver::solve_on_grid(const Eigen::Isometry3d& T_part_tool, const ContactLoad& load, Gridding gridding,
                                       double tolerance, const RemovalStep& removal)
{
    const ContactGrid& grid = contact_.grid;
    const double max_depth = wheel_.layer.thickness;
    Eigen::Vector3d upper;
    upper << kGridMargin * grid.half_size(), std::hypot(kGridMargin * grid.half_size().norm(), max_depth);
    Eigen::Vector3d lower(-upper);
    lower.z() = -max_depth;
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(max_displacement_); // the index has undisplaced positions
    index_.box_search(T_part_tool, {lower - margin, upper + margin}, surfels_in_grid_);
    surfel_coordinates_ = select_facing_surfels(surfels_, surfels_in_grid_, T_part_tool, grid, max_depth);
    ContactWheel wheel = wheel_; // in the grid's coordinates
    if (std::isfinite(contact_.arc_radius)) {
        unroll_arc(wheel_.radius, surfel_coordinates_);
        wheel.radius = std::numeric_limits<double>::infinity();
    }
    Eigen::VectorXd removed;
    if (removed_) removed = (*removed_)(surfels_in_grid_);
    GriddedHeights workpiece = interpolate_heights(grid, surfel_coordinates_, gridding, removed);
    contact_.height = std::move(workpiece.height);
    contact_.coverage = std::move(workpiece.coverage);
    gap_.resize(grid.rows, grid.columns);
    for (Index j = 0; j < grid.columns; ++j)
        for (Index i = 0; i < grid.rows; ++i) {
            const Vector2d center = grid.cell_center(i, j);
            const double height = contact_.height(i, j);
            gap_(i, j) = std::isnan(height) ? std::numeric_limits<double>::infinity()
                                            : wheel_profile(wheel, center.x(), center.y()) - height;
        }
    if (!gap_.array().isFinite().any()) throw core::InputError("there is nothing under the wheel");
    const RemovalStep step = removal.scaled(implicit_share(removal));
    MatrixXd start = contact_.contact.pressure;
    if (previous_pressure_.size() > 0) start = (2 * start - previous_pressure_).eval();
    previous_pressure_ = contact_.contact.pressure;
    const MatrixXd coverage = partial_coverage();
    contact_.contact = load.by_force ? layer_->solve_by_force(gap_, load.value, tolerance, start, step, coverage)
                                     : layer_->solve_by_indentation(gap_, load.value, tolerance, start, step, coverage);
    if (!contact_.contact.converged) throw core::InputError("the contact did not converge to the tolerance");
}

MatrixXd WheelContactSolver::partial_coverage() const
{
    const auto coverage = contact_.coverage.array();
    return (coverage > 0 && coverage < 1).any() ? contact_.coverage : MatrixXd();
}

/// With z = r'(p) / C the share 1/(1 - exp(-z)) - 1/z gives a wave of compliance C the exact factor exp(-z) in each
/// step (Liniger and Willoughby 1970). C is that of the shortest ripple that surfels can have, less by its mean over a
/// surfel's square: longer ones, of larger C, decay without changing sign.
double WheelContactSolver::implicit_share(const RemovalStep& removal) const
{
    if (contact_.contact.pressure.size() == 0) return 1; // the pressure is not known yet
    const ElasticLayer& layer = wheel_.layer;
    const double z = removal.slope(contact_.contact.pressure.maxCoeff()) * layer.young /
                     ((1 - layer.poisson * layer.poisson) * mean_spacing(surfel_coordinates_));
    constexpr double kSmallRatio = 1e-3; // below it the limit is as good as the difference
    return z > kSmallRatio ? 1 / -std::expm1(-z) - 1 / z : 0.5;
}

Vector2d WheelContactSolver::contact_extent() const
{
    Vector2d extent = Vector2d::Zero();
    for (Index j = 0; j < contact_.grid.columns; ++j)
        for (Index i = 0; i < contact_.grid.rows; ++i)
            if (contact_.contact.pressure(i, j) > 0)
                extent = extent.cwiseMax(contact_.grid.cell_center(i, j).cwiseAbs() + contact_.grid.cell_size / 2);
    return extent;
}

/// Does the contact reach the border of a grid that could be larger?
bool WheelContactSolver::is_at_border() const
{
    const Eigen::Array2d half = contact_.grid.half_size().array(), extent = contact_extent().array();
    const Eigen::Array2d max_half(kMaxRadiusShare * wheel_.radius, wheel_.width / 2);
    return (extent > half - 1.5 * contact_.grid.cell_size.array() && half < 0.999 * max_half).any();
}

void WheelContactSolver::find_grid(const Eigen::Isometry3d& T_part_tool, const ContactLoad& load,
                                   const RemovalStep& removal)
{
    constexpr double kGridPerExtent = 1.3;
    constexpr double kCoarseTolerance = 1e-3, kMinShrinkage = 0.5;
    constexpr int kMaxRefinements = 3;
    const Vector2d max_half(kMaxRadiusShare * wheel_.radius, wheel_.width / 2);
    Vector2d half = layer_ ? Vector2d(1.5 * contact_.grid.half_size()) : initial_half_size(wheel_);
    for (;; half *= 2) {
        half = half.cwiseMin(max_half);
        set_grid(square_grid(half, kCoarseCells), LayerSolver::layer, false);
        solve_on_grid(T_part_tool, load, Gridding::shepard, kCoarseTolerance, removal);
        if (!is_at_border()) break;
    }
    // The extent is known to a cell: on a grid that is much larger than the contact, not well enough.
    for (int k = 0; k < kMaxRefinements; ++k) {
        const Vector2d fitting = (kGridPerExtent * contact_extent() + contact_.grid.cell_size).cwiseMin(half);
        const bool is_close = (fitting.array() > kMinShrinkage * half.array()).all();
        half = fitting;
        if (is_close) break;
        set_grid(square_grid(half, kCoarseCells), LayerSolver::layer, false);
        solve_on_grid(T_part_tool, load, Gridding::shepard, kCoarseTolerance, removal);
    }
    set_grid(fitted_grid(half, options_.cells_per_side), options_.solver, true);
}

const WheelContact& WheelContactSolver::solve(const Eigen::Isometry3d& T_part_tool, const ContactLoad& load,
                                              const RemovalStep& removal)
{
    if (!layer_) find_grid(T_part_tool, load, removal);
    solve_on_grid(T_part_tool, load, options_.gridding, options_.tolerance, removal);
    if (is_at_border()) {
        find_grid(T_part_tool, load, removal);
        solve_on_grid(T_part_tool, load, options_.gridding, options_.tolerance, removal);
    }
    contact_.is_near_edge = is_near_edge(contact_extent().y(), wheel_);
    return contact_;
}

MatrixXd WheelContactSolver::residual_gap() { return layer_->residual_gap(gap_, contact_.contact, partial_coverage()); }

double WheelContact::area() const
{
    return (contact.pressure.array() > 0).select(coverage, 0).sum() * grid.cell_size.prod();
}

MatrixXd WheelContact::workpiece_pressure() const
{
    return (coverage.array() > 0).select(contact.pressure.cwiseQuotient(coverage), 0);
}

cloud::Cloud to_cloud(const WheelContact& press, const MatrixXd& gap_left, const Eigen::Isometry3d& T_part_tool)
{
    std::vector<Eigen::Vector3d> points;
    std::vector<double> pressure, gap;
    for (Index j = 0; j < press.grid.columns; ++j)
        for (Index i = 0; i < press.grid.rows; ++i) {
            if (std::isnan(press.height(i, j))) continue;
            const Vector2d center = press.grid.cell_center(i, j);
            Eigen::Vector3d p(center.x(), center.y(), press.height(i, j));
            if (const double radius = press.arc_radius; std::isfinite(radius)) {
                const double angle = center.x() / radius, r = radius - p.z();
                p.x() = r * std::sin(angle);
                p.z() = radius - r * std::cos(angle);
            }
            points.push_back(T_part_tool * p);
            pressure.push_back(press.contact.pressure(i, j));
            gap.push_back(gap_left(i, j));
        }
    cloud::Cloud cloud;
    cloud.comment = "frame: part";
    cloud.xyz.resize(3, points.size());
    for (std::size_t i = 0; i < points.size(); ++i) cloud.xyz.col(i) = points[i];
    cloud::set_field(cloud, "pressure", Eigen::VectorXd::Map(pressure.data(), cloud.size()));
    cloud::set_field(cloud, "gap", Eigen::VectorXd::Map(gap.data(), cloud.size()));
    return cloud;
}

} // namespace fettle::belt
