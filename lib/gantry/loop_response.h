#pragma once

#include <array>
#include <complex>
#include <functional>
#include <numbers>
#include <vector>

namespace fettle::gantry {

/// Stability margins of a control loop.
struct Margins {
    double gain = 1e6;               ///< factor by which its gain may increase
    double phase = std::numbers::pi; ///< rad
    double sensitivity = 0;          ///< peak of |1 / (1 + L)| over all frequencies
};

/// Largest sensitivity peak of any loop. A peak of M means a gain margin of at least M / (M − 1), here 3, and a phase
/// margin of at least 2 asin(1 / 2M), here 38.9° (Åström and Murray 2008, 9.3).
inline constexpr double kMaxSensitivity = 1.5;

/// A PID controller with the sampling period T: K_p + K_i T z / (z − 1) + K_d (z − 1) / (T z).
struct Pid {
    double kp = 0, ki = 0, kd = 0;
};
std::complex<double> response(const Pid& controller, double period, std::complex<double> z);

/// The frequency response of a plant, computed once so that many controllers can be tried on it.
class LoopResponse {
  public:
    /// @param plant        G(z), sampled every `period` s
    /// @param frequencies  number of logarithmic intervals, from a thousandth of the Nyquist frequency π / period up to
    ///                     it
    LoopResponse(const std::function<std::complex<double>(std::complex<double>)>& plant, double period,
                 int frequencies);

    /// Largest |1 / (1 + L)| of the closed loop.
    double sensitivity_peak(const Pid& controller) const;
    /// Margins of a loop that is stable when closed.
    Margins margins(const Pid& controller) const;

  private:
    using Parts = std::array<std::complex<double>, 3>;
    static std::complex<double> loop(const Parts& parts, const Pid& controller)
    {
        return controller.kp * parts[0] + controller.ki * parts[1] + controller.kd * parts[2];
    }
    std::vector<Parts> parts_; ///< at each frequency, L of the controllers with K_p = 1, with K_i = 1, with K_d = 1
};

} // namespace fettle::gantry
