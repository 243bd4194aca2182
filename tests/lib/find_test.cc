#include "find/background.h"
#include "find/doubtful.h"
#include "find/earlier.h"
#include "find/find.h"
#include "find/flat_top.h"
#include "find/image.h"
#include "find/job_outlines.h"
#include "find/outline.h"
#include "find/ring_fit.h"
#include "find/slow_field.h"
#include "find/verification.h"
#include "find/view.h"

#include "core/error.h"
#include "geometry/uniform_draws.h"
#include "job/open_side.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace fettle::find {
namespace find_test {

Image quadratic(int rows, int columns)
{
    Image z(rows, columns);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) z(y, x) = float(1 + 0.02 * x - 0.01 * y + 1e-3 * x * x - 5e-4 * x * y);
    return z;
}

TEST(Image, NoiseOfASlopeIsZero)
{
    Image z(20, 20);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x) z(y, x) = float(x) / 4 + float(y) / 8;
    EXPECT_NEAR(noise_sigma(z), 0, 1e-6);
}

TEST(Image, TheOutlineIsThatOfTheLargestComponent)
{
    Mask mask(20, 20, uchar(0));
    EXPECT_TRUE(simplified_outline(mask, 0.5).empty());
    mask(cv::Rect(1, 1, 3, 3)) = 255;
    mask(cv::Rect(6, 5, 10, 8)) = 255;
    mask(cv::Rect(2, 16, 4, 2)) = 255;
    const std::vector<cv::Point> outline = simplified_outline(mask, 0.5);
    EXPECT_EQ(outline.size(), 4u);
    EXPECT_EQ(cv::boundingRect(outline), cv::Rect(6, 5, 10, 8));
}

TEST(Image, DistancesAndHolesAreExact)
{
    Mask mask(9, 9, uchar(0));
    for (int i = 2; i <= 6; ++i) mask(2, i) = mask(6, i) = mask(i, 2) = mask(i, 6) = 255;
    EXPECT_EQ(cv::countNonZero(mask), 16);
    EXPECT_EQ(cv::countNonZero(with_holes_filled(mask)), 25);
    EXPECT_FLOAT_EQ(distance_to(mask)(0, 0), std::sqrt(8.F));
    EXPECT_FLOAT_EQ(depth_of(with_holes_filled(mask))(4, 4), 3);
    EXPECT_FLOAT_EQ(depth_of(Mask(5, 5, uchar(255)))(2, 2), 3); // beyond the image is nothing
}

TEST(Image, GapsGetTheNearestValue)
{
    Image z = quadratic(9, 9);
    z(4, 4) = std::numeric_limits<float>::quiet_NaN();
    z.row(0).setTo(std::numeric_limits<float>::quiet_NaN());
    const Image whole = filled(z);
    EXPECT_EQ(cv::countNonZero(finite(whole)), 81);
    for (int x = 0; x < 9; ++x) EXPECT_EQ(whole(0, x), z(1, x));
    HeightMap map{z, 1, {0, 0}, {}, 0};
    clean(map, true);
    EXPECT_NEAR(map.z(4, 4), quadratic(9, 9)(4, 4), 0.02); // the median of the cells around
    EXPECT_TRUE(map.seen(4, 4));
}

// Two sheets of scattered points, one 30 mm beneath the other, and a wall that puts as many points on a line: the cell
// follows the density of the upper sheet, 8 points a mm², and nothing of the lower one shows, in whatever cell no point
// of the upper one falls.
TEST(View, FarSideOfABodyDoesNotShow)
{
    std::mt19937 random(4);
    std::uniform_real_distribution<double> draw;
    mesh::CloudMesh part;
    part.points.xyz.resize(3, 60000);
    for (Eigen::Index i = 0; i < 60000; ++i)
        part.points.xyz.col(i) << 50 * draw(random), (i < 40000 ? 50 * draw(random) : 0),
            (i < 20000   ? 30
             : i < 40000 ? 0
                         : 30 * draw(random));
    HeightMap map = height_map(part, View::Identity());
    EXPECT_GT(map.cell, 0.35); // 1 point a cell
    EXPECT_LT(map.cell, 0.7);  // 4
    double min = 0, max = 0;
    cv::minMaxLoc(map.z.rowRange(1, map.z.rows), &min, &max, nullptr, nullptr, finite(map.z.rowRange(1, map.z.rows)));
    EXPECT_EQ(min, 30);
    clean(map, true);
    EXPECT_GT(cv::countNonZero(map.seen), 0.98 * double(map.z.total()));
}

