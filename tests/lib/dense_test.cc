#include "fit/dense.h"

#include "core/decompositions.h"
#include "core/error.h"
#include "fit/bspline.h"
#include "fit/cell_moments.h"
#include "fit/dense_start.h"
#include "fit/smoothing.h"
#include "surface/shapes.h"
#include "surface/spline_energy.h"
#include "json/document.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <random>

namespace fettle {
namespace dense_test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr double kHalfB = 20, kHalfS = 50; // mm

job::Job square_job(double theta = 0)
{
    job::Job job;
    job.theta = theta;
    const auto square = [](double half) {
        Eigen::Matrix3Xd corners(3, 4);
        corners << -half, half, half, -half, -half, -half, half, half, 0, 0, 0, 0;
        return corners;
    };
    job.anomaly = square(kHalfB);
    job.sampling = square(kHalfS);
    return job;
}

using Truth = double (*)(double x, double y);

double quadratic(double x, double y) { return 300 + 0.2 * x - 0.1 * y + 0.005 * x * x + 0.002 * x * y - 0.004 * y * y; }
double wavy(double x, double y) { return quadratic(x, y) + 0.5 * std::sin(x / 12) * std::cos(y / 15); }

/// A scan of the square S with noise of `sigma`; heights are doubles.
cloud::Cloud scan(std::size_t points, Truth truth, double sigma, unsigned seed = 1)
{
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-kHalfS, kHalfS);
    std::normal_distribution<double> noise(0, 1);
    cloud::Cloud cloud;
    cloud.xyz.resize(3, static_cast<Index>(points));
    for (Index i = 0; i < cloud.xyz.cols(); ++i) {
        const double x = place(random), y = place(random);
        cloud.xyz.col(i) << x, y, truth(x, y) + sigma * noise(random);
    }
    return cloud;
}

/// 5 mm of anomaly on the points inside B.
void lay_anomaly(cloud::Cloud& cloud)
{
    for (auto p : cloud.xyz.colwise())
        if (p.head<2>().cwiseAbs().maxCoeff() < kHalfB - 1) p.z() += 5;
}

fit::DenseFit fit(const cloud::Cloud& cloud, const job::Job& job = square_job())
{
    return fit::fit_dense(cloud::make_point_source(std::make_shared<cloud::Cloud>(cloud)), job, {}, "points");
}

struct Errors {
    double inside = 0, around = 0; ///< largest |error| within B and S \ B
    double z = 0;                  ///< rms of error over sigma, around
};

Errors errors(const surface::Surface& surface, Truth truth)
{
    Errors e;
    std::vector<Vector2d> places;
    for (double x = -49; x <= 49; x += 3.5)
        for (double y = -49; y <= 49; y += 3.5) places.emplace_back(x, y);
    Eigen::Matrix2Xd xy(2, static_cast<Index>(places.size()));
    for (std::size_t i = 0; i < places.size(); ++i) xy.col(static_cast<Index>(i)) = places[i];
    const VectorXd z = surface::heights(surface, xy), s = surface::sigmas(surface, xy);
    int around = 0;
    for (Index i = 0; i < xy.cols(); ++i) {
        const double error = z[i] - truth(xy(0, i), xy(1, i));
        const double from_middle = xy.col(i).cwiseAbs().maxCoeff();
        if (from_middle <= kHalfB) e.inside = std::max(e.inside, std::abs(error));
        if (from_middle <= kHalfB + 2) continue;
        e.around = std::max(e.around, std::abs(error));
        e.z += error * error / (s[i] * s[i]);
        ++around;
    }
    e.z = std::sqrt(e.z / around);
    return e;
}

// --- parts ---

surface::Bspline some_grid()
{
    surface::Bspline grid{0.3, {-40, -30}, {11, 9}, MatrixXd(9, 8)};
    for (Index i = 0; i < grid.heights.size(); ++i) grid.heights.data()[i] = std::sin(1.7 * static_cast<double>(i));
    return grid;
}

std::vector<fit::CellPoint> some_points(const surface::Bspline& grid, int count)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-0.5, 0.5);
    const auto cells = static_cast<int>((grid.heights.rows() - 3) * (grid.heights.cols() - 3));
    std::vector<fit::CellPoint> points;
    for (int i = 0; i < count; ++i)
        points.push_back({(i * 7) % cells, number(random), number(random), 10 * number(random)});
    return points;
}

