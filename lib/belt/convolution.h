#pragma once

#include <Eigen/Core>

#include <memory>

namespace fettle {

/// Sums over a grid that surrounds itself with nothing: displacement(i, j) = Σ influence(|i - k|, |j - l|) pressure(k,
/// l), by Fourier transforms on a grid of at least twice the size.
class Convolution {
  public:
    explicit Convolution(const Eigen::MatrixXd& influence);
    ~Convolution();
    Convolution(Convolution&&) noexcept;

    /// Both of the influence's size.
    void operator()(const Eigen::MatrixXd& pressure, Eigen::MatrixXd& displacement) const;

  private:
    struct Work;
    std::unique_ptr<Work> work_;
};

} // namespace fettle
