#include "belt/assess.h"

#include "compare/colours.h"
#include "compare/comparison_report.h"
#include "units/units.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace fettle {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The reds and blues of fettle-verify's triangle patches; green, pale, stays apart from them in grey print as well.
constexpr Rgb kWithin = {190, 225, 190};
constexpr Rgb kGouge = {235, 60, 60}, kDeepGouge = {130, 0, 0};
constexpr Rgb kUndercut = {165, 115, 220}, kHighUndercut = {20, 30, 140};

Rgb colour(double displacement, const ToleranceRange& range)
{
    if (std::isnan(displacement)) return kUndefinedColour;
    const double width = range.upper - range.lower;
    if (displacement < range.lower) return displacement < range.lower - width ? kDeepGouge : kGouge;
    if (displacement > range.upper) return displacement > range.upper + width ? kHighUndercut : kUndercut;
    return kWithin;
}

} // namespace

Assessment assess(double displacement, const ToleranceRange& range)
{
    if (displacement < range.lower) return Assessment::gouge;
    return displacement > range.upper ? Assessment::undercut : Assessment::within;
}

AssessmentCounts count(const Eigen::VectorXd& displacement, const ToleranceRange& range)
{
    AssessmentCounts counts;
    for (const double d : displacement) {
        if (std::isnan(d)) {
            ++counts.undefined;
            continue;
        }
        const Assessment found = assess(d, range);
        ++(found == Assessment::gouge ? counts.gouge : found == Assessment::undercut ? counts.undercut : counts.within);
    }
    return counts;
}

void set_assessment(Cloud& cloud, const Eigen::VectorXd& displacement, const ToleranceRange& range)
{
    Eigen::VectorXd classes(displacement.size());
    Eigen::Matrix<std::uint8_t, 3, Eigen::Dynamic> colours(3, displacement.size());
    for (Eigen::Index i = 0; i < displacement.size(); ++i) {
        classes[i] = std::isnan(displacement[i]) ? kNone : static_cast<double>(assess(displacement[i], range));
        const Rgb rgb = colour(displacement[i], range);
        colours.col(i) << rgb[0], rgb[1], rgb[2];
    }
    set_field(cloud, "error", displacement);
    set_field(cloud, "class", classes);
    set_colours(cloud, colours);
}

Statistics displacement_statistics(const Surfels& surfels)
{
    Tally tally(std::nullopt);
    const bool has_areas = surfels.area.size() > 0;
    tally.add(surfels.displacement, has_areas ? surfels.area : Eigen::VectorXd::Zero(surfels.size()), surfels.position);
    Statistics statistics = tally.statistics();
    if (has_areas) return statistics;
    statistics.over_cut_area = statistics.under_cut_area = kNone;
    statistics.over_cut_volume = statistics.under_cut_volume = kNone;
    return statistics;
}

json::Value to_json(const Surfels& surfels, const ToleranceRange& range)
{
    const AssessmentCounts counts = count(surfels.displacement, range);
    Statistics statistics = displacement_statistics(surfels);
    statistics.within = static_cast<double>(counts.within) / static_cast<double>(statistics.count);
    return to_json(statistics, Units{})
        .set("lower", range.lower)
        .set("upper", range.upper)
        .set("gouge", static_cast<std::size_t>(counts.gouge))
        .set("undercut", static_cast<std::size_t>(counts.undercut));
}

} // namespace fettle
