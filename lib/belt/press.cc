#include "belt/press.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;

constexpr Index kCoarse = 24;  // cells to find the contact's extent
constexpr double kMost = 0.99; // of the radius: the wheel's profile is steep there

/// As long as the wheel dips into a plane by a tenth of its layer, and as wide as it is.
Vector2d first_half(const ContactWheel& wheel)
{
    return {std::min(std::sqrt(2 * wheel.radius * wheel.layer.thickness / 10), kMost * wheel.radius), wheel.width / 2};
}

ContactCells cells_of(const Vector2d& half, Index count)
{
    return {2 * half / static_cast<double>(count), count, count};
}

/// Places in the tool frame: along the wheel's arc, along its axis, and how far within the arc.
void lay_along_arc(double radius, Eigen::Matrix3Xd& places)
{
    for (auto place : places.colwise()) {
        const double below = radius - place.z(), across = place.x();
        place.x() = radius * std::atan2(across, below);
        place.z() = radius - std::hypot(across, below);
    }
}

} // namespace

WheelPress::WheelPress(const Surfels& surfels, const ContactWheel& wheel, const PressOptions& options)
    : surfels_(surfels), wheel_(wheel), options_(options), index_(surfels, first_half(wheel).minCoeff() / 4),
      farthest_(surfels.displacement.array().isNaN().select(0, surfels.displacement.array().abs()).maxCoeff())
{
}

void WheelPress::set_grid(const ContactCells& cells, LayerSolver solver)
{
    press_.cells = cells;
    if (solver == LayerSolver::fem) {
        press_.arc_radius = wheel_.radius;
        layer_.emplace(mesh_of(wheel_.layer, wheel_.radius, wheel_.width, cells.cell, cells.columns, options_.elements),
                       cells.rows);
    } else {
        press_.arc_radius = std::numeric_limits<double>::infinity();
        layer_.emplace(wheel_.layer, cells.cell, cells.rows, cells.columns);
    }
    lift();
}

void WheelPress::lift()
{
    press_.contact.pressure.resize(0, 0);
    last_.resize(0, 0);
}

PressMemory WheelPress::memory() const { return {press_.cells, press_.contact.pressure, last_}; }

void WheelPress::remember(const PressMemory& memory)
{
    layer_.reset();
    press_.cells = memory.cells;
    if (memory.cells.rows > 0) set_grid(memory.cells, options_.solver);
    press_.contact.pressure = memory.pressure;
    last_ = memory.last;
}

void WheelPress::press_on(const Eigen::Isometry3d& T_part_tool, const Pressing& pressing, Gridding gridding,
                          double tolerance)
{
    const ContactCells& cells = press_.cells;
    const double deepest = wheel_.layer.thickness;
    Eigen::Vector3d beside;
    beside << kBeside * cells.half(), std::hypot(kBeside * cells.half().norm(), deepest);
    Eigen::Vector3d below(-beside);
    below.z() = -deepest;
    const Eigen::Vector3d stock = Eigen::Vector3d::Constant(farthest_);
    index_.in_box(T_part_tool, {below - stock, beside + stock}, under_);
    places_ = facing(surfels_, under_, T_part_tool, cells, deepest);
    ContactWheel over = wheel_;
    if (std::isfinite(press_.arc_radius)) {
        lay_along_arc(wheel_.radius, places_);
        over.radius = std::numeric_limits<double>::infinity();
    }
    press_.height = heights_on(cells, places_, gridding);
    gap_.resize(cells.rows, cells.columns);
    for (Index j = 0; j < cells.columns; ++j)
        for (Index i = 0; i < cells.rows; ++i) {
            const Vector2d at = cells.middle(i, j);
            const double height = press_.height(i, j);
            gap_(i, j) =
                std::isnan(height) ? std::numeric_limits<double>::infinity() : profile(over, at.x(), at.y()) - height;
        }
    if (!gap_.array().isFinite().any()) throw InputError("there is nothing under the wheel");
    MatrixXd start = press_.contact.pressure;
    if (last_.size() > 0) start = (2 * start - last_).eval();
    last_ = press_.contact.pressure;
    press_.contact = pressing.by_force ? layer_->by_force(gap_, pressing.amount, tolerance, start)
                                       : layer_->by_depth(gap_, pressing.amount, tolerance, start);
    if (!press_.contact.converged) throw InputError("the contact was not found to the tolerance");
}