// A filter of order 2 reproduces quadratics; 1e-3 of it is the ridge's share.
TEST(Background, RegressionFilterReproducesQuadratics)
{
    const Image z = quadratic(60, 80);
    const Image surface = regression_filter(z, Mask(z.size(), uchar(255)), 1e-3, 5);
    for (int y = 10; y < 50; ++y)
        for (int x = 10; x < 70; ++x) EXPECT_NEAR(surface(y, x), z(y, x), 5e-3);
}

// An opening passes beneath a narrow wall. The ball of radius 48 rises into its foot, which smoothing has made some 8
// cells wide, by 4² / 96.
TEST(Background, OpeningPassesBeneath)
{
    Image z(60, 60, 2.F);
    for (int y = 0; y < 60; ++y) z(y, 30) = z(y, 31) = 5;
    const Image opened = ball_opening(z, 1, 16);
    EXPECT_NEAR(opened(30, 30), 2, 0.2);
    EXPECT_NEAR(opened(30, 10), 2, 0.1);
}

// A cubic is among the polynomials; a third of the ring that falls off is left out.
TEST(RingFit, ReproducesACubicBesideAnEdge)
{
    std::vector<Eigen::Vector3d> points;
    const auto surface = [](double x, double y) { return 0.1 * x - 0.002 * x * x + 1e-4 * y * y * x; };
    for (int y = -20; y <= 20; ++y)
        for (int x = -20; x <= 20; ++x)
            if (const double r = std::hypot(x, y); r > 9 && r < 20)
                points.emplace_back(x, y, surface(x, y) - (x > 14 ? 5 : 0));
    RingPoints ring{Eigen::Matrix2Xd(2, points.size()), Eigen::VectorXd(points.size()),
                    Eigen::VectorXd::Ones(points.size())};
    for (std::size_t i = 0; i < points.size(); ++i) {
        ring.xy.col(Eigen::Index(i)) = points[i].head<2>();
        ring.z[Eigen::Index(i)] = points[i].z();
    }
    const auto fit = fit_ring(ring, 1e-3, 4);
    ASSERT_TRUE(fit);
    for (int x = -8; x <= 8; x += 4) EXPECT_NEAR(fit->z_at(x, 3), surface(x, 3), 2e-3);
    std::vector<float> sds(7); // at the centroid the polynomial is its constant term
    fit->sd_row(fit->centre.x() - 3 * 2.5, fit->centre.y(), 2.5, sds);
    EXPECT_NEAR(sds[3], std::sqrt(fit->covariance(0, 0)), 1e-6 * sds[3]);
    EXPECT_GT(sds[0], 0);
    EXPECT_FALSE(fit_ring({Eigen::Matrix2Xd(2, 0), Eigen::VectorXd(0), Eigen::VectorXd(0)}, 1, 4));
}

