#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <string>

namespace fettle::sampling {

/// Distribution of the random error of a touch along z.
struct TouchNoise {
    enum class Kind { none, uniform, normal };
    Kind kind = Kind::none;
    double amplitude = 0; ///< A, mm. uniform: within ±A; normal: 99 % within ±A (Wang 2007, 4.4 and 4.5)
};

/// Parses "uniform:0.005" or "normal:0.005"; an empty text means no noise.
/// @param unit  unit of A in mm
/// @throws InputError for any other text
TouchNoise parse_noise(const std::string& text, double unit);

/// One error per touch, mm. The error of touch i does not depend on the number of touches or on the platform: each uses
/// two numbers of std::mt19937_64, transformed here because the distributions of std are implementation-defined.
Eigen::VectorXd draw_noise(const TouchNoise& noise, Eigen::Index touches, std::uint64_t seed);

} // namespace fettle::sampling
