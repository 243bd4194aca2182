#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace fettle::draw {

using Rgb = std::array<std::uint8_t, 3>;

/// Colours of signed errors.
enum class Palette {
    accessible, ///< dark red over-cut, nearly white zero, dark blue under-cut. Red and blue are distinguishable with
                ///< every common colour blindness, and either side darkens evenly, so that the size shows in grey print
    inspection, ///< as inspection programs draw it: red material left, green zero, blue over-cut
};

/// The palettes by their names, and what a tool's help says of them; the first is the default.
inline const std::vector<std::pair<std::string, Palette>> kPalettes = {{"accessible", Palette::accessible},
                                                                       {"inspection", Palette::inspection}};
inline constexpr const char* kPaletteHelp =
    "Colours of errors and classes: red over-cut, blue material left, safe for colour blindness; or, as inspection "
    "programs draw it, red material left, green zero, blue over-cut";

/// Diverging colour scale of signed errors, from -limit (over-cut) to +limit (under-cut, material left), clamped
/// beyond.
struct ColourScale {
    double limit = 1; ///< positive, in the unit of the errors
    Palette palette = Palette::accessible;

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
