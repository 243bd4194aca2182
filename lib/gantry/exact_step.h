#pragma once

namespace fettle::gantry {

/// Position and velocity of a linear axis: mm, mm/s (of a rotary axis rad, rad/s).
struct Motion {
    double p = 0, v = 0;
};

/// m p̈ + d ṗ + k p = f.
struct Oscillator {
    double mass = 1, damping = 0, stiffness = 0;
};

/// The exact solution over one period under a force that changes linearly: the exponential of the matrix of
/// (p, v, f, ḟ)' (Van Loan 1978).
class ExactStep {
  public:
    ExactStep(const Oscillator& oscillator, double period);

    /// @param f, rate  force at the beginning of the period, and its change per s
    Motion operator()(const Motion& x, double f, double rate) const
    {
        return {p_[0] * x.p + p_[1] * x.v + p_[2] * f + p_[3] * rate,
                v_[0] * x.p + v_[1] * x.v + v_[2] * f + v_[3] * rate};
    }
    /// Rows of the exponential.
    const double* position_row() const { return p_; }
    const double* velocity_row() const { return v_; }

  private:
    double p_[4], v_[4];
};

} // namespace fettle::gantry
