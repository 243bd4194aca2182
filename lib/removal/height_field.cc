#include "removal/height_field.h"

#include "core/error.h"
#include "core/text.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <vector>

namespace fettle {
namespace {

/// Lengths that are a whole number of cells but for rounding count as whole; far above the rounding of coordinates
/// (1e-12 of a cell), far below what a cell can resolve.
constexpr double kWholeCell = 1e-6;
/// 1.6 GB of heights, of which grinding keeps two copies.
constexpr double kMostCells = 2e8;

double whole_cells(double length, double cell) { return std::ceil(length / cell - kWholeCell); }

} // namespace

HeightField empty_height_field(const Eigen::Matrix2d& box, const Eigen::Vector2d& margin, double theta, double cell)
{
    if (!(cell > 0)) throw InputError("cell must be positive, not " + to_text(cell));
    const Eigen::Array2d around(whole_cells(margin.x(), cell), whole_cells(margin.y(), cell));
    const Eigen::Vector2d size = box.col(1) - box.col(0);
    const Eigen::Array2d count = Eigen::Array2d(whole_cells(size.x(), cell), whole_cells(size.y(), cell)) + 2 * around;
    if (!(count.prod() <= kMostCells))
        throw InputError("a cell of " + to_text(cell) + " mm makes " + to_text(count.prod()) + " cells; at most " +
                         to_text(kMostCells) + " are possible");

    HeightField field;
    field.theta = theta;
    field.cell = cell;
    field.origin = box.col(0).array() - cell * around;
    field.z = Eigen::ArrayXXd::Constant(static_cast<Eigen::Index>(count.x()), static_cast<Eigen::Index>(count.y()),
                                        std::numeric_limits<double>::quiet_NaN());
    return field;
}

double height_under_ball(const HeightField& stock, const Eigen::Vector2d& xy, double radius)
{
    const Eigen::Array2d at = (xy - stock.origin).array() / stock.cell - 0.5; // in cells, from the first centre
    const Eigen::Array2d count(static_cast<double>(stock.columns()), static_cast<double>(stock.rows()));
    double height = std::numeric_limits<double>::quiet_NaN();
    if (!((at > -1).all() && (at < count).all())) return height;
    const Eigen::Array2d last = count - 1, low = at.floor().max(0).min((last - 1).max(0));
    if (radius == 0) {
        const Eigen::Array2d s = (at - low).max(0).min(1), least = low, most = (low + 1).min(last);
        const auto z = [&](double i, double j) {
            return stock.z(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        };
        return (1 - s.y()) * ((1 - s.x()) * z(least.x(), least.y()) + s.x() * z(most.x(), least.y())) +
               s.y() * ((1 - s.x()) * z(least.x(), most.y()) + s.x() * z(most.x(), most.y()));
    }
    const double reach = radius / stock.cell;
    const Eigen::Array2<Eigen::Index> first = (at - reach).ceil().max(0).cast<Eigen::Index>(),
                                      end = ((at + reach).floor() + 1).min(count).cast<Eigen::Index>();
    for (Eigen::Index j = first.y(); j < end.y(); ++j)
        for (Eigen::Index i = first.x(); i < end.x(); ++i) {
            const double rise = radius * radius - (stock.centre(i, j) - xy).squaredNorm();
            const double z = stock.z(i, j) - radius + std::sqrt(std::max(rise, 0.0));
            if (!(height >= z)) height = z; // no material never counts
        }
    return height;
}

double volume_between(const HeightField& before, const HeightField& after)
{
    const Eigen::ArrayXXd depth = before.z - after.z;
    return depth.isNaN().select(0, depth).sum() * before.cell * before.cell;
}

Cloud to_cloud(const HeightField& before, const HeightField& after)
{
    std::vector<Eigen::Index> first = {0}; // point of each row
    for (Eigen::Index j = 0; j < after.rows(); ++j) first.push_back(first.back() + (!after.z.col(j).isNaN()).count());
    const Eigen::Matrix2d R_machine_working = rotation_working_machine(after.theta).transpose();
    Cloud cloud;
    cloud.xyz.resize(3, first.back());
    Eigen::VectorXd removed(first.back());
    tbb::parallel_for(Eigen::Index{0}, after.rows(), [&](Eigen::Index j) {
        Eigen::Index n = first[static_cast<std::size_t>(j)];
        for (Eigen::Index i = 0; i < after.columns(); ++i) {
            if (std::isnan(after.z(i, j))) continue;
            cloud.xyz.col(n) << R_machine_working * after.centre(i, j), after.z(i, j);
            removed[n++] = before.z(i, j) - after.z(i, j);
        }
    });
    set_field(cloud, "removed", removed);
    return cloud;
}

} // namespace fettle
