#include "sampling/noise.h"

#include "core/error.h"
#include "core/range.h"
#include "core/text.h"
#include "geometry/uniform_draws.h"

namespace fettle::sampling {

namespace {

// 99 % of a normal distribution are within ± this number of standard deviations.
constexpr double kSigmas99 = 2.5758293035489004;

} // namespace

TouchNoise parse_noise(const std::string& text, double unit)
{
    if (text.empty()) return {};
    const std::size_t colon = text.find(':');
    const std::string kind = text.substr(0, colon);
    if (colon == std::string::npos || (kind != "uniform" && kind != "normal"))
        throw core::InputError("--noise", "expected uniform:A or normal:A, got '" + text + "'");
    const std::optional<double> amplitude = core::parse_number(text.substr(colon + 1));
    if (!amplitude || !core::Range::at_least(0).contains(*amplitude))
        throw core::InputError("--noise", "A must be a number, at least 0, got '" + text.substr(colon + 1) + "'");
    return {kind == "uniform" ? TouchNoise::Kind::uniform : TouchNoise::Kind::normal, *amplitude * unit};
}

Eigen::VectorXd draw_noise(const TouchNoise& noise, Eigen::Index touches, std::uint64_t seed)
{
    std::mt19937_64 random(seed);
    Eigen::VectorXd errors = Eigen::VectorXd::Zero(touches);
    for (double& error : errors) {
        if (noise.kind == TouchNoise::Kind::uniform) {
            error = noise.amplitude * (2 * geometry::draw_open_uniform(random) - 1);
            random.discard(1); // two numbers for each touch, whatever the distribution
        }
        if (noise.kind == TouchNoise::Kind::normal) error = geometry::draw_normal(random, noise.amplitude / kSigmas99);
    }
    return errors;
}

} // namespace fettle::sampling
