#include "core/error.h"
#include "job/boundary.h"
#include "margin/anomaly_grid.h"
#include "margin/known_band.h"
#include "sampling/hillclimb.h"
#include "surface/griddata.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <random>

namespace fettle {
namespace hillclimb_test {

double truth(double x, double y) { return 0.01 * x * x - 0.006 * x * y + 4 * std::sin(y / 25) + 0.3 * x; }

/// A 50 x 50 mm anomaly amid a sampling boundary of 120 x 100 mm, turned.
job::Job job()
{
    job::Job result;
    result.theta = 0.4;
    result.anomaly.resize(3, 4);
    result.anomaly << -25, 25, 25, -25, -25, -25, 25, 25, 0, 0, 0, 0;
    result.sampling.resize(3, 4);
    result.sampling << -60, 60, 60, -60, -50, -50, 50, 50, 0, 0, 0, 0;
    for (Eigen::Matrix3Xd* points : {&result.anomaly, &result.sampling})
        points->topRows<2>() = job::rotation_working_machine(result.theta).transpose() * points->topRows<2>();
    return result;
}

Eigen::VectorXd truth_at(const Eigen::Matrix2Xd& xy)
{
    Eigen::VectorXd z(xy.cols());
    for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = truth(xy(0, i), xy(1, i));
    return z;
}

margin::KnownSurface known(double spacing, int across = 12)
{
    margin::KnownSurface result;
    const Eigen::Matrix2Xd candidates = sampling::candidate_touches(job(), spacing);
    result.candidates.resize(3, candidates.cols());
    result.candidates << candidates, truth_at(candidates).transpose();
    result.fixed_touches.resize(3, 0);
    result.anomaly_places = margin::anomaly_grid(job(), across);
    result.true_heights = truth_at(result.anomaly_places);
    result.angle = job().theta;
    return result;
}

sampling::HillClimbOptions options(Eigen::Index touches, std::uint64_t seed = 1)
{
    sampling::HillClimbOptions result;
    result.touches = touches;
    result.mutations = 30;
    result.sharpness = 50;
    result.seed = seed;
    return result;
}

TEST(Candidates, LieOnGoodMetalInsideTheSamplingBoundary)
{
    const job::Boundaries both = job::working_boundaries(job());
    for (const double spacing : {0.0, 7.3, 5.0}) {
        const Eigen::Matrix2Xd places =
            job::rotation_working_machine(job().theta) * sampling::candidate_touches(job(), spacing);
        for (const Eigen::Vector2d& place : places.colwise()) {
            EXPECT_TRUE(job::contains(both.sampling, place) || job::distance_to_edge(both.sampling, place) < 1e-9);
            EXPECT_TRUE(!job::contains(both.anomaly, place) || job::distance_to_edge(both.anomaly, place) < 1e-9);
        }
    }
    EXPECT_NEAR(static_cast<double>(sampling::candidate_touches(job(), 0).cols()), sampling::kDefaultCandidates,
                0.1 * sampling::kDefaultCandidates);
    // a lattice of 25 x 21 places without the 9 x 9 inside B: its edge counts as good metal
    EXPECT_EQ(sampling::candidate_touches(job(), 5).cols(), 25 * 21 - 9 * 9);
    EXPECT_THROW(sampling::candidate_touches(job(), 0.1), core::InputError);
}

// Griddata's fast heights are those of the surface.
TEST(KnownBand, IsTheBandOfTheSurface)
{
    const margin::KnownSurface all = known(20);
    std::vector<Eigen::Index> every(static_cast<std::size_t>(all.candidates.cols()));
    std::iota(every.begin(), every.end(), 0);
    const surface::Griddata surface = surface::make_griddata(all.candidates, 9, all.angle);
    double min = 0, max = 0;
    for (Eigen::Index i = 0; i < all.true_heights.size(); ++i) {
        const double error = surface::height(surface, all.anomaly_places.col(i)) - all.true_heights[i];
        min = std::min(min, error);
        max = std::max(max, error);
    }
    EXPECT_NEAR(margin::griddata_band(all, 9)(every), max - min, 1e-12);
    EXPECT_TRUE(std::isinf(margin::griddata_band(all, 9)({0, 1, 2})));  // on a line
    EXPECT_TRUE(std::isinf(margin::griddata_band(all, 9)({0, 1, 20}))); // a corner of S only
    EXPECT_LT(margin::tensor_bspline_band(all)(every), margin::griddata_band(all, 9)(every));
}

TEST(HillClimb, BeatsTheStart)
{
    const margin::KnownSurface all = known(15, 8);
    const Eigen::Index count = all.candidates.cols();
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const sampling::HillClimbResult found =
            sampling::hill_climb(count, margin::griddata_band(all, 15), options(count / 2, seed));
        EXPECT_LT(found.error, found.start_error);
        EXPECT_DOUBLE_EQ(found.error, margin::griddata_band(all, 15)(found.chosen));
        EXPECT_EQ(static_cast<Eigen::Index>(found.chosen.size()), count / 2);
        EXPECT_TRUE(std::ranges::is_sorted(found.chosen));
        EXPECT_EQ(std::ranges::adjacent_find(found.chosen), found.chosen.end());
    }
}

// Sixteen that were searched for against the best of as many that were drawn.
TEST(HillClimb, BeatsDrawing)
{
    const margin::KnownSurface all = known(10, 8);
    const sampling::SubsetError band = margin::griddata_band(all, 12);
    const sampling::HillClimbResult found = sampling::hill_climb(all.candidates.cols(), band, options(16));
    std::mt19937_64 random(8);
    std::vector<Eigen::Index> places(static_cast<std::size_t>(all.candidates.cols()));
    std::iota(places.begin(), places.end(), 0);
    for (int draw = 0; draw < found.evaluations; ++draw) {
        std::vector<Eigen::Index> drawn;
        std::ranges::sample(places, std::back_inserter(drawn), 16, random);
        ASSERT_LT(found.error, band(drawn)) << draw;
    }
}

TEST(HillClimb, IsReproducibleAndFollowsTheSeed)
{
    const margin::KnownSurface all = known(15, 8);
    const auto climb = [&](std::uint64_t seed) {
        return sampling::hill_climb(all.candidates.cols(), margin::griddata_band(all, 15), options(10, seed));
    };
    EXPECT_EQ(climb(5).chosen, climb(5).chosen);
    EXPECT_EQ(climb(5).evaluations, climb(5).evaluations);
    EXPECT_NE(climb(5).chosen, climb(6).chosen);
}

/// All subsets of `size` out of `count`.
template <typename Visit>
void for_subsets(Eigen::Index count, Eigen::Index size, const Visit& visit)
{
    std::vector<bool> in(static_cast<std::size_t>(count), false);
    std::fill(in.begin(), in.begin() + size, true);
    do {
        std::vector<Eigen::Index> subset;
        for (Eigen::Index i = 0; i < count; ++i)
            if (in[static_cast<std::size_t>(i)]) subset.push_back(i);
        visit(subset);
    } while (std::prev_permutation(in.begin(), in.end()));
}

TEST(HillClimb, FindsTheOptimumOfFewCandidates)
{
    const margin::KnownSurface all = known(40, 6); // a lattice of 4 x 3 without the middle
    const Eigen::Index count = all.candidates.cols();
    ASSERT_EQ(count, 10);
    std::map<std::vector<Eigen::Index>, double> errors;
    double min = std::numeric_limits<double>::infinity();
    for_subsets(count, 6, [&](const std::vector<Eigen::Index>& subset) {
        min = std::min(min, errors[subset] = margin::griddata_band(all, 20)(subset));
    });
    ASSERT_EQ(errors.size(), 210U);
    ASSERT_TRUE(std::isfinite(min));
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
        sampling::HillClimbOptions settings = options(6, seed);
        settings.mutations = 100;
        settings.sharpness = 3;
        const sampling::HillClimbResult found = sampling::hill_climb(count, margin::griddata_band(all, 20), settings);
        EXPECT_DOUBLE_EQ(found.error, min) << seed;
        EXPECT_DOUBLE_EQ(errors.at(found.chosen), min);
    }
}