// A roof with a curved ridge line's heights, seen askew: quadratics on both sides of a line. Smooth polynomials cut its
// ridge off by a millimetre.
TEST(RingFit, FollowsARidgeBeneathTheRegion)
{
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0, 0.02);
    const auto surface = [](double x, double y) {
        const double across = 0.6 * y - 0.8 * x + 2, along = 0.8 * y + 0.6 * x;
        return 0.05 * along - 0.003 * along * along + 0.1 * across - 0.5 * std::max(0.0, across);
    };
    std::vector<Eigen::Vector3d> points;
    for (int y = -20; y <= 20; ++y)
        for (int x = -20; x <= 20; ++x)
            if (const double r = std::hypot(x, y); r > 9 && r < 20)
                points.emplace_back(x, y, surface(x, y) + noise(random));
    RingPoints ring{Eigen::Matrix2Xd(2, points.size()), Eigen::VectorXd(points.size()),
                    Eigen::VectorXd::Ones(points.size())};
    for (std::size_t i = 0; i < points.size(); ++i) {
        ring.xy.col(Eigen::Index(i)) = points[i].head<2>();
        ring.z[Eigen::Index(i)] = points[i].z();
    }
    const auto error = [&](const RingFit& fit) {
        double max = 0;
        for (int y = -8; y <= 8; y += 2)
            for (int x = -8; x <= 8; x += 2) max = std::max(max, std::abs(fit.z_at(x, y) - surface(x, y)));
        return max;
    };
    const auto smooth = fit_ring(ring, 0.02, 4), creased = fit_ring(ring, 0.02, 4, {true, {}, 0.27, 1.7});
    ASSERT_TRUE(smooth && creased && creased->crease);
    EXPECT_GT(error(*smooth), 0.5);
    EXPECT_LT(error(*creased), 0.1);
    const Crease line = *creased->crease_in_place();
    EXPECT_NEAR(std::abs(line.across.dot(Eigen::Vector2d(-0.8, 0.6))), 1, 0.01);
    EXPECT_NEAR(std::abs(line.offset), 2, 0.4);
    std::vector<float> row(41, 0.F);
    creased->add_row(-20, 3, 1, row);
    for (int k = 0; k < 41; ++k) EXPECT_NEAR(row[std::size_t(k)], creased->z_at(k - 20, 3), 1e-5);
    std::vector<float> sds(9), sd(1); // four places at a time: the same as one by one
    creased->sd_row(-20, 3, 5, sds);
    for (int k = 0; k < 9; ++k) {
        creased->sd_row(-20 + 5 * k, 3, 1, sd);
        EXPECT_EQ(sd[0], sds[std::size_t(k)]);
    }
    EXPECT_FALSE(fit_ring(ring, 0.02, 4, {true, {}, 0.6, 1.7})->crease); // it bends by 0.5
    EXPECT_FALSE(smooth->crease);
}

TEST(Outline, SurroundsTheRegionAndKeepsToTheMap)
{
    HeightMap map{Image(100, 100, 0.F), 1, {0, 0}, Mask(100, 100, uchar(255)), 0.1};
    Mask region(100, 100, uchar(0));
    region(cv::Rect(40, 40, 20, 12)) = 255;
    const Outlines outlines = outlines_of(map, region, Mask(100, 100, uchar(0)), 0);
    EXPECT_LT(outlines.boundary.row(0).minCoeff(), 38);
    EXPECT_GT(outlines.boundary.row(0).maxCoeff(), 61);
    EXPECT_LT(outlines.sampling.row(1).minCoeff(), outlines.boundary.row(1).minCoeff() - 3);
    EXPECT_GE(outlines.sampling.minCoeff(), 0);
}

// A square whose side at x = 20 is open: its three other sides, 60 mm, take the corners, and its outline stays.
TEST(Outline, GetsCornersWhereThereIsMetal)
{
    const Eigen::Matrix2Xd boundary{{0, 20, 20, 0}, {0, 0, 20, 20}}, sampling{{-9, 20, 20, -9}, {-9, -9, 29, 29}};
    for (const int count : {4, 12, 24, 32}) {
        const Eigen::Matrix2Xd more = with_more_corners(boundary, sampling, count, 0.1);
        const auto on_metal = job::corners_on_metal(more, sampling).size();
        EXPECT_GE(on_metal, std::size_t(count));
        EXPECT_LE(on_metal, std::size_t(count) + 3);       // each side has equal pieces
        EXPECT_EQ(std::size_t(more.cols()), on_metal + 2); // none but B's own at the open side
        double area = 0;
        for (Eigen::Index k = 0; k < more.cols(); ++k) {
            const Eigen::Vector2d from = more.col(k), to = more.col((k + 1) % more.cols());
            area += (from.x() * to.y() - to.x() * from.y()) / 2;
            EXPECT_TRUE((from.x() == 20 && to.x() == 20) || (to - from).norm() <= 60.0 / count * 1.4);
        }
        EXPECT_NEAR(area, 400, 1e-9);
    }
    EXPECT_EQ(with_more_corners(boundary, {}, 4, 0.1), boundary); // it has them
    EXPECT_LE(with_more_corners(boundary, {}, 1000, 5).cols(), 4 * 4);
}

