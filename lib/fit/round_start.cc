#include "fit/round_start.h"

#include "core/error.h"
#include "core/text.h"
#include "fit/fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {

// Of a design with columns of unit length; touches in F4 are rounded by 6e-8 of their size.
constexpr double kRankThreshold = 1e-5;

Eigen::VectorXd upward(const Surface& surface)
{
    Eigen::VectorXd n_z(surface.touches.cols());
    for (Eigen::Index i = 0; i < n_z.size(); ++i) n_z[i] = normal(surface, surface.touches.col(i).head<2>()).z();
    return n_z;
}

} // namespace

RoundFrame start_frame(const Eigen::Matrix3Xd& touches, double angle, const std::string& source)
{
    const Eigen::Vector3d centroid = touches.rowwise().mean();
    const Eigen::Matrix3Xd d = touches.colwise() - centroid;
    Eigen::ColPivHouseholderQR<Eigen::MatrixX2d> plane(d.topRows(2).transpose());
    plane.setThreshold(kRankThreshold);
    if (plane.rank() < 2) throw InputError(source, "touches lie on one line in x and y");
    const Eigen::Vector2d slope = plane.solve(d.row(2).transpose());
    RoundFrame frame;
    frame.point = centroid;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    frame.axes.col(2) = Eigen::Vector3d(-slope.x(), -slope.y(), 1).normalized();
    frame.axes.col(0) = Eigen::Vector3d(along.x(), along.y(), slope.dot(along)).normalized();
    frame.axes.col(1) = frame.axes.col(2).cross(frame.axes.col(0));
    return frame;
}

double start_curvature(const RoundFrame& frame, const Eigen::Matrix3Xd& touches, bool round)
{
    const Eigen::Matrix3Xd local = frame.axes.transpose() * (touches.colwise() - frame.point);
    Eigen::MatrixXd A(local.cols(), 4);
    const Eigen::VectorXd u2 = local.row(0).cwiseAbs2();
    const Eigen::VectorXd v2 = local.row(1).cwiseAbs2();
    A << Eigen::VectorXd::Ones(local.cols()), local.topRows(2).transpose(), round ? Eigen::VectorXd(u2 + v2) : v2;
    const Eigen::VectorXd c = A.completeOrthogonalDecomposition().solve(local.row(2).transpose());
    return -2 * c[3];
}

Eigen::MatrixXd round_covariance(const Surface& surface, const Eigen::VectorXd& weight,
                                 const std::vector<Eigen::Index>& may_be_given, const std::string& source)
{
    const Eigen::VectorXd n_z2 = upward(surface).cwiseAbs2();
    const Eigen::MatrixXd G = height_gradients(surface.shape, surface.touches.topRows(2)); // columns: touches
    const Eigen::VectorXd w = weight.cwiseProduct(n_z2);
    std::vector<Eigen::Index> free;
    for (Eigen::Index j = 0; j < G.rows(); ++j) {
        const bool given = G.row(j).cwiseAbs().maxCoeff() < surface.touch_sigma &&
                           std::find(may_be_given.begin(), may_be_given.end(), j) != may_be_given.end();
        if (!given) free.push_back(j);
    }
    const Eigen::MatrixXd J = w.cwiseSqrt().asDiagonal() * G(free, Eigen::all).transpose();
    const Eigen::VectorXd size = J.colwise().norm();
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(J * size.cwiseInverse().asDiagonal());
    qr.setThreshold(kRankThreshold);
    if (!J.allFinite() || qr.rank() < J.cols())
        throw InputError(source,
                         "touches do not determine a " + surface.method + ": another one goes through them as well");
    // J = Q R: H⁻¹ Σ… H⁻¹ = J⁺ diag(w) J⁺ᵀ with J⁺ the pseudo-inverse.
    const Eigen::MatrixXd inverse =
        size.cwiseInverse().asDiagonal() * qr.solve(Eigen::MatrixXd::Identity(J.rows(), J.rows()));
    const double variance = surface.touch_sigma * surface.touch_sigma;
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(G.rows(), G.rows());
    covariance(free, free) = variance * inverse * w.asDiagonal() * inverse.transpose();
    return covariance;
}

Eigen::VectorXd round_weights(const Surface& surface, double width, const std::string& source)
{
    const Eigen::VectorXd vertical = surface.touches.row(2).transpose() - heights(surface, surface.touches.topRows(2));
    Eigen::Index place = 0;
    if (vertical.hasNaN()) {
        while (!std::isnan(vertical[place])) ++place;
        const Eigen::Vector3d p = surface.touches.col(place) / surface.units.mm();
        throw InputError(source, "the " + surface.method + " has no height over the touch at " + to_text(p.x()) + ", " +
                                     to_text(p.y()));
    }
    return vertical.cwiseProduct(upward(surface)).unaryExpr([width](double d) { return huber_weight(d, width); });
}

} // namespace fettle
