#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>

namespace fettle::draw {

using Rgb = std::array<std::uint8_t, 3>;

/// Diverging colour scale of signed errors, from -limit to +limit, clamped beyond: dark red over-cut, nearly white
/// zero, dark blue under-cut (material left). Red and blue are distinguishable with every common colour blindness, and
/// either side darkens evenly, so that the size shows in grey print as well.
struct ColourScale {
    double limit = 1; ///< positive, in the unit of the errors

    Rgb operator()(double error) const; ///< NaN: kUndefinedColour
};

/// Colour of undefined errors: a grey that is not on the scale.
inline constexpr Rgb kUndefinedColour = {128, 128, 128};

/// Scale for these errors: ±2 tolerances if there is one, else ± the 99th percentile of |error|, so that single
/// outliers do not make the map pale.
/// @param tolerance  0 or NaN: none
ColourScale colour_scale(const Eigen::VectorXd& errors, double tolerance);

/// Colours of the points, 3xN, for set_colours().
Eigen::Matrix<std::uint8_t, 3, Eigen::Dynamic> colours(const ColourScale& scale, const Eigen::VectorXd& errors);

} // namespace fettle::draw
