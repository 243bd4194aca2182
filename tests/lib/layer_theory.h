#pragma once

#include "belt/layer_compliance.h"

#include <boost/math/quadrature/gauss.hpp>
#include <Eigen/LU>

#include <cmath>
#include <cstddef>
#include <numbers>

namespace fettle {

/// Indentation of a bonded layer under a uniform pressure of 1 MPa on all of it, mm/MPa: h (1+ν)(1-2ν) / (E (1-ν)).
inline double uniform_compliance(const belt::ElasticLayer& layer)
{
    const double nu = layer.poisson;
    return layer.thickness * (1 + nu) * (1 - 2 * nu) / (layer.young * (1 - nu));
}

/// A rigid paraboloid on a bonded layer, contact radius a, by the integral equation for φ with pressure p(r) = -∫ φ'(t)
/// / √(t² - r²) dt over r … a (Sneddon 1966; Dhaliwal 1970):
///     φ(t) - 1/π ∫ φ(s) (N(t+s) + N(t-s)) ds = E*/π (δ - t²/R),   N(x) = ∫ (1 - f(qh)) cos qx dq,   φ(a) = 0.
struct LayerTheory {
    double indentation, force, peak;
};

inline LayerTheory layer_theory(const belt::ElasticLayer& layer, double a, double R)
{
    using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd, std::numbers::pi;
    using Gauss = boost::math::quadrature::gauss<double, 30>;
    const double nu = layer.poisson, modulus = layer.young / (1 - nu * nu), h = layer.thickness;
    const auto compliance = [&](double s) { // over the half-space's
        return ((3 - 4 * nu) * std::sinh(2 * s) - 2 * s) /
               ((3 - 4 * nu) * std::cosh(2 * s) + 2 * s * s + 5 - 12 * nu + 8 * nu * nu);
    };
    const auto N = [&](double x) {
        double sum = 0;
        for (int k = 0; k < 20; ++k)
            sum += Gauss::integrate([&](double s) { return (1 - compliance(s)) * std::cos(s * x / h); }, k, k + 1);
        return sum / h;
    };
    constexpr Index kNodes = 30;
    VectorXd t(kNodes + 1), w(kNodes + 1);
    for (std::size_t k = 0; k < Gauss::abscissa().size(); ++k)
        for (const int sign : {0, 1}) {
            const auto i = static_cast<Index>(2 * k) + sign;
            t[i] = a / 2 * (1 + (sign == 0 ? -1 : 1) * Gauss::abscissa()[k]);
            w[i] = a / 2 * Gauss::weights()[k];
        }
    t[kNodes] = a;
    w[kNodes] = 0;
    MatrixXd A = MatrixXd::Identity(kNodes + 1, kNodes + 1), b(kNodes + 1, 2);
    for (Index i = 0; i <= kNodes; ++i) {
        for (Index j = 0; j <= kNodes; ++j)
            if (w[j] > 0) A(i, j) -= w[j] / pi * (N(t[i] + t[j]) + N(t[i] - t[j]));
        b.row(i) << modulus / pi, -modulus / pi * t[i] * t[i] / R;
    }
    const MatrixXd x = A.partialPivLu().solve(b);
    const double depth = -x(kNodes, 1) / x(kNodes, 0);
    const VectorXd phi = x.col(0) * depth + x.col(1);
    // φ is even: a polynomial in t² through the nodes gives φ'(t)/t.
    constexpr Index kTerms = 8;
    MatrixXd powers(kNodes + 1, kTerms);
    for (Index k = 0; k < kTerms; ++k) powers.col(k) = (t / a).array().pow(2 * static_cast<double>(k));
    const VectorXd c = (powers.transpose() * powers).partialPivLu().solve(powers.transpose() * phi);
    double peak = 0;
    for (Index k = 1; k < kTerms; ++k) // -∫ φ'(t)/t dt
        peak -= c[k] * 2 * static_cast<double>(k) / (2 * static_cast<double>(k) - 1) / a;
    return {depth, 2 * pi * w.dot(phi), peak};
}

} // namespace fettle
