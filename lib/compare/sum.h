#pragma once

#include <cmath>

namespace fettle {

/// A sum that carries what each addition rounds off (Neumaier 1974).
class Sum {
  public:
    void add(double number)
    {
        const double sum = sum_ + number;
        rest_ += std::abs(sum_) >= std::abs(number) ? (sum_ - sum) + number : (number - sum) + sum_;
        sum_ = sum;
    }
    double value() const { return sum_ + rest_; }

  private:
    double sum_ = 0, rest_ = 0;
};

} // namespace fettle