// A foot that was measured replaces the one that B allows for; it is not added to it.
TEST(Outline, GoesBeyondAMeasuredFoot)
{
    HeightMap map{Image(100, 100, 0.F), 1, {0, 0}, Mask(100, 100, uchar(255)), 0.1};
    Mask region(100, 100, uchar(0));
    region(cv::Rect(40, 40, 20, 12)) = 255;
    const auto width = [&](int foot) {
        const Eigen::Matrix2Xd boundary = outlines_of(map, region, Mask(100, 100, uchar(0)), foot).boundary;
        return boundary.row(0).maxCoeff() - boundary.row(0).minCoeff();
    };
    EXPECT_NEAR(width(1), width(0), 1e-9);
    for (const int foot : {3, 4, 6}) {
        EXPECT_GE(width(foot), 20 + 2 * foot);
        EXPECT_LE(width(foot), 20 + 2 * (foot + 2.2));
    }
}

// A bead 120 cells long on a saddle, of which the candidate has the first 50: its window ends 28 cells beyond these.
TEST(Find, RegionsGrowBeyondTheirWindow)
{
    HeightMap map{Image(80, 200, 0.F), 1, {0, 0}, Mask(80, 200, uchar(255)), 0.02};
    Mask bead(80, 200, uchar(0));
    bead(cv::Rect(40, 36, 120, 8)) = 255;
    std::mt19937_64 random(1);
    for (int y = 0; y < 80; ++y)
        for (int x = 0; x < 200; ++x)
            map.z(y, x) = float(1e-4 * (x - 100) * (x - 100) - 2e-4 * (y - 40) * (y - 40) + 3 * (bead(y, x) > 0) +
                                geometry::draw_normal(random, 0.02));
    Candidate end{cv::Rect(40, 36, 50, 8), Mask(8, 50, uchar(255)), 10, 400, 0.02};
    const std::vector<Verified> verified = verify_all(map, {end}, {});
    ASSERT_EQ(verified.size(), 1u);
    Mask found(80, 200, uchar(0));
    verified[0].mask.copyTo(found(verified[0].window));
    EXPECT_EQ(cv::countNonZero(found & bead), cv::countNonZero(bead));
    EXPECT_LE(cv::countNonZero(found), 122 * 10); // smoothing raises a cell beside a wall
}

// Doubtful finds beside a find lower its probability, but not itself, nor the same again at one place.
TEST(Find, DoubtfulOthersCount)
{
    const auto find_at = [](int x, double score) {
        Verified find;
        find.window = cv::Rect(x, 0, 10, 10);
        find.mask = Mask(10, 10, uchar(255));
        find.score = score;
        return find;
    };
    std::vector<Verified> finds = {find_at(0, 1), find_at(100, -2), find_at(102, -2.5), find_at(200, -3),
                                   find_at(300, -9)};
    set_probabilities(finds);
    EXPECT_EQ(finds[0].doubtful_others, 2);
    EXPECT_EQ(finds[1].doubtful_others, 1);
    EXPECT_EQ(finds[2].doubtful_others, 1);
    EXPECT_EQ(finds[3].doubtful_others, 1);
    EXPECT_EQ(finds[4].doubtful_others, 2);
    EXPECT_EQ(finds[0].probability, probability_of(1, 2));
    EXPECT_LT(probability_of(1, 2), probability_of(1, 0));
    EXPECT_LT(probability_of(0.9, 2), probability_of(1, 2));
}

