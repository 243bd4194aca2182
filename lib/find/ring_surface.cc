#include "find/ring_fit.h"

#include "core/simd.h"

#include <algorithm>
#include <array>
#include <cmath>

/// Evaluation of a surface that was fitted to a ring.
namespace fettle::find {
namespace {

using Eigen::Index;

/// The functions whose coefficients `fit.mean` holds.
RingCoefficients terms_at(const RingFit& fit, double x, double y)
{
    RingCoefficients terms(fit.mean.size());
    const double u = (x - fit.centre.x()) / fit.scale, v = (y - fit.centre.y()) / fit.scale;
    monomials(u, v, fit.highest_degree, terms.data());
    if (fit.crease) terms.tail<kCreaseTerms>() = fit.crease->terms(u, v);
    return terms;
}

using core::Double4;

/// Functions at four places: a value of all four, then of the next function.
FETTLE_INLINE void terms_of_four(const Double4& u, const Double4& v, int degree, const Crease* crease, Double4* terms)
{
    terms[0] = core::broadcast(1);
    Index k = 1;
    for (int total = 1; total <= degree; ++total) { // as monomials()
        const Index above = k - total;
        for (int b = 0; b < total; ++b) terms[k++] = terms[above + b] * u;
        terms[k++] = terms[above + total - 1] * v;
    }
    if (crease == nullptr) return;
    const double ax = crease->across.x(), ay = crease->across.y();
    const Double4 beyond = core::cwise_max(core::broadcast(0), ax * u + ay * v - crease->offset);
    terms[k++] = beyond;
    terms[k++] = beyond * (ax * v - ay * u);
    terms[k++] = beyond * beyond;
}

/// Variances at four places: quadratic forms of the functions there, by the lower half of the covariance.
FETTLE_CLONES void variances_of_four(const double* places, double v, int degree, const Crease* crease,
                                     const double* covariance, Index count, double* variances)
{
    Double4 terms[kMaxRingTerms];
    terms_of_four(*reinterpret_cast<const Double4*>(places), core::broadcast(v), degree, crease, terms);
    Double4 sum{};
    for (Index j = 0; j < count; ++j) {
        Double4 below = covariance[j * count + j] / 2 * terms[j];
        for (Index i = j + 1; i < count; ++i) below += covariance[j * count + i] * terms[i];
        sum += terms[j] * below;
    }
    *reinterpret_cast<Double4*>(variances) = sum + sum;
}

} // namespace

std::optional<Crease> RingFit::crease_in_place() const
{
    if (!crease) return std::nullopt;
    return Crease{crease->across, scale * crease->offset + crease->across.dot(centre)};
}

void RingFit::sd_row(double x, double y, double step, std::span<float> row) const
{
    constexpr std::size_t kLanes = 4;
    std::array<double, kLanes> places{}, variances{};
    for (std::size_t first = 0; first < row.size(); first += kLanes) {
        for (std::size_t k = 0; k < kLanes; ++k) places[k] = (x + step * double(first + k) - centre.x()) / scale;
        variances_of_four(places.data(), (y - centre.y()) / scale, highest_degree, crease ? &*crease : nullptr,
                          covariance.data(), mean.size(), variances.data());
        for (std::size_t k = 0; k < std::min(kLanes, row.size() - first); ++k)
            row[first + k] = float(std::sqrt(std::max(0.0, variances[k])));
    }
}

double RingFit::z_at(double x, double y) const { return height + mean.dot(terms_at(*this, x, y)); }

namespace {

/// A surface along a row: a polynomial in u, and what a crease adds.
struct RowSurface {
    std::array<double, kHighestDegree + 1> powers{};
    bool is_creased = false;
    double across = 0, beyond = 0;          ///< the distance beyond the crease is across u + beyond
    double along = 0, turn = 0;             ///< the place along it along + turn u
    double once = 0, twist = 0, square = 0; ///< coefficients of the crease's terms
};

/// Heights at four places.
FETTLE_INLINE Double4 heights(const RowSurface& row, const Double4& u)
{
    Double4 z = core::broadcast(row.powers[kHighestDegree]);
    for (std::size_t i = kHighestDegree; i-- > 0;) z = z * u + core::broadcast(row.powers[i]);
    if (!row.is_creased) return z;
    const Double4 beyond = core::cwise_max(core::broadcast(0), row.across * u + row.beyond);
    return z + beyond * (row.once + row.twist * (row.along + row.turn * u) + row.square * beyond);
}

/// @param x  of the first place; the spacing is 1
FETTLE_CLONES void add_heights(const RowSurface& surface, double x, double centre, double scale, double factor,
                               float* row, std::size_t count)
{
    const Double4 lane = {0, 1, 2, 3};
    std::size_t i = 0;
    for (; i + 4 <= count; i += 4) {
        const Double4 z = heights(surface, (x + double(i) + lane - centre) / scale);
        for (std::size_t k = 0; k < 4; ++k) row[i + k] = float(double(row[i + k]) + factor * z[k]);
    }
    if (i == count) return;
    const Double4 z = heights(surface, (x + double(i) + lane - centre) / scale);
    for (std::size_t k = 0; i + k < count; ++k) row[i + k] = float(double(row[i + k]) + factor * z[k]);
}

} // namespace

void RingFit::add_row(double x, double y, double factor, std::span<float> row) const
{
    // In x along the row: coefficients of its powers, from those of total degree up to 4.
    RowSurface surface;
    const double v = (y - centre.y()) / scale;
    Index k = 0;
    for (int total = 0; total <= highest_degree; ++total) {
        double power = 1;
        for (int b = 0; b <= total; ++b, power *= v) surface.powers[std::size_t(total - b)] += power * mean[k++];
    }
    surface.powers[0] += height;
    if (crease) { // as Crease::terms()
        const Eigen::Vector2d& across = crease->across;
        surface.is_creased = true;
        surface.across = across.x(), surface.beyond = across.y() * v - crease->offset;
        surface.along = across.x() * v, surface.turn = -across.y();
        surface.once = mean[k], surface.twist = mean[k + 1], surface.square = mean[k + 2];
    }
    add_heights(surface, x, centre.x(), scale, factor, row.data(), row.size());
}

} // namespace fettle::find
