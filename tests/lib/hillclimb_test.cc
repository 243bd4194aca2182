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
namespace {

double truth(double x, double y) { return 0.01 * x * x - 0.006 * x * y + 4 * std::sin(y / 25) + 0.3 * x; }

/// A 50 x 50 mm anomaly amid a sampling boundary of 120 x 100 mm, turned.
Job job()
{
    Job result;
    result.theta = 0.4;
    result.anomaly.resize(3, 4);
    result.anomaly << -25, 25, 25, -25, -25, -25, 25, 25, 0, 0, 0, 0;
    result.sampling.resize(3, 4);
    result.sampling << -60, 60, 60, -60, -50, -50, 50, 50, 0, 0, 0, 0;
    for (Eigen::Matrix3Xd* points : {&result.anomaly, &result.sampling})
        points->topRows<2>() = rotation_working_machine(result.theta).transpose() * points->topRows<2>();
    return result;
}

Eigen::VectorXd truth_at(const Eigen::Matrix2Xd& xy)
{
    Eigen::VectorXd z(xy.cols());
    for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = truth(xy(0, i), xy(1, i));
    return z;
}

KnownSurface known(double spacing, int across = 12)
{
    KnownSurface result;
    const Eigen::Matrix2Xd candidates = candidate_touches(job(), spacing);
    result.candidates.resize(3, candidates.cols());
    result.candidates << candidates, truth_at(candidates).transpose();
    result.always.resize(3, 0);
    result.inside = anomaly_grid(job(), across);
    result.truth = truth_at(result.inside);
    result.angle = job().theta;
    return result;
}

HillClimb options(Eigen::Index touches, std::uint64_t seed = 1)
{
    HillClimb result;
    result.touches = touches;
    result.mutations = 30;
    result.sharpness = 50;
    result.seed = seed;
    return result;
}

TEST(Candidates, LieOnGoodMetalInsideTheSamplingBoundary)
{
    const Boundaries both = boundaries(job());
    for (const double spacing : {0.0, 7.3, 5.0}) {
        const Eigen::Matrix2Xd places = rotation_working_machine(job().theta) * candidate_touches(job(), spacing);
        for (const Eigen::Vector2d& place : places.colwise()) {
            EXPECT_TRUE(contains(both.sampling, place) || distance_to_edge(both.sampling, place) < 1e-9);
            EXPECT_TRUE(!contains(both.anomaly, place) || distance_to_edge(both.anomaly, place) < 1e-9);
        }
    }
    EXPECT_NEAR(static_cast<double>(candidate_touches(job(), 0).cols()), kCandidates, 0.1 * kCandidates);
    // a lattice of 25 x 21 places without the 9 x 9 inside B: its edge counts as good metal
    EXPECT_EQ(candidate_touches(job(), 5).cols(), 25 * 21 - 9 * 9);
    EXPECT_THROW(candidate_touches(job(), 0.1), InputError);
}

// Griddata's fast heights are those of the surface.
TEST(KnownBand, IsTheBandOfTheSurface)
{
    const KnownSurface all = known(20);
    std::vector<Eigen::Index> every(static_cast<std::size_t>(all.candidates.cols()));
    std::iota(every.begin(), every.end(), 0);
    const Griddata surface = make_griddata(all.candidates, 9, all.angle);
    double least = 0, most = 0;
    for (Eigen::Index i = 0; i < all.truth.size(); ++i) {
        const double error = height(surface, all.inside.col(i)) - all.truth[i];
        least = std::min(least, error);
        most = std::max(most, error);
    }
    EXPECT_NEAR(griddata_band(all, 9)(every), most - least, 1e-12);
    EXPECT_TRUE(std::isinf(griddata_band(all, 9)({0, 1, 2})));  // on a line
    EXPECT_TRUE(std::isinf(griddata_band(all, 9)({0, 1, 20}))); // a corner of S only
    EXPECT_LT(tensor_bspline_band(all)(every), griddata_band(all, 9)(every));
}

TEST(HillClimb, BeatsTheStart)
{
    const KnownSurface all = known(15, 8);
    const Eigen::Index count = all.candidates.cols();
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const HillClimbed found = hill_climb(count, griddata_band(all, 15), options(count / 2, seed));
        EXPECT_LT(found.error, found.start_error);
        EXPECT_DOUBLE_EQ(found.error, griddata_band(all, 15)(found.chosen));
        EXPECT_EQ(static_cast<Eigen::Index>(found.chosen.size()), count / 2);
        EXPECT_TRUE(std::ranges::is_sorted(found.chosen));
        EXPECT_EQ(std::ranges::adjacent_find(found.chosen), found.chosen.end());
    }
}

// Sixteen that were searched for against the best of as many that were drawn.
TEST(HillClimb, BeatsDrawing)
{
    const KnownSurface all = known(10, 8);
    const SubsetError band = griddata_band(all, 12);
    const HillClimbed found = hill_climb(all.candidates.cols(), band, options(16));
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
    const KnownSurface all = known(15, 8);
    const auto climb = [&](std::uint64_t seed) {
        return hill_climb(all.candidates.cols(), griddata_band(all, 15), options(10, seed));
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
    const KnownSurface all = known(40, 6); // a lattice of 4 x 3 without the middle
    const Eigen::Index count = all.candidates.cols();
    ASSERT_EQ(count, 10);
    std::map<std::vector<Eigen::Index>, double> errors;
    double least = std::numeric_limits<double>::infinity();
    for_subsets(count, 6, [&](const std::vector<Eigen::Index>& subset) {
        least = std::min(least, errors[subset] = griddata_band(all, 20)(subset));
    });
    ASSERT_EQ(errors.size(), 210U);
    ASSERT_TRUE(std::isfinite(least));
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
        HillClimb settings = options(6, seed);
        settings.mutations = 100;
        settings.sharpness = 3;
        const HillClimbed found = hill_climb(count, griddata_band(all, 20), settings);
        EXPECT_DOUBLE_EQ(found.error, least) << seed;
        EXPECT_DOUBLE_EQ(errors.at(found.chosen), least);
    }
}

// Without a wanted number the discards end where each is refused; a tiny k discards nearly all.
TEST(HillClimb, LeavesAsFewAsTheSharpnessAllows)
{
    const KnownSurface all = known(15);
    const auto left = [&](double sharpness) {
        HillClimb settings = options(0);
        settings.mutations = 100;
        settings.sharpness = sharpness;
        return hill_climb(all.candidates.cols(), griddata_band(all, 12), settings);
    };
    const HillClimbed sharp = left(1e6), blunt = left(1);
    EXPECT_LT(blunt.chosen.size(), sharp.chosen.size());
    EXPECT_GT(blunt.error, sharp.error);
    EXPECT_LE(sharp.error, sharp.start_error * (1 + 1e-9));
}

TEST(HillClimb, RefusesWhatCannotBeChosen)
{
    const auto nothing = [](const std::vector<Eigen::Index>&) { return std::numeric_limits<double>::infinity(); };
    EXPECT_THROW(hill_climb(5, nothing, options(6)), InputError);
    EXPECT_THROW(hill_climb(9, nothing, options(6)), InputError);
}

TEST(HillClimb, RolesFollowTheNearerBoundary)
{
    Eigen::Matrix2Xd places(2, 2);
    places << 26, 59, 0, 0;
    const TouchPlan plan = plan_of(job(), rotation_working_machine(job().theta).transpose() * places);
    EXPECT_EQ(plan.role[0], 1);
    EXPECT_EQ(plan.role[1], 2);
    EXPECT_EQ(plan.curve[0], -1);
}

} // namespace
} // namespace fettle
