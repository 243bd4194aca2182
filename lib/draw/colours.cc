#include "draw/colours.h"

#include "geometry/quantiles.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fettle::draw {

namespace {

// RdBu of ColorBrewer (Cynthia Brewer, Apache-2.0), eleven classes, from -limit to +limit.
constexpr std::array<Rgb, 11> kRedBlue = {{{103, 0, 31},
                                           {178, 24, 43},
                                           {214, 96, 77},
                                           {244, 165, 130},
                                           {253, 219, 199},
                                           {247, 247, 247},
                                           {209, 229, 240},
                                           {146, 197, 222},
                                           {67, 147, 195},
                                           {33, 102, 172},
                                           {5, 48, 97}}};

// The order of hues of a spectrum, as GOM, PolyWorks and CloudCompare show deviations; green about zero.
constexpr std::array<Rgb, 11> kSpectrum = {{{20, 20, 140},
                                            {30, 70, 220},
                                            {30, 150, 235},
                                            {40, 200, 200},
                                            {70, 200, 110},
                                            {90, 190, 70},
                                            {150, 205, 60},
                                            {230, 215, 50},
                                            {245, 155, 35},
                                            {225, 65, 30},
                                            {150, 10, 20}}};

constexpr double kLimitTolerances = 2;
constexpr double kLimitShare = 0.99;

} // namespace

Rgb ColourScale::operator()(double error) const
{
    if (std::isnan(error)) return kUndefinedColour;
    const auto& stops = palette == Palette::accessible ? kRedBlue : kSpectrum;
    constexpr int kIntervals = static_cast<int>(kRedBlue.size()) - 1;
    const double position = (std::clamp(error / limit, -1.0, 1.0) + 1) / 2 * kIntervals;
    const int below = std::min(static_cast<int>(position), kIntervals - 1);
    Rgb mixed;
    for (std::size_t i = 0; i < mixed.size(); ++i) {
        const double low = stops[below][i], high = stops[below + 1][i];
        mixed[i] = static_cast<std::uint8_t>(low + (position - below) * (high - low) + 0.5);
    }
    return mixed;
}

ColourScale colour_scale(const Eigen::VectorXd& errors, double tolerance)
{
    if (tolerance > 0) return {kLimitTolerances * tolerance};
    std::vector<double> sizes;
    for (const double error : errors)
        if (std::isfinite(error)) sizes.push_back(std::abs(error));
    if (sizes.empty()) return {};
    const double limit = geometry::quantile(sizes, kLimitShare);
    return {limit > 0 ? limit : 1};
}

Eigen::Matrix<std::uint8_t, 3, Eigen::Dynamic> colours(const ColourScale& scale, const Eigen::VectorXd& errors)
{
    Eigen::Matrix<std::uint8_t, 3, Eigen::Dynamic> rgb(3, errors.size());
    for (Eigen::Index i = 0; i < errors.size(); ++i) {
        const Rgb colour = scale(errors[i]);
        rgb.col(i) << colour[0], colour[1], colour[2];
    }
    return rgb;
}

} // namespace fettle::draw
