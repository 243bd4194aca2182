#include "surface/band.h"

#include "core/error.h"
#include "core/simd.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fettle::surface {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kLanes = 4;

FETTLE_INLINE double sum(const core::Double4& four) { return (four[0] + four[1]) + (four[2] + four[3]); }

FETTLE_CLONES double dot(const double* a, const double* b, Index count)
{
    core::Double4 sums{};
    Index k = 0;
    for (; k + kLanes <= count; k += kLanes)
        sums += *reinterpret_cast<const core::Double4*>(a + k) * *reinterpret_cast<const core::Double4*>(b + k);
    double result = sum(sums);
    for (; k < count; ++k) result += a[k] * b[k];
    return result;
}

/// y += factor x
FETTLE_CLONES void add_multiple(double* y, const double* x, double factor, Index count)
{
    Index k = 0;
    for (; k + kLanes <= count; k += kLanes)
        *reinterpret_cast<core::Double4*>(y + k) += factor * *reinterpret_cast<const core::Double4*>(x + k);
    for (; k < count; ++k) y[k] += factor * x[k];
}

/// Computes columns first … end - 1 of four rows of L; rows[j - first] is the finished row j.
FETTLE_CLONES void eliminate(double* const* four, const double* const* rows, Index first, Index end)
{
    for (Index j = first; j < end; ++j) {
        const double* row = rows[j - first];
        core::Double4 s0{}, s1{}, s2{}, s3{};
        Index k = first;
        for (; k + kLanes <= j; k += kLanes) {
            const core::Double4 l = *reinterpret_cast<const core::Double4*>(row + k);
            s0 += l * *reinterpret_cast<const core::Double4*>(four[0] + k);
            s1 += l * *reinterpret_cast<const core::Double4*>(four[1] + k);
            s2 += l * *reinterpret_cast<const core::Double4*>(four[2] + k);
            s3 += l * *reinterpret_cast<const core::Double4*>(four[3] + k);
        }
        double t[kLanes] = {sum(s0), sum(s1), sum(s2), sum(s3)};
        for (; k < j; ++k)
            for (Index i = 0; i < kLanes; ++i) t[i] += row[k] * four[i][k];
        for (Index i = 0; i < kLanes; ++i) four[i][j] = (four[i][j] - t[i]) / row[j];
    }
}

} // namespace

BandMatrix::BandMatrix(Index size, Index half_bandwidth)
    : size_(size), half_bandwidth_(std::min(half_bandwidth, size - 1)),
      entries_(size * (half_bandwidth_ + kPadding + 1), 0.0)
{
}

void BandMatrix::add(const BandMatrix& other, double factor)
{
    add_multiple(entries_.data(), other.entries_.data(), factor, entries_.size());
}

VectorXd BandMatrix::operator*(const VectorXd& x) const
{
    VectorXd y = VectorXd::Zero(size_);
    for (Index i = 0; i < size_; ++i) {
        const Index first = std::max<Index>(0, i - half_bandwidth_);
        y[i] += dot(row(i) + first, x.data() + first, i - first + 1);
        add_multiple(y.data() + first, row(i) + first, x[i], i - first);
    }
    return y;
}

double BandMatrix::trace() const
{
    double result = 0;
    for (Index i = 0; i < size_; ++i) result += (*this)(i, i);
    return result;
}

BandCholesky::BandCholesky(BandMatrix H) : L_(std::move(H))
{
    std::vector<const double*> above(L_.half_bandwidth());
    for (Index i = 0; i < L_.size(); i += kLanes) {
        const Index count = std::min(kLanes, L_.size() - i);
        const Index first = std::max<Index>(0, i - L_.half_bandwidth());
        for (Index j = first; j < i; ++j) above[j - first] = L_.row(j);
        std::array<double*, kLanes> four;
        for (Index r = 0; r < kLanes; ++r) four[r] = L_.row(i + std::min(r, count - 1));
        if (count == kLanes) eliminate(four.data(), above.data(), first, i);
        for (Index r = 0; r < count; ++r) {
            double* row = L_.row(i + r);
            const Index begin = count == kLanes ? i : first;
            for (Index j = begin; j < i + r; ++j)
                row[j] = (row[j] - dot(row + first, L_.row(j) + first, j - first)) / L_(j, j);
            const double pivot = row[i + r] - dot(row + first, row + first, i + r - first);
            if (!(pivot > 0)) throw core::InputError("the points do not determine the surface");
            row[i + r] = std::sqrt(pivot);
        }
    }
}

VectorXd BandCholesky::solve_lower(const VectorXd& b) const
{
    VectorXd y = b;
    Index i = 0;
    while (i < y.size() && y[i] == 0) ++i; // the solution is 0 there as well
    for (const Index start = i; i < y.size(); ++i) {
        const Index first = std::max(start, i - L_.half_bandwidth());
        y[i] = (y[i] - dot(L_.row(i) + first, y.data() + first, i - first)) / L_(i, i);
    }
    return y;
}

VectorXd BandCholesky::solve(const VectorXd& b) const
{
    VectorXd x = solve_lower(b);
    for (Index i = x.size() - 1; i >= 0; --i) {
        const Index first = std::max<Index>(0, i - L_.half_bandwidth());
        x[i] /= L_(i, i);
        add_multiple(x.data() + first, L_.row(i) + first, -x[i], i - first);
    }
    return x;
}

double BandCholesky::log_determinant() const
{
    double result = 0;
    for (Index i = 0; i < L_.size(); ++i) result += 2 * std::log(L_(i, i));
    return result;
}

// Lᵀ Z = L⁻¹ gives Z column by column, from the last: Z_ij = (δ_ij / L_jj - Σ_{k>j} Z_ik L_kj) / L_jj. The square
// window holds Z_ik for the `half` indices after j, each at its index modulo half + 1.
BandMatrix BandCholesky::inverse_in_band() const
{
    const Index n = L_.size(), half = L_.half_bandwidth();
    BandMatrix Z(n, half);
    const Index width = half + 1;
    Eigen::MatrixXd window = Eigen::MatrixXd::Zero(width, width);
    VectorXd column = VectorXd::Zero(width);
    for (Index j = n - 1; j >= 0; --j) {
        const Index last = std::min(n - 1, j + half);
        column.setZero();
        for (Index k = j + 1; k <= last; ++k) column[k % width] = L_(k, j);
        double diagonal = 1 / L_(j, j);
        for (Index i = j + 1; i <= last; ++i) {
            const double z = -dot(&window(0, i % width), column.data(), width) / L_(j, j);
            Z(i, j) = z;
            diagonal -= z * L_(i, j);
        }
        Z(j, j) = diagonal / L_(j, j);
        for (Index i = j; i <= last; ++i) window(j % width, i % width) = window(i % width, j % width) = Z(i, j);
    }
    return Z;
}

} // namespace fettle::surface
