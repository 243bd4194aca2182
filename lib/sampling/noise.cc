#include "sampling/noise.h"

#include "core/error.h"
#include "core/range.h"
#include "core/text.h"

#include <cmath>
#include <numbers>
#include <random>

namespace fettle {

namespace {

// 99 % of a normal distribution lie within so many standard deviations.
constexpr double kSigmas99 = 2.5758293035489004;

// Uniform in (0, 1): the upper 53 bits, and half a unit so that neither end occurs.
double unit_interval(std::mt19937_64& random) { return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53; }

} // namespace

TouchNoise parse_noise(const std::string& text, double unit)
{
    if (text.empty()) return {};
    const std::size_t colon = text.find(':');
    const std::string kind = text.substr(0, colon);
    if (colon == std::string::npos || (kind != "uniform" && kind != "normal"))
        throw InputError("--noise", "expected uniform:A or normal:A, got '" + text + "'");
    const std::optional<double> amplitude = parse_number(text.substr(colon + 1));
    if (!amplitude || !Range::at_least(0).contains(*amplitude))
        throw InputError("--noise", "A must be a number, at least 0, got '" + text.substr(colon + 1) + "'");
    return {kind == "uniform" ? TouchNoise::Kind::uniform : TouchNoise::Kind::normal, *amplitude * unit};
}

Eigen::VectorXd draw_noise(const TouchNoise& noise, Eigen::Index touches, std::uint64_t seed)
{
    std::mt19937_64 random(seed);
    Eigen::VectorXd errors = Eigen::VectorXd::Zero(touches);
    for (double& error : errors) {
        const double u = unit_interval(random), v = unit_interval(random);
        if (noise.kind == TouchNoise::Kind::uniform) error = noise.amplitude * (2 * u - 1);
        if (noise.kind == TouchNoise::Kind::normal) // Box and Muller 1958
            error = noise.amplitude / kSigmas99 * std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
    }
    return errors;
}

} // namespace fettle
