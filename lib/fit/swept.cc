#include "fit/swept.h"

#include "core/error.h"
#include "surface/shapes.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include <cmath>

namespace fettle {

namespace {

constexpr int kMostIterations = 100;
constexpr double kSettled = 1e-9; // mm, change of a section coefficient: far below any probe
// Of the pivots of the design with columns of unit length; touches in F4 are rounded by 6e-8 of their size.
constexpr double kRankThreshold = 1e-5;

Swept frame_of(const FitInput& input, const Surface& surface)
{
    Swept swept;
    const double angle = input.job.theta + input.job.direction;
    swept.ruling = {std::cos(angle), std::sin(angle)};
    const Eigen::Vector2d across(-swept.ruling.y(), swept.ruling.x());
    const Eigen::Matrix2Xd xy = surface.touches.topRows(2);
    const Eigen::VectorXd s = xy.transpose() * across;
    const Eigen::VectorXd t = xy.transpose() * swept.ruling;
    swept.origin = (s.maxCoeff() + s.minCoeff()) / 2 * across + t.mean() * swept.ruling;
    swept.section_most = (s.maxCoeff() - s.minCoeff()) / 2;
    swept.section_least = -swept.section_most;
    if (swept.section_most > 0) swept.scale = swept.section_most;
    return swept;
}

} // namespace

Fit fit_swept(const FitInput& input)
{
    Surface surface = begin_surface(input, "swept", kSampleRoles, 5);
    Swept swept = frame_of(input, surface);
    const Eigen::MatrixXd A = height_gradients(swept, surface.touches.topRows(2)).transpose(); // z = A θ
    const Eigen::VectorXd z = surface.touches.row(2).transpose();
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> rank(A.colwise().normalized());
    rank.setThreshold(kRankThreshold);
    if (!A.allFinite() || rank.rank() < A.cols())
        throw InputError(input.source, "touches do not determine a swept surface: it needs four places across the "
                                       "rulings and two along them");
    Eigen::VectorXd weight = Eigen::VectorXd::Ones(z.size());
    Eigen::VectorXd theta = Eigen::VectorXd::Zero(A.cols());
    bool settled = false;
    int iterations = 0;
    for (; iterations < kMostIterations && !settled; ++iterations) {
        const Eigen::VectorXd root = weight.cwiseSqrt();
        const Eigen::VectorXd next = (root.asDiagonal() * A).colPivHouseholderQr().solve(root.cwiseProduct(z));
        settled = (next - theta).cwiseAbs().maxCoeff() < kSettled;
        theta = next;
        weight = (z - A * theta).unaryExpr([&](double r) { return huber_weight(r, input.job.probe.accuracy); });
    }
    swept.section = theta.head<4>();
    swept.slope = theta[4];
    surface.shape = swept;
    const Eigen::MatrixXd normal_matrix = A.transpose() * weight.asDiagonal() * A;
    surface.covariance = surface.touch_sigma * surface.touch_sigma *
                         normal_matrix.ldlt().solve(Eigen::MatrixXd::Identity(A.cols(), A.cols()));
    return finish_fit(std::move(surface), static_cast<double>(A.rows() - A.cols()), settled, iterations);
}

} // namespace fettle
