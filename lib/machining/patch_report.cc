#include "machining/patch_report.h"

#include "compare/colours.h"
#include "compare/comparison_report.h"
#include "compare/statistics.h"
#include "core/text.h"
#include "units/units.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <ostream>
#include <string>

namespace fettle {
namespace {

/// N·Z/|N| at 45 degrees: to there the patch method is held against the closest point.
const double kSteep = std::sqrt(0.5);

/// Counts, areas and volumes of the classes; volumes with the sign of their errors.
json::Value classes_of(const PatchVerdict& verdict)
{
    const Eigen::VectorXd& error = verdict.error();
    json::Value classes;
    for (const ErrorClass wanted : kErrorClasses) {
        std::size_t count = 0;
        double area = 0, volume = 0;
        for (Eigen::Index t = 0; t < error.size(); ++t) {
            if (std::isnan(error[t]) || classify(error[t], verdict.tolerances) != wanted) continue;
            ++count;
            if (std::isnan(verdict.patches.area[t])) continue; // on a wall only the closest point is known
            area += verdict.patches.area[t];
            volume += verdict.patches.area[t] * error[t];
        }
        classes.set(to_string(wanted), json::Value().set("count", count).set("area", area).set("volume", volume));
    }
    return classes;
}

json::Value undefined_of(const PatchErrors& patches)
{
    json::Value reasons;
    for (const PatchState state : {PatchState::not_hit, PatchState::vertical, PatchState::turned_away})
        reasons.set(to_string(state),
                    static_cast<std::size_t>(std::count(patches.state.begin(), patches.state.end(), state)));
    return reasons;
}

/// How far mu is from the closest point's error, where both are defined.
json::Value difference_on(const PatchVerdict& verdict, bool steep)
{
    std::size_t count = 0;
    double most = 0, sum = 0;
    Eigen::Vector3d place = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    for (Eigen::Index t = 0; t < verdict.closest.size(); ++t) {
        const double off = std::abs(verdict.patches.mu[t] - verdict.closest[t]);
        if (std::isnan(off) || (verdict.patches.normal.col(t).dot(verdict.patches.up) < kSteep) != steep) continue;
        ++count;
        sum += off;
        if (!(off > most)) continue;
        most = off;
        place = verdict.patches.centre.col(t);
    }
    const double mean = count > 0 ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
    return json::Value()
        .set("count", count)
        .set("mean_abs", mean)
        .set("max_abs", most)
        .set("max_at", Eigen::VectorXd(place));
}

std::string class_name(const PatchVerdict& verdict, Eigen::Index t)
{
    const double error = verdict.error()[t];
    if (!std::isnan(error)) return to_string(classify(error, verdict.tolerances));
    const PatchState state = verdict.patches.state[static_cast<std::size_t>(t)];
    return state == PatchState::defined ? "no_closest_point" : to_string(state);
}

} // namespace

std::size_t over_cut(const PatchVerdict& verdict)
{
    return static_cast<std::size_t>((verdict.error().array() < -verdict.tolerances.inner).count());
}

json::Value to_json(const PatchVerdict& verdict)
{
    Tally tally(std::nullopt);
    tally.add(verdict.error(), verdict.patches.area, verdict.patches.centre);
    const Statistics all = tally.statistics();
    json::Value report = to_json(all, Units{});
    std::size_t within = 0;
    for (const double error : verdict.error())
        within += error >= -verdict.tolerances.inner && error <= verdict.tolerances.outer;
    report
        .set("within", static_cast<double>(within) / static_cast<double>(all.count)) // 0/0 without any: null
        .set("method", verdict.by_closest ? "closest" : "patch")
        .set("inner_tolerance", verdict.tolerances.inner)
        .set("outer_tolerance", verdict.tolerances.outer)
        .set("classes", classes_of(verdict))
        .set("undefined_by_patch", undefined_of(verdict.patches));
    if (verdict.closest.size() > 0)
        report.set(
            "patch_minus_closest",
            json::Value().set("to_45_deg", difference_on(verdict, false)).set("steeper", difference_on(verdict, true)));
    return report;
}

Cloud to_cloud(const PatchVerdict& verdict)
{
    const PatchErrors& patches = verdict.patches;
    const Eigen::VectorXd& error = verdict.error();
    Cloud cloud;
    cloud.xyz = patches.centre;
    Eigen::VectorXd classes(error.size());
    Eigen::Matrix<std::uint8_t, 3, Eigen::Dynamic> rgb(3, error.size());
    for (Eigen::Index t = 0; t < error.size(); ++t) {
        const bool defined = !std::isnan(error[t]);
        const ErrorClass of = classify(error[t], verdict.tolerances);
        classes[t] = defined ? static_cast<double>(of) : error[t];
        const Rgb shown = defined ? colour(of) : kUndefinedColour;
        rgb.col(t) << shown[0], shown[1], shown[2];
    }
    set_field(cloud, "error", error);
    if (verdict.closest.size() > 0) set_field(cloud, "closest", verdict.closest);
    set_field(cloud, "d", patches.d);
    set_field(cloud, "class", classes);
    set_normals(cloud, patches.normal);
    set_colours(cloud, rgb);
    return cloud;
}

void write_csv(std::ostream& out, const PatchVerdict& verdict)
{
    const bool closest = verdict.closest.size() > 0;
    const auto number = [](double value) { return std::isnan(value) ? std::string() : to_text(value); };
    out << "triangle,x,y,z,d,mu," << (closest ? "closest," : "") << "class\n";
    for (Eigen::Index t = 0; t < verdict.patches.d.size(); ++t) {
        out << t;
        for (int k = 0; k < 3; ++k) out << ',' << number(verdict.patches.centre(k, t));
        out << ',' << number(verdict.patches.d[t]) << ',' << number(verdict.patches.mu[t]) << ',';
        if (closest) out << number(verdict.closest[t]) << ',';
        out << class_name(verdict, t) << '\n';
    }
}

} // namespace fettle
