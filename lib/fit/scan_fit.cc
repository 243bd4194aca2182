#include "fit/scan_fit.h"

#include "core/error.h"
#include "fit/bspline.h"
#include "fit/representatives.h"
#include "fit/selection.h"
#include "fit/wavy_family.h"
#include "geometry/bounding_box.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace fettle::fit {

namespace {

/// The representatives as touches whose noise is known.
FitInput input_of(const Representatives& heights, const job::Job& job, const std::string& name)
{
    FitInput input;
    input.xyz = heights.xyz;
    input.roles = Eigen::VectorXi::Ones(heights.xyz.cols());
    input.job = job;
    input.job.probe.accuracy *= heights.sigma / touch_sigma(job.probe);
    input.source = name;
    return input;
}

std::vector<std::string> candidate_names(const std::string& method, job::SurfaceType type)
{
    if (method != "auto") return {method};
    if (type == job::SurfaceType::plane) return {"plane"};
    std::vector<std::string> names = candidate_families(type);
    std::erase(names, "cubic"); // a process on a quadratic holds it
    return names;
}

/// The families that the heights determine, all of them fitted at once.
std::vector<WavyFamily> fit_wavy_families(const FitInput& input, const TouchSet& touches,
                                          const std::vector<std::string>& names)
{
    const surface::Bspline grid = spline_grid(input, touches.xyz);
    const Eigen::Matrix2Xd anomaly = job::rotation_working_machine(input.job.theta) * input.job.anomaly.topRows<2>();
    const double size = geometry::bounding_box(anomaly).sizes().maxCoeff();
    std::vector<std::optional<WavyFamily>> fitted(names.size());
    tbb::parallel_for(std::size_t{0}, names.size(),
                      [&](std::size_t k) { fitted[k] = fit_wavy_family(names[k], touches, grid, size); });
    std::vector<WavyFamily> all;
    for (std::optional<WavyFamily>& one : fitted)
        if (one) all.push_back(std::move(*one));
    return all;
}

/// Weighs the candidates, each as the part with waves and as the part under a scanner's waves.
std::vector<WeightedCandidate> weigh(std::vector<WavyFamily> families)
{
    double best = std::numeric_limits<double>::infinity();
    for (WavyFamily& family : families) {
        const double penalty = prior_penalty(family.without_waves.method);
        family.with_waves.score += penalty;
        family.without_waves.score += penalty;
        best = std::min(best, family.with_waves.score);
    }
    std::vector<WeightedCandidate> all;
    for (WavyFamily& family : families) {
        const double weight = std::exp((best - family.with_waves.score) / 2), scanner = family.scanner_probability;
        all.push_back({std::move(family.with_waves), weight * (1 - scanner)});
        all.push_back({std::move(family.without_waves), weight * scanner});
    }
    return all;
}

Fit fit_heights(const FitInput& input, const std::string& method)
{
    const bool is_family = method != "griddata" && method != "bspline-wang";
    if (!is_family) return fit_surface(input, method);
    surface::Surface surface = begin_surface(input, method, kSampleRoles, 3);
    TouchSet touches = make_touch_set(surface, input.job);
    touches.sigma = noise_about_process(touches);
    surface.touch_sigma = touches.sigma;
    std::vector<WavyFamily> families = fit_wavy_families(input, touches, candidate_names(method, input.job.surface));
    if (families.empty()) refuse_undetermined(touches, method == "auto" ? "surface" : method, input.source);
    if (method == "auto" && input.job.surface != job::SurfaceType::plane) {
        set_candidates(weigh(std::move(families)), surface);
    } else {
        FitCandidate& family = families.front().without_waves;
        surface.method = family.method;
        surface.shape = std::move(family.shape);
        surface.covariance = std::move(family.covariance);
    }
    return finish_fit(std::move(surface), 0, true, 1);
}

} // namespace

DenseFit fit_scan(const cloud::PointSource& source, const job::Job& job, const PointFilter& filter,
                  const std::string& method, const std::string& name)
{
    if (method == "bspline") return fit_dense(source, job, filter, name);
    const DensePoints points = dense_points(source, job, filter, name);
    const RobustSpline spline = fit_robust_spline(points, name);
    DenseFit result;
    const Representatives heights = condense(points, spline);
    result.fit = fit_heights(input_of(heights, job, name), method);
    result.dropped_groups = heights.dropped;
    result.fit.converged = result.fit.converged && spline.converged();
    result.fit.iterations = spline.passes;
    result.counts = spline.counts;
    result.outliers = spline.last.outliers;
    result.point_sigma = spline.sigma;
    result.fit.surface.ignored = ignored_count(result.counts);
    return result;
}

} // namespace fettle::fit
