// Hill climbing on a known patch (Wang 2007, Appendix A): Tables 4-1, 4-4, the left half of 4-5, figure 4-10.

#include "cli/tool.h"
#include "job/boundary.h"
#include "margin/anomaly_grid.h"
#include "margin/known_band.h"
#include "sampling/estimate.h"
#include "sampling/freeform.h"
#include "tables.h"

#include <cmath>
#include <ostream>

using namespace fettle;
using namespace fettle::study;

namespace {

// Strips of figure 4-9: contours of the anomaly, 0.25 in wide.
constexpr double kStrip = 0.25 * kInch;
constexpr int kStrips = 10;

/// Share of the touches in each strip by their distance from B.
Eigen::VectorXd strip_shares(const job::Job& job, const Eigen::Matrix2Xd& touches)
{
    const job::Polygon anomaly = job::working_boundaries(job).anomaly;
    Eigen::VectorXd shares = Eigen::VectorXd::Zero(kStrips);
    for (const Eigen::Vector2d& xy : touches.colwise()) {
        const auto strip = static_cast<int>(job::distance_to_edge(anomaly, xy) / kStrip);
        if (strip < kStrips) shares[strip] += 1.0 / static_cast<double>(touches.cols());
    }
    return shares;
}

struct Cell {
    job::Job job;
    Height truth;
    bool estimated = true;
    bool spline = false;
    double spacing = 0;       ///< of griddata's uniform sampling, mm
    double between = 0;       ///< candidates, mm; 0: the default of candidate_touches()
    double inset = 0;         ///< errors inside the sampling boundary less this, mm; 0: inside the anomaly
    sampling::TouchPlan plan; ///< Wang's layout, from which the estimated points come
};

margin::KnownSurface known_surface(const Cell& cell, std::uint64_t seed)
{
    margin::KnownSurface known;
    known.angle = cell.job.theta;
    job::Job region = cell.job;
    if (cell.inset > 0) {
        const Eigen::Matrix2Xd outer = cell.job.sampling.topRows<2>();
        region.anomaly =
            rectangle(outer.rowwise().minCoeff().array() + cell.inset, outer.rowwise().maxCoeff().array() - cell.inset);
    }
    known.anomaly_places = margin::anomaly_grid(region, kPlacesAcross);
    known.true_heights = heights(cell.truth, known.anomaly_places);
    known.candidates = touch(cell.truth, sampling::candidate_touches(cell.job, cell.between), seed);
    known.fixed_touches.resize(3, 0);
    if (cell.estimated)
        known.fixed_touches = sampling::estimated_points(cell.job, touch(cell.truth, cell.plan.xy, seed_of(seed, 1)),
                                                         cell.plan.curve, cell.plan.role);
    return known;
}

void run(const Cell& cell, const sampling::HillClimbOptions& settings, const std::string& name, std::ostream& out)
{
    const margin::KnownSurface known = known_surface(cell, settings.seed);
    const sampling::SubsetError band =
        cell.spline ? margin::tensor_bspline_band(known) : margin::griddata_band(known, cell.spacing);
    const sampling::HillClimbResult found = sampling::hill_climb(known.candidates.cols(), band, settings);
    write(out, name + "/touches", static_cast<double>(found.chosen.size()));
    write(out, name + "/start", found.start_error / kInch);
    write(out, name + "/band", found.error / kInch);
    const Eigen::VectorXd shares = strip_shares(cell.job, known.candidates(Eigen::all, found.chosen).topRows<2>());
    const Eigen::VectorXd all = strip_shares(cell.job, known.candidates.topRows<2>());
    for (int i = 0; i < kStrips; ++i) {
        write(out, name + "/strip" + std::to_string(i), 100 * shares[i]);
        write(out, name + "/even" + std::to_string(i), 100 * all[i]);
    }
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Hill climbing for touches on a known patch.", [](cli::Tool& t) {
        const std::string& job = t.positional_file("JOB", "Job, JSON");
        const std::string& patch = t.positional_file("PATCH", "The surface, JSON");
        const std::string& name = t.required_text("--name", "NAME", "Before each value");
        const bool& spline = t.flag("--spline", "Fit by bspline-wang, not by griddata");
        const bool& bare = t.flag("--without-estimated", "Without estimated points");
        const int& lines = t.count("--lines", 2, "Of Wang's layout, each way", 1, sampling::kMaxProbingLines);
        const int& touches = t.count("--touches", 0, "To be left; 0: as few as the discards leave", 0, 1000);
        const int& mutations = t.count("--mutations", 1000, "In each phase", 0, 1000000);
        const double& sharpness = t.number("--sharpness", 200, "K", "Of the discards, 1/in", core::Range::at_least(0));
        const double& spacing =
            t.number("--spacing", 0.5, "LENGTH", "Of griddata's uniform sampling, in", core::Range::positive());
        const double& between =
            t.number("--candidates", 0, "LENGTH", "Spacing of the candidates, in; 0: about a thousand",
                     core::Range::at_least(0));
        const double& inset =
            t.number("--inset", 0, "LENGTH", "Errors inside the sampling boundary less this, in; 0: inside the anomaly",
                     core::Range::at_least(0));
        const double& shift = t.number("--shift", 0, "LENGTH", "Of the anomaly along x, in");
        const int& first = t.count("--first", 1, "Number of the first run", 1, 1000000);
        const int& runs = t.count("--runs", 1, "How many", 1, 1000000);
        t.parse();

        Cell cell{job::read_job(job), patch_height(patch), !bare,         spline,
                  spacing * kInch,    between * kInch,     inset * kInch, {}};
        cell.job.anomaly.row(0).array() += shift * kInch;
        cell.plan = sampling::plan_freeform(cell.job, sampling::LineCount{lines, lines});
        sampling::HillClimbOptions settings;
        settings.touches = touches;
        settings.mutations = mutations;
        settings.sharpness = sharpness / kInch;
        for (int i = first; i < first + runs; ++i) {
            settings.seed = seed_of(t.seed(), static_cast<std::uint64_t>(i));
            run(cell, settings, name, t.output());
        }
        return cli::Verdict::yes;
    });
}
