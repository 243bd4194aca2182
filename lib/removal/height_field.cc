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
