#include "removal/height_field.h"

#include "core/error.h"
#include "core/text.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <vector>

namespace fettle::removal {
namespace {

/// A length that exceeds a whole number of cells by less counts as whole: far above the rounding of coordinates (1e-12
/// of a cell), far below what a cell can resolve.
constexpr double kCellCountTolerance = 1e-6; // cells
/// That many heights take 1.6 GB, and grinding keeps two copies.
constexpr double kMaxCells = 2e8;

double cell_count(double length, double cell) { return std::ceil(length / cell - kCellCountTolerance); }

} // namespace

HeightField empty_height_field(const Eigen::AlignedBox2d& box, const Eigen::Vector2d& margin, double theta, double cell)
{
    if (!(cell > 0)) throw core::InputError("cell must be positive, not " + core::to_text(cell));
    const Eigen::Array2d around(cell_count(margin.x(), cell), cell_count(margin.y(), cell));
    const Eigen::Vector2d size = box.sizes();
    const Eigen::Array2d count = Eigen::Array2d(cell_count(size.x(), cell), cell_count(size.y(), cell)) + 2 * around;
    if (!(count.prod() <= kMaxCells))
        throw core::InputError("a cell of " + core::to_text(cell) + " mm makes " + core::to_text(count.prod()) +
                               " cells; at most " + core::to_text(kMaxCells) + " are possible");

    HeightField field;
    field.theta = theta;
    field.cell = cell;
    field.origin = box.min().array() - cell * around;
    field.z = Eigen::ArrayXXd::Constant(Eigen::Index(count.x()), Eigen::Index(count.y()),
                                        std::numeric_limits<double>::quiet_NaN());
    return field;
}

double height_under_ball(const HeightField& stock, const Eigen::Vector2d& xy, double radius)
{
    const Eigen::Array2d at = (xy - stock.origin).array() / stock.cell - 0.5; // in cells, from the first centre
    const Eigen::Array2d count(stock.columns(), stock.rows());
    double height = std::numeric_limits<double>::quiet_NaN();
    if (!((at > -1).all() && (at < count).all())) return height;
    const Eigen::Array2d last = count - 1, low = at.floor().max(0).min((last - 1).max(0));
    if (radius == 0) {
        const Eigen::Array2d s = (at - low).max(0).min(1), high = (low + 1).min(last);
        const auto z = [&](double i, double j) { return stock.z(Eigen::Index(i), Eigen::Index(j)); };
        return (1 - s.y()) * ((1 - s.x()) * z(low.x(), low.y()) + s.x() * z(high.x(), low.y())) +
               s.y() * ((1 - s.x()) * z(low.x(), high.y()) + s.x() * z(high.x(), high.y()));
    }
    const double reach = radius / stock.cell;
    const Eigen::Array2<Eigen::Index> first = (at - reach).ceil().max(0).cast<Eigen::Index>(),
                                      end = ((at + reach).floor() + 1).min(count).cast<Eigen::Index>();
    for (Eigen::Index j = first.y(); j < end.y(); ++j)
        for (Eigen::Index i = first.x(); i < end.x(); ++i) {
            const double rise = radius * radius - (stock.centre(i, j) - xy).squaredNorm();
            const double z = stock.z(i, j) - radius + std::sqrt(std::max(rise, 0.0));
            if (!(height >= z)) height = z; // NaN, no material, never counts
        }
    return height;
}

double volume_between(const HeightField& before, const HeightField& after)
{
    const Eigen::ArrayXXd depth = before.z - after.z;
    return depth.isNaN().select(0, depth).sum() * before.cell * before.cell;
}

cloud::Cloud to_cloud(const HeightField& before, const HeightField& after)
{
    std::vector<Eigen::Index> first = {0}; // index of each row's first point
    for (Eigen::Index j = 0; j < after.rows(); ++j) first.push_back(first.back() + (!after.z.col(j).isNaN()).count());
    const Eigen::Matrix2d R_machine_working = job::rotation_working_machine(after.theta).transpose();
    cloud::Cloud cloud;
    cloud.xyz.resize(3, first.back());
    Eigen::VectorXd removed(first.back());
    tbb::parallel_for(Eigen::Index{0}, after.rows(), [&](Eigen::Index j) {
        Eigen::Index n = first[j];
        for (Eigen::Index i = 0; i < after.columns(); ++i) {
            if (std::isnan(after.z(i, j))) continue;
            cloud.xyz.col(n) << R_machine_working * after.centre(i, j), after.z(i, j);
            removed[n++] = before.z(i, j) - after.z(i, j);
        }
    });
    cloud::set_field(cloud, "removed", removed);
    return cloud;
}

} // namespace fettle::removal