Eigen::Matrix2Xd places(const surface::Bspline& grid, const std::vector<fit::CellPoint>& points)
{
    Eigen::Matrix2Xd xy(2, static_cast<Index>(points.size()));
    const Index cells_u = grid.heights.rows() - 3;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const fit::CellPoint& p = points[i];
        xy.col(static_cast<Index>(i)) =
            fit::machine_from_grid(grid, {static_cast<double>(p.cell % cells_u) + 0.5 + p.u,
                                          static_cast<double>(p.cell / cells_u) + 0.5 + p.v});
    }
    return xy;
}

TEST(CellMoments, PolynomialsAreTheSpline)
{
    const surface::Bspline grid = some_grid();
    const std::vector<fit::CellPoint> points = some_points(grid, 500);
    const Eigen::Matrix2Xd xy = places(grid, points);
    VectorXd r(500);
    fit::residuals(points, fit::cell_polynomials(grid), r.data());
    for (Index i = 0; i < 500; ++i)
        EXPECT_NEAR(r[i], points[static_cast<std::size_t>(i)].z - surface::height(grid, xy.col(i)), 1e-13);
}

// Reference: the sums over products of basis functions, point by point.
TEST(CellMoments, NormalEquationsAreTheSums)
{
    const surface::Bspline grid = some_grid();
    const std::vector<fit::CellPoint> points = some_points(grid, 500);
    const MatrixXd G = surface::height_gradients(grid, places(grid, points));
    const VectorXd w = VectorXd::LinSpaced(500, 0, 1), r = VectorXd::LinSpaced(500, -2, 3);
    fit::CellMoments first(grid), second(grid);
    first.add(std::span(points).first(200), r.data(), w.data());
    second.add(std::span(points).subspan(200), r.data() + 200, w.data() + 200);
    first.add(second);
    const MatrixXd ones = MatrixXd::Ones(6, 5);
    const MatrixXd expected = G * w.asDiagonal() * G.transpose();
    const surface::BandMatrix matrix = first.normal_matrix(grid, ones);
    for (Index i = 0; i < matrix.size(); ++i)
        for (Index j = std::max<Index>(0, i - matrix.half_bandwidth()); j <= i; ++j)
            EXPECT_NEAR(matrix(i, j), expected(i, j), 1e-12);
    EXPECT_LT((first.right_side(ones) - G * w.cwiseProduct(r)).norm(), 1e-12);
    EXPECT_NEAR(first.square_sum(ones), r.cwiseAbs2().dot(w), 1e-10);
    EXPECT_NEAR(first.weights().sum(), w.sum(), 1e-11);
    EXPECT_LT((first.right_side(2 * ones) - 2 * first.right_side(ones)).norm(), 1e-12);
}

