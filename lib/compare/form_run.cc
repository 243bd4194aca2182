#include "compare/form_run.h"

#include "compare/sections.h"
#include "core/error.h"
#include "job/region.h"

#include <algorithm>
#include <vector>

namespace fettle::compare {

namespace {

Eigen::Matrix3Xd select_points(const cloud::Cloud& cloud, const std::optional<job::Job>& job, std::size_t& dropped)
{
    std::vector<job::Region> regions;
    if (job) regions = job::classify_regions(*job, cloud.xyz);
    std::vector<Eigen::Index> used;
    for (Eigen::Index i = 0; i < cloud.size(); ++i) {
        if (!cloud.xyz.col(i).allFinite())
            ++dropped;
        else if (regions.empty() || regions[i] == job::Region::inside)
            used.push_back(i);
    }
    return cloud.xyz(Eigen::all, used);
}

/// The form of points, reduced to those that are no outliers; counts the outliers.
Form evaluate_without_outliers(const FormRequest& request, Eigen::Matrix3Xd& points, const Eigen::Vector3d& section,
                               std::size_t& outliers)
{
    if (request.outlier_limit) {
        const auto kept = without_outliers(request.kind, points, *request.outlier_limit, section);
        outliers += static_cast<std::size_t>(points.cols()) - kept.size();
        points = points(Eigen::all, kept).eval();
    }
    return evaluate_form(request.kind, points, section);
}

json::Value measure_sections(const FormRequest& request, const Eigen::Matrix3Xd& points, const units::Units& units,
                             std::size_t& outliers)
{
    constexpr std::size_t kMinPoints = 3; // two points are always straight
    const SectionGrid& grid = *request.sections;
    const Eigen::Vector3d normal = section_normal(grid.direction);
    std::vector<json::Value> rows;
    std::optional<json::Value> worst;
    double max_minimum_zone = -1, max_least_squares = 0;
    std::size_t too_few = 0;
    for (const Section& section : vertical_sections(points, grid.direction, grid.spacing, grid.width)) {
        if (section.points.size() < kMinPoints) {
            ++too_few;
            continue;
        }
        Eigen::Matrix3Xd line = points(Eigen::all, section.points);
        const Form form = evaluate_without_outliers(request, line, normal, outliers);
        rows.emplace_back();
        rows.back().set("offset", section.offset / units.mm()).set("count", line.cols());
        rows.back().set("least_squares", form.least_squares.width / units.mm());
        rows.back().set("minimum_zone", form.minimum_zone.width / units.mm());
        max_least_squares = std::max(max_least_squares, form.least_squares.width);
        if (form.minimum_zone.width <= max_minimum_zone) continue;
        max_minimum_zone = form.minimum_zone.width;
        worst = to_json(form, line, units);
        worst->set("offset", section.offset / units.mm());
    }
    if (!worst) throw core::InputError("no section has as many as 3 points");
    worst->set("least_squares", max_least_squares / units.mm());
    return worst->set("sections", rows).set("sections_too_few", too_few);
}

} // namespace

FormRun measure_form(const cloud::Cloud& cloud, const FormRequest& request, const units::Units& units)
{
    FormRun run;
    std::size_t outliers = 0;
    Eigen::Matrix3Xd points = select_points(cloud, request.job, run.dropped);
    if (request.sections) {
        run.report = measure_sections(request, points, units, outliers);
    } else {
        const Form form = evaluate_without_outliers(request, points, Eigen::Vector3d::Zero(), outliers);
        run.report = to_json(form, points, units);
    }
    run.report.set("dropped", run.dropped).set("outliers", outliers);
    return run;
}

} // namespace fettle::compare
