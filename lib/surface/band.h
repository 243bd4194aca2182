#pragma once

#include <Eigen/Core>

#include <vector>

namespace fettle::surface {

/// Symmetric band matrix. Row i stores the entries (i, i - half_bandwidth) … (i, i), contiguously.
class BandMatrix {
  public:
    BandMatrix(Eigen::Index size, Eigen::Index half_bandwidth);

    Eigen::Index size() const { return size_; }
    Eigen::Index half_bandwidth() const { return half_bandwidth_; }
    /// Entry (i, j), i - half_bandwidth <= j <= i.
    double& operator()(Eigen::Index i, Eigen::Index j) { return row(i)[j]; }
    double operator()(Eigen::Index i, Eigen::Index j) const { return row(i)[j]; }
    /// row(i)[j] is entry (i, j).
    double* row(Eigen::Index i) { return entries_.data() + (i + 1) * stride(); }
    const double* row(Eigen::Index i) const { return entries_.data() + (i + 1) * stride(); }

    /// Adds `factor` times another matrix of the same size and bandwidth.
    void add(const BandMatrix& other, double factor);
    Eigen::VectorXd operator*(const Eigen::VectorXd& x) const;
    double trace() const;

  private:
    // Rows are factorised four at a time, from the first column of the first of them: each row is padded with zeros.
    static constexpr Eigen::Index kPadding = 4;
    Eigen::Index stride() const { return half_bandwidth_ + kPadding; } ///< from an entry to the one below it

    Eigen::Index size_, half_bandwidth_;
    std::vector<double> entries_;
};

/// Cholesky decomposition H = L Lᵀ of a positive definite band matrix (Golub and Van Loan 2013, 4.3.5); L has the same
/// band. Eigen has no band storage; its sparse Cholesky does not return the entries of the inverse inside the band.
class BandCholesky {
  public:
    /// @throws InputError if H is not positive definite
    explicit BandCholesky(BandMatrix H);

    Eigen::VectorXd solve(const Eigen::VectorXd& b) const;       ///< H⁻¹ b
    Eigen::VectorXd solve_lower(const Eigen::VectorXd& b) const; ///< L⁻¹ b; its squared norm is bᵀ H⁻¹ b
    double log_determinant() const;
    /// Entries of H⁻¹ inside the band, without those outside (Takahashi, Fagan and Chin 1973).
    BandMatrix inverse_in_band() const;

  private:
    BandMatrix L_;
};

} // namespace fettle::surface
