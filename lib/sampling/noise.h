#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <string>

namespace fettle {

/// Random error of a touch, along z.
struct TouchNoise {
    enum class Kind { none, uniform, normal };
    Kind kind = Kind::none;
    double amplitude = 0; ///< A, mm. uniform: within ±A; normal: 99 % within ±A (Wang 2007, 4.4 and 4.5)
};

/// "uniform:0.005" or "normal:0.005"; an empty text: none.
/// @param unit  mm in the unit of A
/// @throws InputError
TouchNoise parse_noise(const std::string& text, double unit);

/// One error for each touch, mm. Touch i has the same error whatever is drawn for the others, and the same on every
/// platform: two numbers of std::mt19937_64 each, and transforms of our own.
Eigen::VectorXd draw_noise(const TouchNoise& noise, Eigen::Index touches, std::uint64_t seed);

} // namespace fettle
