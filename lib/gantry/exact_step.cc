#include "gantry/exact_step.h"

#include <Eigen/Core>

#include <cmath>

namespace fettle::gantry {
namespace {

/// Scaling and squaring: 14 terms of the series leave 2⁻¹⁴ⁿ / 15! < 1e-16 of a matrix below 1/2.
constexpr int kSeriesTerms = 14;
constexpr double kMaxScaledNorm = 0.5;

Eigen::Matrix4d exponential(Eigen::Matrix4d a)
{
    const double norm = a.cwiseAbs().rowwise().sum().maxCoeff();
    const int halvings = norm > kMaxScaledNorm ? static_cast<int>(std::ceil(std::log2(norm / kMaxScaledNorm))) : 0;
    a = a * std::ldexp(1.0, -halvings);
    Eigen::Matrix4d sum = Eigen::Matrix4d::Identity();
    for (int n = kSeriesTerms; n > 0; --n) sum = Eigen::Matrix4d(Eigen::Matrix4d::Identity() + a * sum / n);
    for (int n = 0; n < halvings; ++n) sum = Eigen::Matrix4d(sum * sum);
    return sum;
}

} // namespace

ExactStep::ExactStep(const Oscillator& oscillator, double period)
{
    const double m = oscillator.mass;
    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
    a(0, 1) = 1;
    a(1, 0) = -oscillator.stiffness / m;
    a(1, 1) = -oscillator.damping / m;
    a(1, 2) = 1 / m;
    a(2, 3) = 1;
    const Eigen::Matrix4d e = exponential(a * period);
    Eigen::RowVector4d::Map(p_) = e.row(0);
    Eigen::RowVector4d::Map(v_) = e.row(1);
}

} // namespace fettle::gantry
