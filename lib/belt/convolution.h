#pragma once

#include <Eigen/Core>

#include <memory>

namespace fettle::belt {

/// Linear (zero-padded) convolution with an even kernel: displacement(i, j) = Σ influence(|i - k|, |j - l|) pressure(k,
/// l), by Fourier transforms on a grid of at least twice the size.
class Convolution {
  public:
    explicit Convolution(const Eigen::MatrixXd& influence);
    ~Convolution();
    Convolution(Convolution&&) noexcept;

    /// Both matrices have the size of the influence matrix.
    void operator()(const Eigen::MatrixXd& pressure, Eigen::MatrixXd& displacement) const;

  private:
    struct Buffers;
    std::unique_ptr<Buffers> buffers_;
};

} // namespace fettle::belt
