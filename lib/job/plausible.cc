#include "job/plausible.h"

#include "core/text.h"

#include <algorithm>

namespace fettle {

namespace {
// A part is rarely a hundred times as long as the boundary of one anomaly on it; metres taken for mm make it a
// thousandth, mm taken for metres a thousand times as long.
constexpr double kLongestPart = 100;

// Boundary points are touched at the very edge of a part, and the file's numbers are floats.
constexpr double kOverEdge = 0.01;

/// The least and the greatest number that is none; NaN if there is none.
Eigen::Vector2d range(const Eigen::RowVectorXd& z)
{
    return {z.minCoeff<Eigen::PropagateNumbers>(), z.maxCoeff<Eigen::PropagateNumbers>()};
}
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

std::string implausible_height(const Eigen::Matrix3Xd& touches, const Job& job)
{
    Eigen::Matrix3Xd boundary(3, job.anomaly.cols() + job.sampling.cols());
    boundary << job.anomaly, job.sampling;
    const Eigen::Vector2d taught = range(boundary.row(2)), touched = range(touches.row(2));
    const double length = (boundary.rowwise().maxCoeff() - boundary.rowwise().minCoeff()).head<2>().norm();
    const double above = touched[0] - taught[1], below = taught[0] - touched[1];
    if (!(std::max(above, below) > length)) return {}; // nor if there are none
    return "the touches lie " + to_short_text(std::max(above, below) / job.units.mm()) + " " +
           to_string(job.units.length) + (above > 0 ? " above" : " below") +
           " the job's boundary points: is the part's unit right, does it lie where the job was taught?";
}

} // namespace fettle