// Flat tops of one height and about one size are a pattern by design; domes of one height are none, nor is a flat top
// of another height.
TEST(Find, FlatTopsOfOneHeightAreAPattern)
{
    const auto find_at = [](int x, double height, double dome) {
        Verified find;
        find.window = cv::Rect(x, 0, 9, 9);
        find.mask = Mask(9, 9, uchar(255));
        find.height = Image(9, 9);
        for (int i = 0; i < 9; ++i)
            for (int k = 0; k < 9; ++k) find.height(i, k) = float(height - dome * std::hypot(i - 4, k - 4));
        find.evidence.height = height;
        find.evidence.cells = 81;
        find.evidence.noise = 0.02;
        find.evidence.top_departure = measure_top(find.mask, find.height, find.height).departure;
        find.score = 4;
        return find;
    };
    std::vector<Verified> finds = {find_at(0, 5, 0),   find_at(100, 5.05, 0), find_at(200, 4.96, 0),
                                   find_at(300, 5, 1), find_at(400, 5, 1),    find_at(500, 7, 0)};
    set_probabilities(finds);
    for (const int k : {0, 1, 2}) EXPECT_EQ(finds[std::size_t(k)].alike, 2);
    for (const int k : {3, 4, 5}) EXPECT_EQ(finds[std::size_t(k)].alike, 0);
    EXPECT_LT(finds[0].probability, finds[5].probability); // others alike tell more than the flat top alone
    EXPECT_LT(finds[5].probability, 0.8);
    EXPECT_EQ(finds[3].probability, probability_of(4, finds[3].doubtful_others));
    for (const Verified& find : finds) EXPECT_EQ(find.probability_by_evidence, probability_of(4, find.doubtful_others));
}

// A tilted plane with a hole and walls around is flat on top, and so are strokes two cells wide; a dome is not.
TEST(Find, DepartureOfTopsFromAPlane)
{
    const Mask square(20, 20, uchar(255));
    Image pad(20, 20), dome(20, 20);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x) {
            const double r = std::hypot(x - 9.5, y - 9.5);
            pad(y, x) = std::max(std::abs(x - 9.5), std::abs(y - 9.5)) > 8 ? 0.5F : float(r < 2 ? 0.2 : 3 + 0.05 * x);
            dome(y, x) = float(3 - 0.01 * r * r);
        }
    EXPECT_LT(measure_top(square, pad, pad).departure, 1e-5);
    EXPECT_GT(measure_top(square, dome, dome).departure, 0.1);
    Mask stroke(20, 20, uchar(0));
    stroke(cv::Rect(2, 2, 2, 15)).setTo(255);
    stroke(cv::Rect(2, 15, 12, 2)).setTo(255);
    EXPECT_LT(measure_top(stroke, Image(20, 20, 1.F), Image(20, 20, 1.F)).departure, 1e-5);
    EXPECT_LT(measure_top(stroke, Image(20, 20, 1.F), pad).slope, 1e-9); // parallel to the surface beneath, which leans
    EXPECT_EQ(measure_top(Mask(20, 20, uchar(0)), pad, pad).departure, std::numeric_limits<double>::infinity());
}

TEST(Find, FlatTopsTakeFromTheScore)
{
    Evidence evidence;
    evidence.height = 3;
    evidence.noise = 0.02;
    EXPECT_EQ(flat_top_score(evidence), 0); // not measured
    evidence.top_departure = 0.3;
    EXPECT_EQ(flat_top_score(evidence), 0);
    evidence.top_departure = 0.1;
    const double flat = flat_top_score(evidence);
    EXPECT_GT(flat, 0);
    evidence.top_departure = 0.03;
    EXPECT_GT(flat_top_score(evidence), flat);
    const double level = flat_top_score(evidence);
    evidence.top_rise = 0.2; // a stub's, sawn off
    EXPECT_LT(flat_top_score(evidence), level);
    EXPECT_GT(flat_top_score(evidence), 0);
    evidence.noise = 0.3; // which hides how flat it is
    EXPECT_EQ(flat_top_score(evidence), 0);
}

TEST(Find, PartsWithoutSurfaceAreRefused)
{
    mesh::CloudMesh part;
    part.points.xyz = Eigen::Matrix3Xd::Constant(3, 10, std::nan(""));
    EXPECT_THROW(find_anomalies(part), core::InputError);
}

