#include "job/plausible.h"

#include "core/text.h"

namespace fettle {

namespace {
// A part is rarely a hundred times as long as the boundary of one anomaly on it; metres taken for mm make it a
// thousandth, mm taken for metres a thousand times as long.
constexpr double kLongestPart = 100;

// Boundary points are touched at the very edge of a part, and the file's numbers are floats.
constexpr double kOverEdge = 0.01;
} // namespace

std::string implausible_box(const Eigen::Matrix<double, 3, 2>& box, const Job& job)
{
    const double mm = job.units.mm();
    const Eigen::Matrix2Xd boundary = job.sampling.cols() > 0 ? job.sampling.topRows<2>() : job.anomaly.topRows<2>();
    const Eigen::Vector2d low = boundary.rowwise().minCoeff(), high = boundary.rowwise().maxCoeff();
    const Eigen::Vector3d extent = box.col(1) - box.col(0);
    const auto size = [&] {
        return "the part, " + to_short_text(extent.x() / mm) + " x " + to_short_text(extent.y() / mm) + " x " +
               to_short_text(extent.z() / mm) + " " + to_string(job.units.length) + ", ";
    };
    if (extent.head<2>().norm() > kLongestPart * (high - low).norm())
        return size() + "is over " + to_short_text(kLongestPart) +
               " times as long as the job's boundary: is its unit right?";
    const bool held =
        (low.array() >= box.col(0).head<2>().array()).all() && (high.array() <= box.col(1).head<2>().array()).all();
    if (!held) return size() + "does not hold the job's boundary: is its unit right?";
    return {};
}

} // namespace fettle
