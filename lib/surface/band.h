#pragma once

#include <Eigen/Core>

#include <vector>

namespace fettle {

/// A symmetric matrix whose entries vanish further than `half` from the diagonal. Row i holds the lower ones, (i, i -
/// half) … (i, i), one after the other.
class BandMatrix {
  public:
    BandMatrix(Eigen::Index size, Eigen::Index half);

    Eigen::Index size() const { return size_; }
    Eigen::Index half() const { return half_; }
    /// Entry (i, j), i - half <= j <= i.
    double& operator()(Eigen::Index i, Eigen::Index j) { return row(i)[j]; }
    double operator()(Eigen::Index i, Eigen::Index j) const { return row(i)[j]; }
    /// row(i)[j] is entry (i, j).
    double* row(Eigen::Index i) { return entries_.data() + (i + 1) * stride(); }
    const double* row(Eigen::Index i) const { return entries_.data() + (i + 1) * stride(); }

    /// Adds `factor` times another of the same shape.
    void add(const BandMatrix& other, double factor);
    Eigen::VectorXd operator*(const Eigen::VectorXd& x) const;
    double trace() const;

  private:
    // Rows are factorised four at a time, from the first column that any of them has: a row has zeros before its own.
    static constexpr Eigen::Index kPadding = 4;
    Eigen::Index stride() const { return half_ + kPadding; } ///< from an entry to the one below it

    Eigen::Index size_, half_;
    std::vector<double> entries_;
};

/// H = L Lᵀ of a positive definite band matrix (Golub and Van Loan 2013, 4.3.5); L has the same band.
class BandCholesky {
  public:
    /// @throws InputError if H is not positive definite
    explicit BandCholesky(BandMatrix H);

    Eigen::VectorXd solve(const Eigen::VectorXd& b) const;      ///< H⁻¹ b
    Eigen::VectorXd half_solve(const Eigen::VectorXd& b) const; ///< L⁻¹ b; its square norm is bᵀ H⁻¹ b
    double log_determinant() const;
    /// The entries of H⁻¹ inside the band (Takahashi, Fagan and Chin 1973).
    BandMatrix inverse_in_band() const;

  private:
    BandMatrix L_;
};

} // namespace fettle
