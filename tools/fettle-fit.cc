#include "cli/tool.h"
#include "cloud/fields.h"
#include "cloud/point_source.h"
#include "core/file.h"
#include "core/text.h"
#include "fit/dense.h"
#include "fit/fit.h"
#include "job/boundary.h"

#include <optional>
#include <ostream>

using namespace fettle;

namespace {

std::vector<std::string> choices()
{
    std::vector<std::string> names = {"auto"};
    names.insert(names.end(), fit_methods().begin(), fit_methods().end());
    return names;
}

/// Points without roles are samples.
Eigen::VectorXi roles(const Cloud& cloud, const std::string& source)
{
    if (!has_field(cloud, "role")) return Eigen::VectorXi::Ones(cloud.size());
    constexpr int kMostRole = 5;
    const Eigen::VectorXi numbers = whole_numbers(cloud, "role");
    for (Eigen::Index i = 0; i < numbers.size(); ++i)
        if (numbers[i] < 0 || numbers[i] > kMostRole)
            throw InputError(source, "point " + std::to_string(i) + ": " + to_text(field(cloud, "role")[i]) +
                                         " is no role (0 to 5)");
    return numbers;
}

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
        .set("weight", fit.surface.weight)
        .set("gross_errors", static_cast<int>(fit.surface.gross_errors.size()));
    if (fit.surface.alternatives.empty()) return;
    std::vector<json::Value> scores(1);
    scores[0].set("method", fit.surface.method).set("score", fit.surface.score).set("weight", fit.surface.weight);
    for (const Alternative& other : fit.surface.alternatives) {
        scores.emplace_back();
        scores.back().set("method", other.method).set("score", other.score).set("weight", other.weight);
    }
    out.set("scores", scores);
}

/// One warning for each touch that was left out: the operator looks there, or touches again.
void name_gross_errors(Tool& t, const Fit& fit, const std::string& source, const Units& units)
{
    for (const Eigen::Index i : fit.surface.gross_errors)
        t.warn(source + ": the touch at " + place(fit.surface.touches.col(i).head<2>(), units) + " is off by " +
               to_short_text(fit.residuals[i] / units.mm()) + " " + to_string(units.length) + "; left out");
}

/// More points than the exact fit takes: they are streamed.
bool is_dense(const CloudStream& stream, const Job& job, const std::string& method)
{
    return stream.points().points > kMostExactTouches &&
           (method == "bspline" || (method == "auto" && job.surface == SurfaceType::freeform));
}

void report(json::Value& out, const DenseFit& dense)
{
    const Surface& surface = dense.fit.surface;
    const double mm = surface.units.mm();
    out.set("method", surface.method)
        .set("touches", dense.counts.used)
        .set("ignored", dense.counts.ignored())
        .set("undefined", dense.counts.undefined)
        .set("other_role", dense.counts.other_role)
        .set("inside_anomaly", dense.counts.anomaly)
        .set("outside_sampling", dense.counts.outside)
        .set("outliers", dense.outliers)
        .set("iterations", dense.fit.iterations)
        .set("rms", surface.rms / mm)
        .set("touch_sigma", surface.touch_sigma / mm)
        .set("goodness", surface.goodness);
}

Verdict finish(Tool& t, const Fit& fit, std::size_t touches, std::size_t ignored)
{
    const Surface& surface = fit.surface;
    if (!fit.converged) {
        t.warn("the " + surface.method + " fit did not converge in " + std::to_string(fit.iterations) + " iterations");
        return Verdict::no;
    }
    t.note(surface.method + " fit of " + std::to_string(touches) + " touches, " + std::to_string(ignored) +
           " points ignored, rms " + to_text(surface.rms / surface.units.mm()) + " " + to_string(surface.units.length));
    t.output() << to_json(surface);
    return Verdict::yes;
}

} // namespace

int main(int argc, char** argv)
{
    return tool_main(argc, argv, "Fit the desired surface beneath the anomaly to the touches.", [](Tool& t) {
        const std::string& job = t.file("JOB", "Job, JSON");
        const std::string& points = t.input(
            "POINTS", "Touches (x y z, role) or, without roles, a scan, PCD; more than 300 are streamed if binary");
        const std::string& method =
            t.choice("-m,--method", "auto", choices(),
                     "Kind of surface; auto: what explains the touches best, weighed against the others. Plane jobs: a "
                     "plane; swept ones: straight along their direction");
        const bool& use_boundary = t.flag(
            "--use-boundary", "Take the anomaly's boundary points as touches, too: those of role 0, else the job's "
                              "that have a z; planes always do");
        const std::optional<Units::Length>& file_unit =
            t.length_unit("--file-units", "Unit of POINTS, if it is not the job's");
        const std::optional<double>& spacing =
            t.number_if_given("--spacing", "LENGTH",
                              "Griddata: half the shortest wave to keep; 0: do not sample again; else half the "
                              "mean distance of the points",
                              Range::at_least(0));
        t.example("fettle-sample jobs/hammer.json --on scans/hammer.stl | fettle-fit jobs/hammer.json > surface.json",
                  "touch a scanned hammer and fit a free-form surface");
        t.reference("Wang (2007), 4.2 to 4.4; Hoeting et al. (1999), Bayesian model averaging: auto");
        t.parse();

        FitInput input;
        input.job = read_job(job);
        input.source = display_name(points);
        const Units units{file_unit.value_or(input.job.units.length), input.job.units.force};
        const CloudStream stream(points, units);
        if (is_dense(stream, input.job, method)) {
            if (use_boundary && !stream.points().has_roles)
                t.warn("--use-boundary: a scan shows the metal at the boundary itself, the job's points are not added");
            const DenseFit dense = fit_dense(stream.points(), input.job, use_boundary, input.source);
            report(t.report(), dense);
            return finish(t, dense.fit, dense.counts.used, dense.counts.ignored());
        }
        const std::shared_ptr<const Cloud> cloud = stream.cloud();
        input.xyz = cloud->xyz;
        input.roles = roles(*cloud, input.source);
        if (has_field(*cloud, "curve")) input.curves = whole_numbers(*cloud, "curve");
        if (use_boundary) take_boundary(input);
        if (spacing) input.spacing = *spacing * input.job.units.mm();
        const Fit fit = fit_surface(input, method);
        report(t.report(), fit);
        name_gross_errors(t, fit, input.source, input.job.units);
        return finish(t, fit, static_cast<std::size_t>(fit.surface.touches.cols()),
                      static_cast<std::size_t>(fit.surface.ignored));
    });
}