// Without a wanted number the discards end where each is refused; a tiny k discards nearly all.
TEST(HillClimb, LeavesAsFewAsTheSharpnessAllows)
{
    const margin::KnownSurface all = known(15);
    const auto left = [&](double sharpness) {
        sampling::HillClimbOptions settings = options(0);
        settings.mutations = 100;
        settings.sharpness = sharpness;
        return sampling::hill_climb(all.candidates.cols(), margin::griddata_band(all, 12), settings);
    };
    const sampling::HillClimbResult sharp = left(1e6), blunt = left(1);
    EXPECT_LT(blunt.chosen.size(), sharp.chosen.size());
    EXPECT_GT(blunt.error, sharp.error);
    EXPECT_LE(sharp.error, sharp.start_error * (1 + 1e-9));
}

TEST(HillClimb, RefusesWhatCannotBeChosen)
{
    const auto nothing = [](const std::vector<Eigen::Index>&) { return std::numeric_limits<double>::infinity(); };
    EXPECT_THROW(sampling::hill_climb(5, nothing, options(6)), core::InputError);
    EXPECT_THROW(sampling::hill_climb(9, nothing, options(6)), core::InputError);
}

TEST(HillClimb, RolesFollowTheNearerBoundary)
{
    Eigen::Matrix2Xd places(2, 2);
    places << 26, 59, 0, 0;
    const sampling::TouchPlan plan =
        sampling::make_touch_plan(job(), job::rotation_working_machine(job().theta).transpose() * places);
    EXPECT_EQ(plan.role[0], 1);
    EXPECT_EQ(plan.role[1], 2);
    EXPECT_EQ(plan.curve[0], -1);
}

} // namespace hillclimb_test
} // namespace fettle