Vector2d WheelPress::reach() const
{
    Vector2d farthest = Vector2d::Zero();
    for (Index j = 0; j < press_.cells.columns; ++j)
        for (Index i = 0; i < press_.cells.rows; ++i)
            if (press_.contact.pressure(i, j) > 0)
                farthest = farthest.cwiseMax(press_.cells.middle(i, j).cwiseAbs() + press_.cells.cell / 2);
    return farthest;
}

/// Could the contact go on beyond the grid?
bool WheelPress::is_at_border() const
{
    const Eigen::Array2d half = press_.cells.half().array(), farthest = reach().array();
    const Eigen::Array2d most(kMost * wheel_.radius, wheel_.width / 2);
    return (farthest > half - 1.5 * press_.cells.cell.array() && half < 0.999 * most).any();
}

void WheelPress::find_grid(const Eigen::Isometry3d& T_part_tool, const Pressing& pressing)
{
    constexpr double kAround = 1.3;
    constexpr double kRough = 1e-3;
    const Vector2d most(kMost * wheel_.radius, wheel_.width / 2);
    Vector2d half = layer_ ? Vector2d(1.5 * press_.cells.half()) : first_half(wheel_);
    for (;; half *= 2) {
        half = half.cwiseMin(most);
        set_grid(cells_of(half, kCoarse), LayerSolver::layer);
        press_on(T_part_tool, pressing, Gridding::shepard, kRough);
        if (!is_at_border()) break;
    }
    half = (kAround * reach() + press_.cells.cell).cwiseMin(most);
    set_grid(cells_of(half, options_.cells), options_.solver);
}

const Press& WheelPress::at(const Eigen::Isometry3d& T_part_tool, const Pressing& pressing)
{
    if (!layer_) find_grid(T_part_tool, pressing);
    press_on(T_part_tool, pressing, options_.gridding, options_.tolerance);
    if (is_at_border()) {
        find_grid(T_part_tool, pressing);
        press_on(T_part_tool, pressing, options_.gridding, options_.tolerance);
    }
    // Thicknesses: there rubber of ν = 0.49 is pressed in 0.5 % farther than without an edge, 5 % at a sixth of it.
    constexpr double kEdge = 1.5;
    press_.is_near_edge = reach().y() > wheel_.width / 2 - kEdge * wheel_.layer.thickness;
    return press_;
}

MatrixXd WheelPress::gap_left() { return layer_->gap_left(gap_, press_.contact); }

double Press::area() const { return static_cast<double>((contact.pressure.array() > 0).count()) * cells.cell.prod(); }

Cloud to_cloud(const Press& press, const MatrixXd& gap_left, const Eigen::Isometry3d& T_part_tool)
{
    std::vector<Eigen::Vector3d> points;
    std::vector<double> pressure, gap;
    for (Index j = 0; j < press.cells.columns; ++j)
        for (Index i = 0; i < press.cells.rows; ++i) {
            if (std::isnan(press.height(i, j))) continue;
            const Vector2d at = press.cells.middle(i, j);
            Eigen::Vector3d place(at.x(), at.y(), press.height(i, j));
            if (const double radius = press.arc_radius; std::isfinite(radius)) {
                const double angle = at.x() / radius, r = radius - place.z();
                place.x() = r * std::sin(angle);
                place.z() = radius - r * std::cos(angle);
            }
            points.push_back(T_part_tool * place);
            pressure.push_back(press.contact.pressure(i, j));
            gap.push_back(gap_left(i, j));
        }
    Cloud cloud;
    cloud.comment = "frame: part";
    cloud.xyz.resize(3, static_cast<Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) cloud.xyz.col(static_cast<Index>(i)) = points[i];
    const auto values = [](const std::vector<double>& all) {
        return Eigen::VectorXd(Eigen::VectorXd::Map(all.data(), static_cast<Index>(all.size())));
    };
    set_field(cloud, "pressure", values(pressure));
    set_field(cloud, "gap", values(gap));
    return cloud;
}

} // namespace fettle
