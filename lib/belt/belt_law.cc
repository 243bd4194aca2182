#include "belt/belt_law.h"

#include <cmath>

namespace fettle::belt {

double RemovalStep::depth(double p) const
{
    if (!(p > threshold)) return 0;
    return exponent == 1 ? scale * (p - threshold) : scale * std::pow(p - threshold, exponent);
}

double RemovalStep::slope(double p) const
{
    if (exponent == 1) return scale;
    return p > threshold ? scale * exponent * std::pow(p - threshold, exponent - 1) : 0;
}

RemovalStep removal_step(const BeltLaw& law, double belt_speed, double feed, double duration, double prior_work)
{
    const double sharpness = law.wear_work > 0 ? std::exp(-prior_work / law.wear_work) : 1;
    return {law.coefficient * std::pow(belt_speed, law.speed_exponent) * std::pow(feed, law.feed_exponent) * sharpness *
                duration,
            law.pressure_exponent, law.threshold};
}

} // namespace fettle::belt
