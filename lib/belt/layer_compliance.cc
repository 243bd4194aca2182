#include "belt/layer_compliance.h"

#include "core/error.h"

#include <boost/math/interpolators/cardinal_cubic_b_spline.hpp>
#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace fettle {

namespace {

using Eigen::Index;

// Farther than this many thicknesses a pressure is not felt: the kernel falls by more than exp(-ρ).
constexpr double kFelt = 30;

/// The layer's compliance over the half-space's, less one, at s = qh; written without growing exponentials.
double held_back(double s, double nu)
{
    const double a = 3 - 4 * nu, e2 = std::exp(-2 * s), e4 = e2 * e2;
    const double denominator = a * (1 + e4) + (4 * s * s + 10 - 24 * nu + 16 * nu * nu) * e2;
    return -(2 * a * e4 + (4 * s + 4 * s * s + 10 - 24 * nu + 16 * nu * nu) * e2) / denominator;
}

/// ∫ held_back(s) J0(sρ) ds over s from 0, tabled: the layer's kernel is (1-ν²)/(πE) (1/r + H(r/h)/h).
class HankelTable {
  public:
    HankelTable(double nu, double farthest)
    {
        constexpr double kUpTo = 20; // exp(-2s) is below rounding
        constexpr int kPanels = 20;  // of ten nodes each: four for a wave of J0(s kFelt)
        constexpr double kStep = 0.02;
        using Gauss = boost::math::quadrature::gauss<double, 20>;
        std::vector<double> s, weight;
        for (int panel = 0; panel < kPanels; ++panel) {
            const double half = kUpTo / kPanels / 2, middle = (2 * panel + 1) * half;
            for (std::size_t k = 0; k < Gauss::abscissa().size(); ++k)
                for (const double sign : {-1.0, 1.0}) {
                    s.push_back(middle + sign * half * Gauss::abscissa()[k]);
                    weight.push_back(half * Gauss::weights()[k] * held_back(s.back(), nu));
                }
        }
        const auto count = static_cast<std::size_t>(std::ceil(std::min(farthest, kFelt) / kStep)) + 5;
        std::vector<double> table(count);
        for (std::size_t i = 0; i < count; ++i) {
            const double rho = kStep * static_cast<double>(i);
            for (std::size_t k = 0; k < s.size(); ++k) table[i] += weight[k] * ::j0(s[k] * rho);
        }
        constexpr double kLevel = 0; // slope at ρ = 0: even in ρ
        table_ = Table(table.data(), count, 0.0, kStep, kLevel);
    }

    double operator()(double rho) const { return rho < kFelt ? table_(rho) : -1 / rho; }

  private:
    using Table = boost::math::interpolators::cardinal_cubic_b_spline<double>;
    Table table_;
};

/// ∫∫ 1/r over a rectangle with one corner at the origin and the other at (x, y); odd in both.
double corner(double x, double y)
{
    const double along = x == 0 ? 0 : x * std::asinh(y / std::abs(x));
    return along + (y == 0 ? 0 : y * std::asinh(x / std::abs(y)));
}

/// ∫∫ 1/r over a cell about (x, y).
double inverse_distance(double x, double y, const Eigen::Vector2d& half)
{
    return corner(x + half.x(), y + half.y()) - corner(x - half.x(), y + half.y()) -
           corner(x + half.x(), y - half.y()) + corner(x - half.x(), y - half.y());
}

/// ∫∫ H(r/h)/h over a cell about (x, y): Gauss in pieces no longer than h.
double held_back_over(const HankelTable& table, double h, double x, double y, const Eigen::Vector2d& half)
{
    using Gauss = boost::math::quadrature::gauss<double, 7>;
    const auto pieces = [&](double side) { return std::max(1, static_cast<int>(std::ceil(2 * side / h))); };
    const auto over = [](double middle, double side, int count, const auto& f) {
        double sum = 0;
        const double part = side / count;
        for (int i = 0; i < count; ++i) {
            const double at = middle - side + (2 * i + 1) * part;
            sum += Gauss::integrate(f, at - part, at + part);
        }
        return sum;
    };
    return over(x, half.x(), pieces(half.x()), [&](double u) {
        return over(y, half.y(), pieces(half.y()), [&](double v) { return table(std::hypot(u, v) / h) / h; });
    });
}

} // namespace

double even_compliance(const ElasticLayer& layer)
{
    const double nu = layer.poisson;
    return layer.thickness * (1 + nu) * (1 - 2 * nu) / (layer.young * (1 - nu));
}

Eigen::MatrixXd influence(const ElasticLayer& layer, const Eigen::Vector2d& cell, Index rows, Index columns)
{
    if (!(layer.thickness > 0) || !(layer.young > 0) || !(layer.poisson >= 0 && layer.poisson <= 0.5))
        throw InputError("elastic layer", "thickness and Young's modulus must be positive, Poisson's ratio 0 to 0.5");
    const double scale = (1 - layer.poisson * layer.poisson) / (std::numbers::pi * layer.young), h = layer.thickness;
    const Eigen::Vector2d half = cell / 2;
    const double farthest = std::hypot(static_cast<double>(rows) * cell.x(), static_cast<double>(columns) * cell.y());
    const HankelTable table(layer.poisson, farthest / h);
    Eigen::MatrixXd result(rows, columns);
    for (Index j = 0; j < columns; ++j)
        for (Index i = 0; i < rows; ++i) {
            const double x = static_cast<double>(i) * cell.x(), y = static_cast<double>(j) * cell.y();
            const Eigen::Vector2d nearest = (Eigen::Vector2d(x, y) - half).cwiseMax(0);
            result(i, j) = nearest.norm() > kFelt * h ? 0 : inverse_distance(x, y, half);
            if (result(i, j) != 0 && std::isfinite(h)) result(i, j) += held_back_over(table, h, x, y, half);
        }
    return scale * result;
}

} // namespace fettle