// Reference: least squares by QR, the energy as rows of its root.
TEST(Smoothing, AgreesWithDenseLeastSquares)
{
    surface::Bspline grid = some_grid();
    grid.heights.setZero();
    const std::vector<fit::CellPoint> points = some_points(grid, 400);
    const MatrixXd G = surface::height_gradients(grid, places(grid, points));
    const VectorXd w = VectorXd::LinSpaced(400, 0.1, 1);
    VectorXd z(400);
    for (Index i = 0; i < 400; ++i) z[i] = points[static_cast<std::size_t>(i)].z;
    fit::CellMoments moments(grid);
    moments.add(points, z.data(), w.data());
    const MatrixXd ones = MatrixXd::Ones(6, 5);
    const fit::NormalEquations equations{moments.normal_matrix(grid, ones), moments.right_side(ones),
                                         moments.square_sum(ones), w.sum(), 0};
    const fit::SplineEnergy energy = fit::spline_energy_matrix(grid);
    MatrixXd K = MatrixXd::Zero(72, 72);
    for (Index i = 0; i < 72; ++i)
        for (Index j = std::max<Index>(0, i - energy.K.half_bandwidth()); j <= i; ++j)
            K(i, j) = K(j, i) = energy.K(i, j);
    const core::SymmetricEigen<Eigen::Dynamic> eigen = core::symmetric_eigen<Eigen::Dynamic>(K);
    const MatrixXd root = eigen.values.cwiseMax(0).cwiseSqrt().asDiagonal() * eigen.vectors.transpose();
    for (const double lambda : {1e-2, 10.0, 1e4}) {
        MatrixXd A(472, 72);
        A << w.cwiseSqrt().asDiagonal() * G.transpose(), std::sqrt(lambda) * root;
        VectorXd b = VectorXd::Zero(472);
        b.head(400) = w.cwiseSqrt().cwiseProduct(z);
        const VectorXd expected = core::least_squares_by_qr(A, b).x;
        const fit::SmoothedSpline result = fit::smooth_spline(equations, VectorXd::Zero(72), energy, lambda);
        EXPECT_LT((result.heights - expected).norm(), 1e-10 * expected.norm());
        EXPECT_NEAR(result.variance * (w.sum() - 6), (A * expected - b).squaredNorm(), 1e-9 * b.squaredNorm());
        // From any other heights the same is reached.
        const VectorXd other = VectorXd::LinSpaced(72, -1, 1);
        const VectorXd r = z - G.transpose() * other;
        fit::CellMoments again(grid);
        again.add(points, r.data(), w.data());
        const fit::NormalEquations shifted{again.normal_matrix(grid, ones), again.right_side(ones),
                                           again.square_sum(ones), w.sum(), 0};
        EXPECT_LT((fit::smooth_spline(shifted, other, energy, lambda).heights - expected).norm(),
                  1e-10 * expected.norm());
    }
}

// A field drawn with a known λ: the most likely one is near it. A factor 3 is 1.1 in ln λ; some hundred modes determine
// it to about 0.2.
TEST(Smoothing, LikelihoodFindsTheNoise)
{
    surface::Bspline grid{0, {0, 0}, {1, 1}, MatrixXd::Zero(19, 19)};
    const fit::SplineEnergy energy = fit::spline_energy_matrix(grid);
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    const double sigma = 0.2, tau = 0.7;
    surface::BandMatrix H = surface::zero_band_matrix(grid);
    H.add(energy.K, 1 / (tau * tau));
    surface::add_cell_weights(H, grid, MatrixXd::Constant(16, 16, 1e-6)); // the quadratics: some size
    MatrixXd dense = MatrixXd::Zero(H.size(), H.size());
    for (Index i = 0; i < H.size(); ++i)
        for (Index j = std::max<Index>(0, i - H.half_bandwidth()); j <= i; ++j) dense(i, j) = H(i, j);
    const MatrixXd L = dense.selfadjointView<Eigen::Lower>().llt().matrixL();
    VectorXd unit(H.size());
    for (double& x : unit) x = normal(random);
    grid.heights = L.transpose().triangularView<Eigen::Upper>().solve(unit).reshaped(19, 19);
    std::vector<fit::CellPoint> points = some_points(grid, 4000);
    VectorXd r(4000);
    for (fit::CellPoint& p : points) p.z = 0;
    fit::residuals(points, fit::cell_polynomials(grid), r.data());
    for (double& x : r) x = -x + sigma * normal(random);
    fit::CellMoments moments(grid);
    const VectorXd w = VectorXd::Ones(4000);
    moments.add(points, r.data(), w.data());
    const MatrixXd ones = MatrixXd::Ones(16, 16);
    const fit::SmoothedSpline result = fit::smooth_spline_by_likelihood(
        {moments.normal_matrix(grid, ones), moments.right_side(ones), moments.square_sum(ones), 4000, 0},
        VectorXd::Zero(361), energy, 0);
    EXPECT_NEAR(std::log(result.lambda), std::log(sigma * sigma / (tau * tau)), std::log(3.0));
    EXPECT_NEAR(std::sqrt(result.variance), sigma, 0.02 * sigma); // 1 / √(2 n) is 1.1 %
}

// --- the fit ---

// Reference: the formula. Heights are doubles, so only the arithmetic rounds: 1e-16 of 300 mm, some digits for the
// factorisation.
TEST(Dense, ReproducesQuadratics)
{
    for (const std::size_t points : {400, 20000}) {
        cloud::Cloud cloud = scan(points, quadratic, 0);
        lay_anomaly(cloud);
        const fit::DenseFit result = fit(cloud);
        EXPECT_TRUE(result.fit.converged);
        EXPECT_LT(errors(result.fit.surface, quadratic).around, 1e-8);
        EXPECT_LT(errors(result.fit.surface, quadratic).inside, 1e-8);
        EXPECT_EQ(result.counts.used + result.counts.anomaly, points);
    }
}

