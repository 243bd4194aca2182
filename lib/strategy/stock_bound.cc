#include "strategy/stock_bound.h"

#include "geometry/bounding_box.h"
#include "job/boundary.h"
#include "job/region.h"

#include <algorithm>
#include <cmath>

namespace fettle::strategy {
namespace {

/// Cells across the wheel's width, by which walls are located to a twenty-fourth of it; and their maximum number over
/// the radius of a thin wheel.
constexpr double kCellsPerWidth = 24, kMaxCellsPerRadius = 100;
/// Distance of two evaluated positions of the wheel in cells.
constexpr double kBoundStepCells = 2;
/// Clearance of travels above the bound, mm, for the rim between two cells and the drives' errors.
constexpr double kClearance = 0.5;

removal::HeightField grid_around(const job::Job& job)
{
    const auto [B, S] = job::working_boundaries(job);
    return removal::empty_height_field(
        geometry::bounding_box(B), {job.wheel.width / 2, job.wheel.radius}, job.theta,
        std::max(job.wheel.width / kCellsPerWidth, job.wheel.radius / kMaxCellsPerRadius));
}

/// Marks the cells in B.
Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> cells_of_B(const removal::HeightField& field, const job::Job& job)
{
    Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> inside =
        Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>::Constant(field.columns(), field.rows(), false);
    const Eigen::Matrix2d R_machine_working = job::rotation_working_machine(job.theta).transpose();
    // Most cells lie around B, where the wheel overhangs: only those in its bounding box are classified.
    const Eigen::AlignedBox2d box = geometry::bounding_box(job::working_boundaries(job).anomaly);
    const Eigen::Array2d count(field.columns(), field.rows());
    const Eigen::Array2d first = ((box.min() - field.origin).array() / field.cell).floor().max(0).min(count),
                         end = ((box.max() - field.origin).array() / field.cell).ceil().max(first).min(count);
    const Eigen::Index left = Eigen::Index(first.x()), columns = Eigen::Index(end.x()) - left;
    for (Eigen::Index j = Eigen::Index(first.y()); j < Eigen::Index(end.y()); ++j) {
        Eigen::Matrix3Xd row = Eigen::Matrix3Xd::Zero(3, columns);
        for (Eigen::Index i = 0; i < columns; ++i) row.col(i).head<2>() = R_machine_working * field.centre(left + i, j);
        const std::vector<job::Region> regions = job::classify_regions(job, row);
        for (Eigen::Index i = 0; i < columns; ++i) inside(left + i, j) = regions[i] == job::Region::inside;
    }
    return inside;
}

removal::HeightField unknown_stock(removal::HeightField field,
                                   const Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>& inside, double safe_height,
                                   double sound_height)
{
    for (Eigen::Index n = 0; n < field.z.size(); ++n) field.z(n) = inside(n) ? safe_height : sound_height;
    return field;
}

} // namespace

StockBound::StockBound(const job::Job& job, double sound_height)
    : bound_(grid_around(job)), inside_(cells_of_B(bound_, job)),
      wheel_(bound_ = unknown_stock(bound_, inside_, job.safe_height, sound_height), job.wheel.width),
      spring_{job.force.preload, job.force.stiffness}, R_working_machine_(job::rotation_working_machine(job.theta)),
      width_(job.wheel.width), removal_(job.removal_coefficient), safe_height_(job.safe_height)
{
}

/// Visits the evaluated positions of a wheel along a line, without the first.
template <class Visit>
void StockBound::visit_positions(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Visit& visit) const
{
    const int steps = std::max(1, int(std::ceil((to - from).norm() / (kBoundStepCells * bound_.cell))));
    for (int n = 1; n <= steps; ++n) visit(Eigen::Vector3d(from + (to - from) * (double(n) / steps)));
}

void StockBound::lower(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius)
{
    visit_positions(from, to, [&](const Eigen::Vector3d& at) {
        wheel_.place(R_working_machine_ * at.head<2>(), radius, at.z());
        wheel_.cut(at.z());
    });
}

double StockBound::max_force(const std::vector<Eigen::Vector3d>& path, double radius, double feed,
                             double hardness) const
{
    removal::HeightField stock = cut_out(path, radius);
    removal::WheelInStock wheel(stock, width_);
    double max_force = 0, tip = path.front().z();
    for (std::size_t i = 1; i < path.size(); ++i) {
        Eigen::Vector3d last = path[i - 1];
        visit_positions(path[i - 1], path[i], [&](const Eigen::Vector3d& at) {
            wheel.place(R_working_machine_ * at.head<2>(), radius, at.z());
            const removal::Balance balance =
                removal::press(wheel, spring_, at.z(), removal_ / hardness * (at - last).norm() / feed, tip);
            if (balance.volume > 0) wheel.cut(balance.z_tip);
            max_force = std::max(max_force, balance.force);
            tip = balance.z_tip;
            last = at;
        });
    }
    return max_force;
}

double StockBound::free_length(const std::vector<Eigen::Vector3d>& path, double radius, double allowance) const
{
    double length = 0;
    bool is_free = true;
    for (std::size_t i = 1; i < path.size() && is_free; ++i) {
        Eigen::Vector3d last = path[i - 1];
        visit_positions(path[i - 1], path[i], [&](const Eigen::Vector3d& at) {
            if (!is_free) return;
            wheel_.place(R_working_machine_ * at.head<2>(), radius, at.z());
            is_free = wheel_.touch() <= at.z() + allowance;
            if (is_free) length += (at - last).norm();
            last = at;
        });
    }
    return length;
}

double StockBound::free_height(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius) const
{
    double height = std::min(from.z(), to.z()) - safe_height_;
    const Eigen::Vector3d a(from.x(), from.y(), height), b(to.x(), to.y(), height);
    const auto touch = [&](const Eigen::Vector3d& at) {
        wheel_.place(R_working_machine_ * at.head<2>(), radius, at.z());
        height = std::max(height, is_outside_anomaly(at.head<2>()) ? safe_height_ : wheel_.touch());
    };
    touch(a);
    if (a != b) visit_positions(a, b, touch);
    return std::min(height + kClearance, safe_height_);
}

/// Whether a place is outside B by more than a cell.
bool StockBound::is_outside_anomaly(const Eigen::Vector2d& xy) const
{
    const Eigen::Array2d count(bound_.columns(), bound_.rows());
    const Eigen::Array2d cell = ((R_working_machine_ * xy - bound_.origin).array() / bound_.cell).floor();
    const Eigen::Array2d low = (cell - 1).max(0).min(count), end = (cell + 2).max(low).min(count);
    return !inside_
                .block(Eigen::Index(low.x()), Eigen::Index(low.y()), Eigen::Index(end.x() - low.x()),
                       Eigen::Index(end.y() - low.y()))
                .any();
}

/// The part of the bound within reach of a wheel along a path.
removal::HeightField StockBound::cut_out(const std::vector<Eigen::Vector3d>& path, double radius) const
{
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector3d& at : path) box.extend(Eigen::Vector2d(R_working_machine_ * at.head<2>()));
    const Eigen::Array2d reach(width_ / 2 + bound_.cell, radius + bound_.cell), count(bound_.columns(), bound_.rows());
    const Eigen::Array2d low = ((box.min() - bound_.origin).array() - reach) / bound_.cell,
                         high = ((box.max() - bound_.origin).array() + reach) / bound_.cell;
    const Eigen::Array2d first = low.floor().max(0).min(count), end = high.ceil().min(count).max(first);
    removal::HeightField part;
    part.theta = bound_.theta;
    part.cell = bound_.cell;
    part.origin = bound_.origin.array() + first * bound_.cell;
    part.z = bound_.z.block(Eigen::Index(first.x()), Eigen::Index(first.y()), Eigen::Index(end.x() - first.x()),
                            Eigen::Index(end.y() - first.y()));
    return part;
}

} // namespace fettle::strategy
