#include "gantry/loop_response.h"

#include <algorithm>
#include <cmath>

namespace fettle::gantry {
namespace {

using Complex = std::complex<double>;

constexpr double kMinFrequencyShare = 1e-3; // of the Nyquist frequency

} // namespace

Complex response(const Pid& controller, double period, Complex z)
{
    return controller.kp + controller.ki * period * z / (z - 1.0) + controller.kd / period * (z - 1.0) / z;
}

LoopResponse::LoopResponse(const std::function<Complex(Complex)>& plant, double period, int frequencies)
{
    parts_.reserve(frequencies + 1);
    for (int n = 0; n <= frequencies; ++n) {
        const double angle = std::numbers::pi * std::pow(kMinFrequencyShare, 1 - double(n) / frequencies);
        const Complex z = std::polar(1.0, angle), g = plant(z);
        parts_.push_back({g, g * response({0, 1, 0}, period, z), g * response({0, 0, 1}, period, z)});
    }
}

double LoopResponse::sensitivity_peak(const Pid& controller) const
{
    double min_distance = std::norm(1.0 + loop(parts_.front(), controller)); // from -1, squared
    for (const Parts& parts : parts_) min_distance = std::min(min_distance, std::norm(1.0 + loop(parts, controller)));
    return 1 / std::sqrt(min_distance);
}

Margins LoopResponse::margins(const Pid& controller) const
{
    Margins found;
    found.sensitivity = sensitivity_peak(controller);
    Complex last = loop(parts_.front(), controller);
    for (const Parts& parts : parts_) {
        const Complex l = loop(parts, controller);
        const bool crosses = (last.imag() < 0) != (l.imag() < 0) && l.real() < 0 && last.real() < 0;
        if (crosses && std::abs(l) < 1) found.gain = std::min(found.gain, 1 / std::abs(l));
        if ((std::abs(last) < 1) != (std::abs(l) < 1))
            found.phase = std::min(found.phase, std::numbers::pi - std::abs(std::arg(l)));
        last = l;
    }
    return found;
}

} // namespace fettle::gantry
