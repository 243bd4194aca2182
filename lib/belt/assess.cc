#include "belt/assess.h"

#include "compare/comparison_report.h"
#include "draw/colours.h"
#include "units/units.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace fettle::belt {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Reds and blues as on fettle-verify's triangle patches; the pale green differs from them in grey print as well.
constexpr draw::Rgb kWithinColour = {190, 225, 190};
constexpr draw::Rgb kGougeColour = {235, 60, 60}, kDeepGougeColour = {130, 0, 0};
constexpr draw::Rgb kUndercutColour = {165, 115, 220}, kHighUndercutColour = {20, 30, 140};

draw::Rgb colour_of(double displacement, const ToleranceRange& range)
{
    if (std::isnan(displacement)) return draw::kUndefinedColour;
    const double width = range.upper - range.lower;
    if (displacement < range.lower) return displacement < range.lower - width ? kDeepGougeColour : kGougeColour;
    if (displacement > range.upper) return displacement > range.upper + width ? kHighUndercutColour : kUndercutColour;
    return kWithinColour;
}

} // namespace

Assessment assess(double displacement, const ToleranceRange& range)
{
    if (displacement < range.lower) return Assessment::gouge;
    return displacement > range.upper ? Assessment::undercut : Assessment::within;
}

AssessmentCounts count_assessments(const Eigen::VectorXd& displacement, const ToleranceRange& range)
{
    AssessmentCounts counts;
    for (const double d : displacement) ++(std::isnan(d) ? counts.undefined : counts[assess(d, range)]);
    return counts;
}

void set_assessment(cloud::Cloud& cloud, const Eigen::VectorXd& displacement, const ToleranceRange& range)
{
    Eigen::VectorXd classes(displacement.size());
    Eigen::Matrix<std::uint8_t, 3, Eigen::Dynamic> colours(3, displacement.size());
    for (Eigen::Index i = 0; i < displacement.size(); ++i) {
        classes[i] = std::isnan(displacement[i]) ? kNan : static_cast<double>(assess(displacement[i], range));
        const draw::Rgb rgb = colour_of(displacement[i], range);
        colours.col(i) << rgb[0], rgb[1], rgb[2];
    }
    cloud::set_field(cloud, "error", displacement);
    cloud::set_field(cloud, "class", classes);
    cloud::set_colours(cloud, colours);
}

geometry::Statistics displacement_statistics(const Surfels& surfels)
{
    geometry::StatisticsAccumulator tally(std::nullopt);
    const bool has_areas = surfels.area.size() > 0;
    tally.add(surfels.displacement, has_areas ? surfels.area : Eigen::VectorXd::Zero(surfels.size()), surfels.position);
    geometry::Statistics statistics = tally.statistics();
    if (has_areas) return statistics;
    statistics.over_cut_area = statistics.under_cut_area = kNan;
    statistics.over_cut_volume = statistics.under_cut_volume = kNan;
    return statistics;
}

json::Value to_json(const Surfels& surfels, const ToleranceRange& range)
{
    const AssessmentCounts counts = count_assessments(surfels.displacement, range);
    geometry::Statistics statistics = displacement_statistics(surfels);
    statistics.within = static_cast<double>(counts.within) / statistics.count;
    return compare::to_json(statistics, units::Units{})
        .set("lower", range.lower)
        .set("upper", range.upper)
        .set("gouge", counts.gouge)
        .set("undercut", counts.undercut);
}

} // namespace fettle::belt
