#include "fit/report.h"

#include "core/text.h"
#include "fit/dense.h"
#include "fit/fit.h"
#include "job/boundary.h"

#include <algorithm>

namespace fettle::fit {

namespace {

void report_scores(json::Value& out, const surface::Surface& surface)
{
    if (surface.alternatives.empty()) return;
    std::vector<json::Value> scores(1);
    scores[0].set("method", surface.method).set("score", surface.score).set("weight", surface.weight);
    for (const surface::Alternative& other : surface.alternatives) {
        scores.emplace_back();
        scores.back().set("method", other.method).set("score", other.score).set("weight", other.weight);
    }
    out.set("scores", scores);
}

} // namespace

void report(json::Value& out, const Fit& fit)
{
    const double mm = fit.surface.units.mm();
    out.set("method", fit.surface.method)
        .set("touches", static_cast<int>(fit.surface.touches.cols()))
        .set("ignored", fit.surface.ignored)
        .set("iterations", fit.iterations)
        .set("rms", fit.surface.rms / mm)
        .set("max_abs", fit.residuals.cwiseAbs().maxCoeff() / mm)
        .set("touch_sigma", fit.surface.touch_sigma / mm)
        .set("goodness", fit.surface.goodness)
        .set("touch_freedom", fit.surface.touch_sigma_dof)
        .set("weight", fit.surface.weight)
        .set("outliers", static_cast<int>(fit.surface.outliers.size()));
    report_scores(out, fit.surface);
}

void report(json::Value& out, const DenseFit& dense)
{
    const surface::Surface& surface = dense.fit.surface;
    const double mm = surface.units.mm();
    out.set("method", surface.method)
        .set("touches", dense.counts.used)
        .set("ignored", dense.counts.ignored())
        .set("undefined", dense.counts.undefined)
        .set("other_role", dense.counts.other_role)
        .set("inside_anomaly", dense.counts.anomaly)
        .set("outside_sampling", dense.counts.outside)
        .set("overhanging", dense.counts.overhang)
        .set("outliers", dense.outliers)
        .set("dropped_groups", dense.dropped_groups)
        .set("iterations", dense.fit.iterations)
        .set("rms", surface.rms / mm)
        .set("touch_sigma", surface.touch_sigma / mm)
        .set("point_sigma", dense.point_sigma / mm)
        .set("goodness", surface.goodness);
    report_scores(out, surface);
}

namespace {

std::string with_unit(double length, const units::Units& units)
{
    return core::to_short_text(length / units.mm()) + " " + units::to_string(units.length);
}

} // namespace

std::vector<std::string> warnings(const DenseFit& dense, const job::Job& job, const std::string& source)
{
    const surface::Surface& surface = dense.fit.surface;
    const double scatter = std::max(surface.method == "bspline" ? surface.rms : 0, dense.point_sigma);
    if (scatter <= job.probe.accuracy) return {};
    return {source + ": the scan's points scatter by " + with_unit(scatter, job.units) +
            " rms about the surface, more than the probe's accuracy, " + with_unit(job.probe.accuracy, job.units) +
            ": does it hold two layers, does the anomaly's boundary go around all of it?"};
}

std::vector<std::string> warnings(const Fit& fit, const std::string& source)
{
    constexpr double kMinPValue = 1e-6; // below it the misfit is no chance: one good part in a million
    const surface::Surface& surface = fit.surface;
    const auto in_unit = [&](double length) { return with_unit(length, surface.units); };
    std::vector<std::string> list;
    for (const Eigen::Index i : surface.outliers)
        list.push_back(source + ": the touch at " + job::point_text(surface.touches.col(i).head<2>(), surface.units) +
                       " is an outlier, off by " + in_unit(fit.residuals[i]) + "; left out");
    if (surface.goodness < kMinPValue && surface.outliers.empty())
        list.push_back(source + ": the touches lie " + in_unit(surface.rms) +
                       " rms off the surface, the probe's accuracy explains " + in_unit(surface.touch_sigma) +
                       ": does the anomaly's boundary go around all of it, is the accuracy right?");
    return list;
}

} // namespace fettle::fit
