#include "belt/layer_compliance.h"

#include "core/error.h"

#include <boost/math/interpolators/cardinal_cubic_b_spline.hpp>
#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace fettle::belt {

namespace {

using Eigen::Index;

// Distance in thicknesses beyond which the influence is 0: the kernel falls by more than exp(-ρ).
constexpr double kMaxDistanceThicknesses = 30;

/// Compliance of the layer divided by that of the half-space, minus one, at s = qh; without growing exponentials.
double hub_effect(double s, double nu)
{
    const double a = 3 - 4 * nu, e2 = std::exp(-2 * s), e4 = e2 * e2;
    const double denominator = a * (1 + e4) + (4 * s * s + 10 - 24 * nu + 16 * nu * nu) * e2;
    return -(2 * a * e4 + (4 * s + 4 * s * s + 10 - 24 * nu + 16 * nu * nu) * e2) / denominator;
}

/// Table of H(ρ) = ∫ hub_effect(s) J0(sρ) ds over s from 0. The layer's kernel is (1-ν²)/(πE) (1/r + H(r/h)/h).
class HankelTable {
  public:
    /// @param max_distance  in thicknesses
    HankelTable(double nu, double max_distance)
    {
        constexpr double kMaxS = 20; // exp(-2s) is below rounding
        constexpr int kPanels = 20;  // of 20 nodes each: four per wave of J0(s kMaxDistanceThicknesses)
        constexpr double kStepThicknesses = 0.02;
        using Gauss = boost::math::quadrature::gauss<double, 20>;
        std::vector<double> s, weight;
        for (int panel = 0; panel < kPanels; ++panel) {
            const double half = kMaxS / kPanels / 2, middle = (2 * panel + 1) * half;
            for (std::size_t k = 0; k < Gauss::abscissa().size(); ++k)
                for (const double sign : {-1.0, 1.0}) {
                    s.push_back(middle + sign * half * Gauss::abscissa()[k]);
                    weight.push_back(half * Gauss::weights()[k] * hub_effect(s.back(), nu));
                }
        }
        const auto count =
            static_cast<std::size_t>(std::ceil(std::min(max_distance, kMaxDistanceThicknesses) / kStepThicknesses)) + 5;
        std::vector<double> table(count);
        for (std::size_t i = 0; i < count; ++i) {
            const double rho = kStepThicknesses * i;
            for (std::size_t k = 0; k < s.size(); ++k) table[i] += weight[k] * ::j0(s[k] * rho);
        }
        constexpr double kSlopeAtZero = 0; // H is even in ρ
        table_ = Table(table.data(), count, 0.0, kStepThicknesses, kSlopeAtZero);
    }

    double operator()(double rho) const { return rho < kMaxDistanceThicknesses ? table_(rho) : -1 / rho; }

  private:
    using Table = boost::math::interpolators::cardinal_cubic_b_spline<double>;
    Table table_;
};

/// ∫∫ 1/r over a rectangle with opposite corners at the origin and (x, y); odd in both.
double inverse_distance_over_corner(double x, double y)
{
    const double first = x == 0 ? 0 : x * std::asinh(y / std::abs(x));
    return first + (y == 0 ? 0 : y * std::asinh(x / std::abs(y)));
}

/// ∫∫ 1/r over a cell about (x, y).
double inverse_distance_over_cell(double x, double y, const Eigen::Vector2d& half)
{
    return inverse_distance_over_corner(x + half.x(), y + half.y()) -
           inverse_distance_over_corner(x - half.x(), y + half.y()) -
           inverse_distance_over_corner(x + half.x(), y - half.y()) +
           inverse_distance_over_corner(x - half.x(), y - half.y());
}

/// ∫∫ H(r/h)/h over a cell about (x, y): Gauss quadrature over intervals of at most h.
double hub_effect_over_cell(const HankelTable& table, double h, double x, double y, const Eigen::Vector2d& half)
{
    using Gauss = boost::math::quadrature::gauss<double, 7>;
    const auto integrate = [h](double middle, double half_side, const auto& f) {
        double sum = 0;
        const int intervals = std::max(1, static_cast<int>(std::ceil(2 * half_side / h)));
        const double half_interval = half_side / intervals;
        for (int i = 0; i < intervals; ++i) {
            const double center = middle - half_side + (2 * i + 1) * half_interval;
            sum += Gauss::integrate(f, center - half_interval, center + half_interval);
        }
        return sum;
    };
    return integrate(x, half.x(), [&](double u) {
        return integrate(y, half.y(), [&](double v) { return table(std::hypot(u, v) / h) / h; });
    });
}

} // namespace

Eigen::MatrixXd influence_coefficients(const ElasticLayer& layer, const Eigen::Vector2d& cell, Index rows,
                                       Index columns)
{
    if (!(layer.thickness > 0) || !(layer.young > 0) || !(layer.poisson >= 0 && layer.poisson <= 0.5))
        throw core::InputError("elastic layer",
                               "thickness and Young's modulus must be positive, Poisson's ratio 0 to 0.5");
    const double scale = (1 - layer.poisson * layer.poisson) / (std::numbers::pi * layer.young), h = layer.thickness;
    const Eigen::Vector2d half = cell / 2;
    const double max_distance = std::hypot(rows * cell.x(), columns * cell.y());
    const HankelTable table(layer.poisson, max_distance / h);
    Eigen::MatrixXd result(rows, columns);
    for (Index j = 0; j < columns; ++j)
        for (Index i = 0; i < rows; ++i) {
            const double x = i * cell.x(), y = j * cell.y();
            const Eigen::Vector2d nearest = (Eigen::Vector2d(x, y) - half).cwiseMax(0);
            result(i, j) = nearest.norm() > kMaxDistanceThicknesses * h ? 0 : inverse_distance_over_cell(x, y, half);
            if (result(i, j) != 0 && std::isfinite(h)) result(i, j) += hub_effect_over_cell(table, h, x, y, half);
        }
    return scale * result;
}

} // namespace fettle::belt
