#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>

namespace fettle {

using Rgb = std::array<std::uint8_t, 3>;

/// Colours of signed errors, from -limit to +limit and the end colours beyond: dark red over-cut, nearly white right,
/// dark blue under-cut (material left). Red and blue stay apart for every common colour blindness, and either side
/// gets darker evenly, so that the size shows in grey print as well.
struct ColourScale {
    double limit = 1; ///< positive, in the unit of the errors

    Rgb operator()(double error) const; ///< NaN: kUndefinedColour
};

/// Where there is no error to show: a grey that the scale does not hold.
inline constexpr Rgb kUndefinedColour = {128, 128, 128};

/// The scale that shows these errors: ±2 tolerances if there is one (the tolerance lies half-way to the dark ends),
/// else the 99th percentile of their size, so that a stray point does not bleach the map.
/// @param tolerance  0 or NaN: none
ColourScale colour_scale(const Eigen::VectorXd& errors, double tolerance);

/// One colour a point, 3xN, for set_colours().
Eigen::Matrix<std::uint8_t, 3, Eigen::Dynamic> colours(const ColourScale& scale, const Eigen::VectorXd& errors);

} // namespace fettle
