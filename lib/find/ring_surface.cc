#include "find/ring_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

/// Places on a surface that was fitted to a ring.
namespace fettle::find {
namespace {

using Eigen::Index;

using Terms = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxTerms + kCreaseTerms, 1>;

/// The functions whose coefficients `fit.mean` holds.
Terms terms_at(const RingFit& fit, double x, double y)
{
    Terms terms(fit.mean.size());
    const double u = (x - fit.centre.x()) / fit.scale, v = (y - fit.centre.y()) / fit.scale;
    monomials(u, v, fit.highest_degree, terms.data());
    if (fit.crease) terms.tail<kCreaseTerms>() = fit.crease->terms(u, v);
    return terms;
}

} // namespace

std::optional<Crease> RingFit::crease_in_place() const
{
    if (!crease) return std::nullopt;
    return Crease{crease->across, scale * crease->offset + crease->across.dot(centre)};
}

RingFit::Value RingFit::at(double x, double y) const
{
    const Terms terms = terms_at(*this, x, y);
    double variance = 0;
    for (Index j = 0; j < terms.size(); ++j) variance += terms[j] * covariance.col(j).dot(terms);
    return {height + mean.dot(terms), std::sqrt(std::max(0.0, variance))};
}

double RingFit::z_at(double x, double y) const { return height + mean.dot(terms_at(*this, x, y)); }

void RingFit::add_row(double y, double factor, std::span<float> row) const
{
    // In x along the row: coefficients of its powers, from those of total degree up to 4.
    std::array<double, kHighestDegree + 1> powers{};
    const double v = (y - centre.y()) / scale;
    Index k = 0;
    for (int total = 0; total <= highest_degree; ++total) {
        double power = 1;
        for (int b = 0; b <= total; ++b, power *= v) powers[std::size_t(total - b)] += power * mean[k++];
    }
    powers[0] += height;
    for (std::size_t x = 0; x < row.size(); ++x) {
        const double u = (double(x) - centre.x()) / scale;
        double z = powers[kHighestDegree];
        for (std::size_t i = kHighestDegree; i-- > 0;) z = z * u + powers[i];
        if (crease) z += mean.tail<kCreaseTerms>().dot(crease->terms(u, v));
        row[x] = float(row[x] + factor * z);
    }
}

} // namespace fettle::find
