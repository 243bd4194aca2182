#pragma once

#include <array>
#include <complex>
#include <functional>
#include <numbers>
#include <vector>

namespace fettle {

/// What a loop bears before it swings without end.
struct Margins {
    double gain = 1e6;               ///< factor on its gain, upwards
    double phase = std::numbers::pi; ///< rad
    double sensitivity = 0;          ///< the peak: largest |1 / (1 + L)| over all frequencies
};

/// The stated margin of every loop. A peak of M means a gain margin of at least M / (M − 1), here 3, and a phase margin
/// of at least 2 asin(1 / 2M), here 38.9° (Åström and Murray 2008, 9.3).
inline constexpr double kMostSensitivity = 1.5;

/// A PID controller that looks every T s: K_p + K_i T z / (z − 1) + K_d (z − 1) / (T z).
struct Pid {
    double kp = 0, ki = 0, kd = 0;
};
std::complex<double> response(const Pid& controller, double period, std::complex<double> z);

/// The response of a plant, by which any number of controllers can be tried on it.
class LoopResponse {
  public:
    /// @param plant        G(z), sampled every `period` s
    /// @param frequencies  so many intervals, even in logarithm, from a thousandth of the highest, π / period, up to it
    LoopResponse(const std::function<std::complex<double>(std::complex<double>)>& plant, double period,
                 int frequencies);

    /// Largest |1 / (1 + L)| of the loop that the controller closes.
    double sensitivity_peak(const Pid& controller) const;
    /// Of a loop that is stable when closed.
    Margins margins(const Pid& controller) const;

  private:
    using Parts = std::array<std::complex<double>, 3>;
    static std::complex<double> loop(const Parts& parts, const Pid& controller)
    {
        return controller.kp * parts[0] + controller.ki * parts[1] + controller.kd * parts[2];
    }
    std::vector<Parts> parts_; ///< at each frequency, L of the controllers with K_p = 1, with K_i = 1, with K_d = 1
};

} // namespace fettle
