#include "compare/colours.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fettle {

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

constexpr double kTolerancesShown = 2;
constexpr double kShareShown = 0.99;

} // namespace

Rgb ColourScale::operator()(double error) const
{
    if (std::isnan(error)) return kUndefinedColour;
    constexpr int kSteps = static_cast<int>(kRedBlue.size()) - 1;
    const double place = (std::clamp(error / limit, -1.0, 1.0) + 1) / 2 * kSteps;
    const int below = std::min(static_cast<int>(place), kSteps - 1);
    Rgb mixed;
    for (std::size_t i = 0; i < mixed.size(); ++i) {
        const double low = kRedBlue[static_cast<std::size_t>(below)][i];
        const double high = kRedBlue[static_cast<std::size_t>(below) + 1][i];
        mixed[i] = static_cast<std::uint8_t>(low + (place - below) * (high - low) + 0.5);
    }
    return mixed;
}

ColourScale colour_scale(const Eigen::VectorXd& errors, double tolerance)
{
    if (tolerance > 0) return {kTolerancesShown * tolerance};
    std::vector<double> sizes;
    for (const double error : errors)
        if (std::isfinite(error)) sizes.push_back(std::abs(error));
    if (sizes.empty()) return {};
    const auto place = sizes.begin() + static_cast<std::ptrdiff_t>(kShareShown * static_cast<double>(sizes.size() - 1));
    std::nth_element(sizes.begin(), place, sizes.end());
    return {*place > 0 ? *place : 1};
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

} // namespace fettle
