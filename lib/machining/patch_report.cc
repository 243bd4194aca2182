#include "machining/patch_report.h"

#include "compare/comparison_report.h"
#include "core/constants.h"
#include "core/text.h"
#include "draw/colours.h"
#include "geometry/statistics.h"
#include "units/units.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <ostream>
#include <string>

namespace fettle::machining {
namespace {

/// N·Z/|N| of a slope of 45 degrees: on flatter patches both errors should agree.
const double kCosSteepSlope = std::sqrt(0.5);

/// Counts, areas and volumes of the classes; the volumes have the sign of the errors.
json::Value class_statistics(const PatchVerdict& verdict)
{
    const Eigen::VectorXd &error = verdict.error(), area_of_patch = verdict.area();
    json::Value classes;
    for (const ErrorClass wanted : kErrorClasses) {
        std::size_t count = 0;
        double area = 0, volume = 0;
        for (Eigen::Index t = 0; t < error.size(); ++t) {
            if (std::isnan(error[t]) || classify(error[t], verdict.tolerances) != wanted) continue;
            ++count;
            area += area_of_patch[t];
            volume += area_of_patch[t] * error[t];
        }
        classes.set(to_string(wanted), json::Value().set("count", count).set("area", area).set("volume", volume));
    }
    return classes;
}

json::Value undefined_counts(const PatchErrors& patches)
{
    json::Value reasons;
    for (const PatchState state : {PatchState::not_hit, PatchState::vertical, PatchState::turned_away})
        reasons.set(to_string(state), std::size_t(std::ranges::count(patches.state, state)));
    return reasons;
}

/// Absolute difference of mu and the closest point's error, where both are defined.
json::Value method_difference(const PatchVerdict& verdict, bool steep)
{
    std::size_t count = 0;
    double max = 0, sum = 0;
    Eigen::Vector3d max_at = Eigen::Vector3d::Constant(core::kNaN);
    for (Eigen::Index t = 0; t < verdict.closest.size(); ++t) {
        const double difference = std::abs(verdict.patches.mu[t] - verdict.closest[t]);
        if (std::isnan(difference)) continue;
        if ((verdict.patches.normal.col(t).dot(verdict.patches.up) < kCosSteepSlope) != steep) continue;
        ++count;
        sum += difference;
        if (!(difference > max)) continue;
        max = difference;
        max_at = verdict.patches.centre.col(t);
    }
    return json::Value()
        .set("count", count)
        .set("mean_abs", count > 0 ? sum / count : core::kNaN)
        .set("max_abs", max)
        .set("max_at", Eigen::VectorXd(max_at));
}

std::string class_name(const PatchVerdict& verdict, Eigen::Index t)
{
    const double error = verdict.error()[t];
    if (!std::isnan(error)) return to_string(classify(error, verdict.tolerances));
    const PatchState state = verdict.patches.state[t];
    return state == PatchState::defined ? "no_closest_point" : to_string(state);
}

} // namespace

Eigen::VectorXd PatchVerdict::area() const
{
    return patches.area.array().isNaN().select(patches.machined_area, patches.area);
}

std::size_t count_over_cut(const PatchVerdict& verdict)
{
    return (verdict.error().array() < -verdict.tolerances.inner).count();
}

json::Value to_json(const PatchVerdict& verdict)
{
    geometry::StatisticsAccumulator tally(std::nullopt);
    tally.add(verdict.error(), verdict.area(), verdict.patches.centre);
    const geometry::Statistics all = tally.statistics();
    json::Value report = compare::to_json(all, units::Units{});
    std::size_t within = 0;
    for (const double error : verdict.error())
        within += error >= -verdict.tolerances.inner && error <= verdict.tolerances.outer;
    report
        .set("within", static_cast<double>(within) / all.count) // 0/0 if there are none: null
        .set("method", verdict.use_closest_point ? "closest" : "patch")
        .set("inner_tolerance", verdict.tolerances.inner)
        .set("outer_tolerance", verdict.tolerances.outer)
        .set("classes", class_statistics(verdict))
        .set("undefined_by_patch", undefined_counts(verdict.patches));
    if (verdict.closest.size() > 0)
        report.set("patch_minus_closest", json::Value()
                                              .set("to_45_deg", method_difference(verdict, false))
                                              .set("steeper", method_difference(verdict, true)));
    return report;
}

cloud::Cloud to_cloud(const PatchVerdict& verdict)
{
    const PatchErrors& patches = verdict.patches;
    const Eigen::VectorXd& error = verdict.error();
    cloud::Cloud cloud;
    cloud.xyz = patches.centre;
    Eigen::VectorXd classes(error.size());
    Eigen::Matrix<std::uint8_t, 3, Eigen::Dynamic> rgb(3, error.size());
    for (Eigen::Index t = 0; t < error.size(); ++t) {
        const bool defined = !std::isnan(error[t]);
        const ErrorClass error_class = classify(error[t], verdict.tolerances);
        classes[t] = defined ? static_cast<double>(error_class) : error[t];
        const draw::Rgb shown = defined ? colour(error_class) : draw::kUndefinedColour;
        rgb.col(t) << shown[0], shown[1], shown[2];
    }
    cloud::set_field(cloud, "error", error);
    if (verdict.closest.size() > 0) cloud::set_field(cloud, "closest", verdict.closest);
    cloud::set_field(cloud, "d", patches.d);
    cloud::set_field(cloud, "class", classes);
    cloud::set_normals(cloud, patches.normal);
    cloud::set_colours(cloud, rgb);
    return cloud;
}

void write_csv(std::ostream& out, const PatchVerdict& verdict)
{
    const bool closest = verdict.closest.size() > 0;
    const auto number = [](double value) { return std::isnan(value) ? std::string() : core::to_text(value); };
    out << "triangle,x,y,z,d,mu," << (closest ? "closest," : "") << "class\n";
    for (Eigen::Index t = 0; t < verdict.patches.d.size(); ++t) {
        out << t;
        for (int k = 0; k < 3; ++k) out << ',' << number(verdict.patches.centre(k, t));
        out << ',' << number(verdict.patches.d[t]) << ',' << number(verdict.patches.mu[t]) << ',';
        if (closest) out << number(verdict.closest[t]) << ',';
        out << class_name(verdict, t) << '\n';
    }
}

cloud::Cloud z_errors_to_cloud(const mesh::Mesh& machined, const Eigen::VectorXd& z_error)
{
    cloud::Cloud cloud;
    cloud.xyz = machined.vertices;
    cloud::set_field(cloud, "error", z_error);
    return cloud;
}

} // namespace fettle::machining