TEST(Find, PersonsWordsCount)
{
    FindResult result;
    result.anomalies.resize(3);
    for (int k = 0; k < 3; ++k)
        result.anomalies[std::size_t(k)].number = k + 1, result.anomalies[std::size_t(k)].doubt = "?";
    EXPECT_THROW(judge(result, {4}, {}), core::InputError);
    EXPECT_THROW(judge(result, {1}, {1}), core::InputError);
    judge(result, {3}, {1});
    ASSERT_EQ(result.anomalies.size(), 2);
    EXPECT_EQ(result.anomalies[0].number, 2);
    EXPECT_EQ(result.anomalies[0].doubt, "?");
    EXPECT_EQ(result.anomalies[1].doubt, "");
}

// An anomaly in two parts within one earlier B is one row, with the points and volume of both and that job's B.
TEST(MatchEarlier, OneRowForWhatOneBoundaryEncloses)
{
    mesh::CloudMesh part;
    part.points.xyz.resize(3, 4);
    part.points.xyz << 1, 2, 3, 50, 1, 1, 1, 50, 0, 0, 0, 0;
    FindResult result;
    result.anomalies.resize(3);
    const auto found = [&](std::size_t k, std::vector<Eigen::Index> points, Eigen::VectorXd heights, double volume) {
        FoundAnomaly& one = result.anomalies[k];
        one.points = std::move(points);
        one.heights = std::move(heights);
        one.height = one.heights.maxCoeff();
        one.volume = one.area = volume;
        one.probability = 0.9;
        one.doubt = "?";
    };
    found(0, {0, 2}, Eigen::Vector2d(0.5, 0.7), 3);
    found(1, {1}, Eigen::VectorXd::Constant(1, 0.9), 2);
    found(2, {3}, Eigen::VectorXd::Constant(1, 0.4), 1);
    EarlierJob earlier;
    earlier.file = "jobs/1.json";
    earlier.job.anomaly.resize(3, 4);
    earlier.job.anomaly << 0, 5, 5, 0, 0, 0, 5, 5, 0, 0, 0, 0;
    earlier.job.sampling = 2 * earlier.job.anomaly.array() - 2;
    match_earlier(result, part, {earlier}, Eigen::Isometry3d::Identity(), 0.95);
    ASSERT_EQ(result.anomalies.size(), 1); // the third is nobody's, and not probable enough
    const FoundAnomaly& row = result.anomalies[0];
    EXPECT_EQ(row.points, (std::vector<Eigen::Index>{0, 1, 2}));
    EXPECT_EQ(row.heights, Eigen::Vector3d(0.5, 0.9, 0.7));
    EXPECT_EQ(row.height, 0.9);
    EXPECT_EQ(row.volume, 5);
    EXPECT_EQ(row.doubt, "");
    EXPECT_EQ(row.like, "jobs/1.json");
    EXPECT_EQ(row.boundary, earlier.job.anomaly.topRows<2>());
    EXPECT_TRUE(result.absent.empty());
}

// A polynomial displacement of a curved sheet along its normals is found again, so that the distances vanish.
TEST(SlowField, TakesABendOff)
{
    mesh::Mesh sheet;
    const int n = 41;
    sheet.vertices.resize(3, n * n);
    sheet.triangles.resize(3, 2 * (n - 1) * (n - 1));
    for (int y = 0, t = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            sheet.vertices.col(y * n + x) << x, y, 0.01 * (x - 20) * (x - 20);
            if (x + 1 == n || y + 1 == n) continue;
            const int i = y * n + x;
            sheet.triangles.col(t++) << i, i + 1, i + n;
            sheet.triangles.col(t++) << i + 1, i + n + 1, i + n;
        }
    Eigen::Matrix3Xd bent(3, 30 * 30);
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 30; ++x) {
            const Eigen::Vector3d p = sheet.vertices.col((y + 5) * n + x + 5);
            bent.col(y * 30 + x) = p + Eigen::Vector3d(0, 0, 1e-3 * p.x() * p.y());
        }
    const compare::Reference reference(sheet, {});
    const SlowField field = fit_slow_field(bent, reference);
    Eigen::Matrix3Xd back = bent;
    for (Eigen::Index i = 0; i < back.cols(); ++i) back.col(i) -= field.at(bent.col(i));
    EXPECT_LT(reference(back).error.cwiseAbs().maxCoeff(), 0.02);
}

} // namespace find_test
} // namespace fettle::find
