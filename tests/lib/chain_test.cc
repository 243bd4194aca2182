// The whole chain on Wang's third part: what must not change when the part lies elsewhere, and what must balance.

#include "compare/signed_distance.h"
#include "fit/fit.h"
#include "gantry/quasi_static.h"
#include "geometry/statistics.h"
#include "margin/shift.h"
#include "part/part.h"
#include "plan/plan.h"
#include "sampling/estimate.h"
#include "sampling/probe.h"
#include "strategy/run.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <numbers>

namespace fettle {
namespace chain_test {

struct Case {
    job::Job job;
    mesh::Mesh part;
    mesh::Mesh truth;
};

Case sphere_with_anomalies()
{
    const std::string samples = std::getenv("SAMPLES");
    part::PartSpec spec = part::read_part(samples + "/parts/wang3.json");
    Case c{job::read_job(samples + "/jobs/wang3.json"), std::get<mesh::Mesh>(part::make_part(spec, 1)), {}};
    spec.anomalies.clear();
    c.truth = std::get<mesh::Mesh>(part::make_part(spec, 1));
    return c;
}

/// A part and its job, turned about Z by `angle` and moved by `offset`.
Case moved(Case c, double angle, const Eigen::Vector3d& offset)
{
    const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    for (Eigen::Matrix3Xd* points : {&c.part.vertices, &c.truth.vertices, &c.job.anomaly, &c.job.sampling})
        *points = (R * *points).colwise() + offset;
    c.job.theta += angle;
    c.job.safe_height += offset.z();
    return c;
}

struct Result {
    cloud::Cloud ground;
    Eigen::VectorXd error; ///< of each point of `ground`, mm
    removal::HeightField before, after;
    gantry::GrindTotals totals;
    double shift = 0;
    bool finished = false;
};

surface::Surface desired_surface(const Case& c)
{
    const sampling::Scan scan(c.part);
    const sampling::TouchPlan plan = sampling::plan_touches(c.job);
    const sampling::TouchNoise noise = sampling::parse_noise("normal:0.005", c.job.units.mm());
    fit::FitInput input;
    input.job = c.job;
    input.xyz = sampling::probe(scan, c.job, plan, noise, 1);
    input.roles = plan.role;
    input.curves = plan.curve;
    surface::Surface surface = fit::fit_surface(input, "auto").surface;
    surface.prediction = margin::predict_by_posterior(surface, c.job, 0.99, 1);
    surface.shift = surface.prediction->shift;
    return surface;
}

Result run_chain(const Case& c, double cell)
{
    const surface::Surface surface = desired_surface(c);
    const plan::Plan plan = plan::make_plan(c.job, surface);
    Result result;
    result.shift = surface.shift;
    result.before = removal::stock_from_scan(sampling::Scan(c.part), c.job, cell);
    gantry::QuasiStaticGantry gantry(result.before, c.job);
    result.finished = strategy::run(plan, gantry).finished;
    result.after = gantry.stock();
    result.totals = gantry.totals();
    result.ground = removal::to_cloud(result.before, result.after);
    result.error = compare::signed_distance(result.ground.xyz, c.truth).error;
    return result;
}

/// Coarser than in practice, so that the tests are quick.
constexpr double kCell = 0.5;
/// Coordinates of some 100 mm round at 1e-14 mm; the chain's decisions (fit, spring, cells) may enlarge that a
/// thousandfold per stage and stay far below a nanometre.
constexpr double kRounding = 1e-6;

void expect_same_map(const Result& a, const Result& b)
{
    ASSERT_EQ(a.error.size(), b.error.size());
    EXPECT_NEAR(a.shift, b.shift, kRounding);
    EXPECT_NEAR(a.totals.removed_volume, b.totals.removed_volume, kRounding * a.totals.removed_volume);
    for (Eigen::Index i = 0; i < a.error.size(); ++i) {
        ASSERT_EQ(std::isnan(a.error[i]), std::isnan(b.error[i])) << i;
        if (!std::isnan(a.error[i])) {
            ASSERT_NEAR(a.error[i], b.error[i], kRounding) << i;
        }
    }
}

TEST(Chain, TranslationChangesNoErrorMap)
{
    const Case c = sphere_with_anomalies();
    const Result here = run_chain(c, kCell);
    ASSERT_TRUE(here.finished);
    expect_same_map(here, run_chain(moved(c, 0, {123.456, -78.9, 31.4}), kCell));
}

TEST(Chain, TurnWithThetaChangesNoErrorMap)
{
    const Case c = sphere_with_anomalies();
    const Result here = run_chain(c, kCell);
    for (const double degrees : {90.0, 37.0, -111.0})
        expect_same_map(here, run_chain(moved(c, degrees * std::numbers::pi / 180, Eigen::Vector3d::Zero()), kCell));
}

TEST(Chain, RemovedVolumeIsIntegratedDepth)
{
    const Result result = run_chain(sphere_with_anomalies(), kCell);
    const double depth = cloud::field(result.ground, "removed").sum() * kCell * kCell;
    EXPECT_GT(depth, 0);
    EXPECT_NEAR(result.totals.removed_volume, depth, 1e-6 * depth); // the field is a float
    EXPECT_NEAR(result.totals.removed_volume, removal::volume_between(result.before, result.after), 1e-9 * depth);
}

// Cells change the volume of a wall by their side at most: halving them halves the difference or better, give or take
// the chance of where the walls fall between the centres.
TEST(Chain, HalvingTheCellConverges)
{
    const Case c = sphere_with_anomalies();
    const double v8 = run_chain(c, 0.8).totals.removed_volume;
    const double v4 = run_chain(c, 0.4).totals.removed_volume;
    const double v2 = run_chain(c, 0.2).totals.removed_volume;
    EXPECT_LT(std::abs(v4 - v2), std::max(std::abs(v8 - v4), 1e-3 * v2));
    EXPECT_LT(std::abs(v4 - v2), 5e-3 * v2);
}

TEST(Chain, NothingIsGroundBelowTheTruth)
{
    const Result result = run_chain(sphere_with_anomalies(), kCell);
    EXPECT_GT(result.error.minCoeff<Eigen::PropagateNumbers>(), -0.03);
}

} // namespace chain_test
} // namespace fettle