// A spline on the fit's own grid, seen by exact points with roles (nothing is left out). The smallest λ takes 1e-4 of
// what changes from cell to cell, and ever less of longer waves: these are 17 and 27 cells long.
TEST(Dense, ReproducesItsSplines)
{
    cloud::Cloud cloud = scan(60000, quadratic, 0);
    cloud::set_field(cloud, "role", VectorXd::Ones(60000));
    surface::Bspline spline = std::get<surface::Bspline>(fit(cloud).fit.surface.shape);
    for (Index j = 0; j < spline.heights.cols(); ++j)
        for (Index i = 0; i < spline.heights.rows(); ++i)
            spline.heights(i, j) = std::sin(0.37 * static_cast<double>(i)) * std::cos(0.23 * static_cast<double>(j));
    for (auto p : cloud.xyz.colwise()) p.z() = surface::height(spline, p.head<2>());
    const fit::DenseFit result = fit(cloud);
    double largest = 0;
    for (Index i = 0; i < 2000; ++i)
        largest = std::max(largest,
                           std::abs(surface::height(result.fit.surface, cloud.xyz.col(i).head<2>()) - cloud.xyz(2, i)));
    EXPECT_LT(largest, 1e-3);
}

// 0.05 mm of noise on some twenty points a cell. Four sigma of a few hundred places.
TEST(Dense, AveragesNoise)
{
    cloud::Cloud cloud = scan(80000, wavy, 0.05);
    lay_anomaly(cloud);
    const fit::DenseFit result = fit(cloud);
    const Errors e = errors(result.fit.surface, wavy);
    EXPECT_LT(e.around, 0.05);
    EXPECT_LT(e.inside, 0.1);
    EXPECT_GT(e.z, 0.3);
    EXPECT_LT(e.z, 1.3);
    EXPECT_NEAR(result.fit.surface.touch_sigma, 0.05, 0.001);
}

// One point in five is wrong by 1 to 10 mm, all to the same side, within B or not.
TEST(Dense, SurvivesOutliers)
{
    for (const std::size_t points : {1000, 80000}) {
        cloud::Cloud clean = scan(points, wavy, 0.05);
        lay_anomaly(clean);
        cloud::Cloud wrong = clean;
        std::mt19937 random(3);
        std::uniform_real_distribution<double> number(0, 1);
        std::size_t outliers = 0;
        for (auto p : wrong.xyz.colwise())
            if (number(random) < 0.2) {
                p.z() += 1 + 9 * number(random);
                outliers += p.head<2>().cwiseAbs().maxCoeff() > kHalfB;
            }
        const fit::DenseFit result = fit(wrong);
        const Errors with = errors(result.fit.surface, wavy), without = errors(fit(clean).fit.surface, wavy);
        EXPECT_LT(with.around, 2 * without.around) << points;
        EXPECT_LT(with.inside, 2 * without.inside + 0.05) << points;
        EXPECT_NEAR(result.fit.surface.touch_sigma, 0.05, points < 10000 ? 0.01 : 0.001);
        EXPECT_GE(result.outliers, outliers);
        EXPECT_LT(result.outliers, outliers + points / 100);
    }
}

// A patch that is a thousand times denser and 0.3 mm too high with a foot that no spline follows: it keeps its own
// cells and leaves the rest.
TEST(Dense, DensePatchDoesNotPullTheRest)
{
    cloud::Cloud cloud = scan(40000, wavy, 0.05);
    cloud::Cloud patch = scan(400000, wavy, 0.05, 2);
    patch.xyz.topRows<2>() = (patch.xyz.topRows<2>() * 0.08).colwise() + Vector2d(35, 35);
    for (auto p : patch.xyz.colwise()) p.z() = wavy(p.x(), p.y()) + 0.3;
    cloud::Cloud both;
    both.xyz.resize(3, 440000);
    both.xyz << cloud.xyz, patch.xyz;
    const surface::Surface alone = fit(cloud).fit.surface, together = fit(both).fit.surface;
    for (const Vector2d& xy : {Vector2d(-35, 35), Vector2d(35, -35), Vector2d(20, 35), Vector2d(35, 22)})
        EXPECT_NEAR(surface::height(together, xy), surface::height(alone, xy), 0.05) << xy.transpose();
    EXPECT_NEAR(surface::height(together, {0, 0}), surface::height(alone, {0, 0}),
                surface::sigma(alone, {0, 0})); // bridged
    EXPECT_NEAR(surface::height(together, {35, 35}), wavy(35, 35) + 0.3, 0.05);
}

