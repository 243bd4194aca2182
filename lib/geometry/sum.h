#pragma once

#include <cmath>

namespace fettle::geometry {

/// Compensated summation: a second accumulator adds up the rounding error of each addition (Neumaier 1974).
class CompensatedSum {
  public:
    void add(double number)
    {
        const double sum = sum_ + number;
        compensation_ += std::abs(sum_) >= std::abs(number) ? (sum_ - sum) + number : (number - sum) + sum_;
        sum_ = sum;
    }
    double value() const { return sum_ + compensation_; }

  private:
    double sum_ = 0, compensation_ = 0;
};

} // namespace fettle::geometry
