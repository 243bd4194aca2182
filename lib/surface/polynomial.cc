#include "surface/shapes.h"

#include <cmath>

namespace fettle::surface {

namespace {

/// Calls visit(k, i, j) for the k-th monomial u^i v^j: by total degree, then by decreasing powers of u.
template <typename Visit>
void for_each_monomial(int degree, Visit&& visit)
{
    Eigen::Index k = 0;
    for (int total = 0; total <= degree; ++total)
        for (int j = 0; j <= total; ++j) visit(k++, total - j, j);
}

Eigen::Vector2d scaled(const Polynomial& polynomial, const Eigen::Vector2d& xy)
{
    return (xy - polynomial.origin) / polynomial.scale;
}

} // namespace

Eigen::Index monomial_count(int degree) { return static_cast<Eigen::Index>(degree + 1) * (degree + 2) / 2; }

int degree(const Polynomial& polynomial)
{
    int d = 0;
    while (monomial_count(d) < polynomial.coefficients.size()) ++d;
    return d;
}

double height(const Polynomial& polynomial, const Eigen::Vector2d& xy)
{
    return polynomial.coefficients.dot(height_gradient(polynomial, xy));
}

Eigen::Vector2d slope(const Polynomial& polynomial, const Eigen::Vector2d& xy)
{
    const Eigen::Vector2d p = scaled(polynomial, xy);
    Eigen::Vector2d result = Eigen::Vector2d::Zero();
    for_each_monomial(degree(polynomial), [&](Eigen::Index k, int i, int j) {
        const double c = polynomial.coefficients[k];
        if (i > 0) result[0] += c * i * std::pow(p[0], i - 1) * std::pow(p[1], j);
        if (j > 0) result[1] += c * j * std::pow(p[0], i) * std::pow(p[1], j - 1);
    });
    return result / polynomial.scale;
}

Eigen::VectorXd height_gradient(const Polynomial& polynomial, const Eigen::Vector2d& xy)
{
    const Eigen::Vector2d p = scaled(polynomial, xy);
    Eigen::VectorXd gradient(polynomial.coefficients.size());
    gradient[0] = 1;
    const int highest = degree(polynomial);
    for (int total = 1, k = 1; total <= highest; ++total) { // the monomials of a degree from those of the one below it
        const int above = k - total;
        for (int j = 0; j < total; ++j) gradient[k++] = gradient[above + j] * p[0];
        gradient[k++] = gradient[above + total - 1] * p[1];
    }
    return gradient;
}

} // namespace fettle::surface
