#include "surface/basis.h"

#include <algorithm>

namespace fettle::surface {

namespace {

Eigen::Index find_span(const Eigen::VectorXd& knots, int degree, double t)
{
    const auto* begin = knots.data() + degree;
    const auto* end = knots.data() + knots.size() - degree - 1; // the domain's end belongs to the last span
    const Eigen::Index last = std::lower_bound(begin, end, *end) - knots.data() - 1;
    return std::min<Eigen::Index>(std::upper_bound(begin, end, t) - knots.data() - 1, last);
}

/// Values of the basis functions that do not vanish on the span [t_s, t_s+1), by the recurrence of Cox and de Boor.
Eigen::VectorXd values(const Eigen::VectorXd& knots, Eigen::Index span, int degree, double t)
{
    Eigen::VectorXd value = Eigen::VectorXd::Zero(degree + 1);
    value[0] = 1;
    for (int d = 1; d <= degree; ++d) {
        double carried = 0;
        for (int r = 0; r < d; ++r) {
            const double right = knots[span + r + 1], left = knots[span + 1 - d + r];
            const double share = value[r] / (right - left);
            value[r] = carried + (right - t) * share;
            carried = (t - left) * share;
        }
        value[d] = carried;
    }
    return value;
}

/// Derivatives of these functions, each a difference of two basis functions of one degree less.
Eigen::VectorXd derivatives(const Eigen::VectorXd& knots, Eigen::Index span, int degree, double t, int order)
{
    if (order == 0) return values(knots, span, degree, t);
    Eigen::VectorXd result = Eigen::VectorXd::Zero(degree + 1);
    if (degree == 0) return result;
    const Eigen::VectorXd lower = derivatives(knots, span, degree - 1, t, order - 1);
    for (int r = 0; r < degree; ++r) {
        const double slope = degree * lower[r] / (knots[span + r + 1] - knots[span + 1 - degree + r]);
        result[r] -= slope;
        result[r + 1] += slope;
    }
    return result;
}

} // namespace

BasisFunctions basis_functions(const Eigen::VectorXd& knots, int degree, double t)
{
    const Eigen::Index span = find_span(knots, degree, t);
    return {span - degree, values(knots, span, degree, t), derivatives(knots, span, degree, t, 1)};
}

Eigen::VectorXd basis_derivative(const Eigen::VectorXd& knots, int degree, double t, int order)
{
    return derivatives(knots, find_span(knots, degree, t), degree, t, order);
}

} // namespace fettle::surface