TEST(Dense, LeavesOutAndCounts)
{
    cloud::Cloud cloud = scan(5000, wavy, 0.05);
    cloud.xyz(2, 3) = std::numeric_limits<double>::quiet_NaN();
    cloud.xyz(0, 4) = std::numeric_limits<double>::infinity();
    cloud.xyz.col(5) << 49, 49, 300;
    cloud.xyz.col(6) << 500, 0, 300;   // far outside S
    cloud.xyz.col(7) << 50.5, 0, 1e30; // just outside
    const fit::DenseFit result = fit(cloud);
    Index inside = 0;
    for (Index i = 8; i < 5000; ++i) inside += cloud.xyz.col(i).head<2>().cwiseAbs().maxCoeff() <= kHalfB;
    EXPECT_EQ(result.counts.undefined, 2u);
    EXPECT_EQ(result.counts.outside, 2u);
    EXPECT_NEAR(static_cast<double>(result.counts.anomaly), static_cast<double>(inside), 3);
    EXPECT_EQ(result.counts.used + result.counts.ignored(), 5000u);
    EXPECT_LT(errors(result.fit.surface, wavy).around, 0.15);
}

// Around a large anomaly, places with a spacing of half its size are too few for a margin: 9. They are closer.
TEST(Dense, IsCondensedToEnoughPlaces)
{
    job::Job job = square_job();
    job.anomaly.topRows<2>() *= 40 / kHalfB;
    const surface::Surface surface = fit(scan(6000, quadratic, 0.05), job).fit.surface;
    EXPECT_GE(surface.touches.cols(), 24);
    EXPECT_LE(surface.touches.cols(), 100);
    for (const auto& touch : surface.touches.colwise()) EXPECT_GT(touch.head<2>().cwiseAbs().maxCoeff(), 38);
    EXPECT_LT(errors(surface, quadratic).around, 0.1);
}

TEST(Dense, RolesSayWhatIsTaken)
{
    cloud::Cloud cloud = scan(4000, wavy, 0);
    VectorXd roles = VectorXd::Ones(4000);
    for (Index i = 0; i < 4000; i += 2) {
        roles[i] = i % 4 == 0 ? 3 : 0;
        cloud.xyz(2, i) += 7;
    }
    cloud::set_field(cloud, "role", roles);
    const fit::DenseFit result = fit(cloud);
    EXPECT_EQ(result.counts.other_role, 2000u);
    EXPECT_EQ(result.counts.used, 2000u); // wherever they lie
    EXPECT_LT(errors(result.fit.surface, wavy).inside, 0.01);
    roles[17] = 6;
    cloud::set_field(cloud, "role", roles);
    try {
        fit(cloud);
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_STREQ(error.what(), "points: point 17: 6 is not a role (0 to 5)");
    }
}

TEST(Dense, RefusesPointsThatDetermineNothing)
{
    const auto refusal = [](const cloud::Cloud& cloud) -> std::string {
        try {
            fit(cloud);
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "";
    };
    cloud::Cloud cloud = scan(1000, wavy, 0);
    cloud::Cloud nan = cloud;
    nan.xyz.row(2).setConstant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(refusal(nan), "points: a fit needs at least 6 touches, got 0 of 1000 points that it may use");
    cloud::Cloud line = cloud;
    line.xyz.row(1) = 0.3 * line.xyz.row(0);
    EXPECT_EQ(refusal(line), "points: touches lie on one line in x and y");
    cloud::Cloud cross = cloud;
    for (Index i = 0; i < 1000; ++i) cross.xyz(i % 2, i) = 0;
    EXPECT_NE(refusal(cross).find("conic section"), std::string::npos);
    cloud::Cloud anomaly = cloud;
    anomaly.xyz.topRows<2>() *= 0.3;
    EXPECT_NE(refusal(anomaly).find("none of the 1000 points lies inside the sampling boundary"), std::string::npos);
}

// Results are the same bytes for any number of threads.
TEST(Dense, ThreadsDoNotMatter)
{
    cloud::Cloud cloud = scan(200000, wavy, 0.05);
    const auto text = [&](int threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                        static_cast<std::size_t>(threads));
        return surface::to_json(fit(cloud).fit.surface).text();
    };
    const std::string one = text(1);
    EXPECT_EQ(text(2), one);
    EXPECT_EQ(text(3), one);
}

// The fit goes along when points and job are turned (with theta) and moved.
TEST(Dense, TurnedAndMoved)
{
    const cloud::Cloud cloud = scan(3000, wavy, 0.05);
    const double angle = 0.7;
    const Eigen::Rotation2Dd turn(angle);
    const Eigen::Vector3d shift(400, -250, 30);
    const auto moved = [&](Eigen::Matrix3Xd points) {
        points.topRows<2>() = turn.toRotationMatrix() * points.topRows<2>();
        points.colwise() += shift;
        return points;
    };
    cloud::Cloud there = cloud;
    there.xyz = moved(cloud.xyz);
    job::Job job = square_job(angle);
    job.anomaly = moved(job.anomaly);
    job.sampling = moved(job.sampling);
    const surface::Surface a = fit(cloud).fit.surface, b = fit(there, job).fit.surface;
    for (const Vector2d& xy : {Vector2d(0, 0), Vector2d(30, -25), Vector2d(-10, 45)}) {
        const Vector2d place = turn * xy + shift.head<2>();
        EXPECT_NEAR(surface::height(b, place) - shift.z(), surface::height(a, xy), 1e-6);
        // The prior of τ rests on the touched length along the axes of M.
        EXPECT_NEAR(surface::sigma(b, place), surface::sigma(a, xy), 0.01 * surface::sigma(a, xy));
    }
}

// About as many touches as either takes: the two differ by less than their sigma.
TEST(Dense, AgreesWithTheExactPosteriorAtTheSwitch)
{
    cloud::Cloud cloud = scan(700, wavy, 0.05);
    std::vector<Index> around;
    for (Index i = 0; i < cloud.size() && around.size() < fit::kMaxExactTouches; ++i)
        if (cloud.xyz.col(i).head<2>().cwiseAbs().maxCoeff() > kHalfB) around.push_back(i);
    ASSERT_EQ(around.size(), fit::kMaxExactTouches);
    cloud = cloud::select_points(cloud, around);
    fit::FitInput input;
    input.job = square_job();
    input.xyz = cloud.xyz;
    input.roles = Eigen::VectorXi::Ones(cloud.size());
    const surface::Surface exact = fit::fit_bspline(input).surface;
    ASSERT_EQ(exact.touches.cols(), cloud.size()); // it was the exact one
    cloud::set_field(cloud, "role", VectorXd::Ones(cloud.size()));
    const surface::Surface dense = fit(cloud).fit.surface;
    for (double x = -45; x <= 45; x += 9)
        for (double y = -45; y <= 45; y += 9) {
            const Vector2d xy(x, y);
            EXPECT_LT(std::abs(surface::height(dense, xy) - surface::height(exact, xy)), 2 * surface::sigma(exact, xy))
                << xy.transpose();
            EXPECT_GT(surface::sigma(dense, xy), surface::sigma(exact, xy) / 2) << xy.transpose();
        }
}

// More touches than the exact posterior takes take the same path in fit_surface().
TEST(Dense, IsPartOfTheMethod)
{
    const cloud::Cloud cloud = scan(fit::kMaxExactTouches + 1, wavy, 0.05);
    fit::FitInput input;
    input.job = square_job();
    input.xyz = cloud.xyz;
    input.roles = Eigen::VectorXi::Ones(cloud.size());
    const surface::Surface surface = fit::fit_surface(input, "bspline").surface;
    EXPECT_TRUE(surface.precision);
    EXPECT_EQ(surface.covariance.size(), 0);
}

} // namespace dense_test
} // namespace fettle
