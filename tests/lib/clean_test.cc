#include "clean/clean.h"
#include "cloud/pcl.h"
#include "core/error.h"

#include <gtest/gtest.h>
#include <pcl/filters/radius_outlier_removal.h>
#include <pcl/filters/statistical_outlier_removal.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <tuple>

namespace fettle {
namespace clean_test {

/// A wavy sheet with noise, some points far off it, and a dense corner; far from the origin, where floats would be
/// coarse.
Eigen::Matrix3Xd sheet(int points)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(0, 40), high(-9, 9), dense(0, 4);
    std::normal_distribution<double> noise(0, 0.05);
    Eigen::Matrix3Xd xyz(3, points);
    for (int i = 0; i < points; ++i) {
        const double x = i % 5 == 0 ? dense(random) : place(random), y = i % 5 == 0 ? dense(random) : place(random);
        xyz.col(i) << 1e5 + x, y - 2e5, std::sin(x / 5) + noise(random) + (i % 90 == 0 ? high(random) : 0.0);
    }
    return xyz;
}

Eigen::Vector3d middle(const Eigen::Matrix3Xd& xyz)
{
    return (xyz.rowwise().minCoeff() + xyz.rowwise().maxCoeff()) / 2;
}

/// What a filter of PCL leaves out, as find_outliers() returns it.
template <typename Filter>
std::vector<char> left_out(Filter& filter, const Eigen::Matrix3Xd& xyz)
{
    filter.setInputCloud(cloud::to_pcl(xyz, middle(xyz)));
    pcl::Indices kept;
    filter.filter(kept);
    std::vector<char> result(static_cast<std::size_t>(xyz.cols()), 1);
    for (const auto index : kept) result[static_cast<std::size_t>(index)] = 0;
    return result;
}

TEST(Outliers, StatisticalOnesAreThoseOfPcl)
{
    const Eigen::Matrix3Xd xyz = sheet(20000);
    for (const int neighbours : {1, 8, 30})
        for (const double sigmas : {0.0, 1.0, 2.5}) {
            pcl::StatisticalOutlierRemoval<pcl::PointXYZ> filter;
            filter.setMeanK(neighbours);
            filter.setStddevMulThresh(sigmas);
            const std::vector<char> found = clean::find_outliers(xyz, clean::StatisticalFilter{neighbours, sigmas});
            EXPECT_EQ(found, left_out(filter, xyz)) << neighbours << ", " << sigmas;
            EXPECT_GT(std::count(found.begin(), found.end(), 1), 50);
        }
}

TEST(Outliers, ThoseByRadiusAreThoseOfPcl)
{
    const Eigen::Matrix3Xd xyz = sheet(20000);
    for (const int neighbours : {1, 5, 20})
        for (const double radius : {0.2, 0.5}) {
            pcl::RadiusOutlierRemoval<pcl::PointXYZ> filter;
            filter.setRadiusSearch(radius);
            filter.setMinNeighborsInRadius(neighbours);
            EXPECT_EQ(clean::find_outliers(xyz, clean::RadiusFilter{radius, neighbours}), left_out(filter, xyz))
                << neighbours << ", " << radius;
        }
}

TEST(Outliers, TooFewPointsAreRefused)
{
    EXPECT_THROW(clean::find_outliers(Eigen::Matrix3Xd::Random(3, 8), clean::StatisticalFilter{8, 1}),
                 core::InputError);
}

TEST(Pcl, PointsKeepTheirDigitsFarFromTheOrigin)
{
    Eigen::Matrix3Xd xyz = sheet(1000);
    xyz.col(5).setConstant(std::numeric_limits<double>::quiet_NaN());
    const Eigen::Vector3d centre(1e5 + 20, 20 - 2e5, 0);
    const auto theirs = cloud::to_pcl(xyz, centre);
    EXPECT_FALSE(theirs->is_dense);
    const Eigen::Matrix3Xd back = cloud::from_pcl(*theirs, centre);
    EXPECT_TRUE(back.col(5).hasNaN());
    for (Eigen::Index i = 6; i < 1000; ++i) EXPECT_LT((back.col(i) - xyz.col(i)).norm(), 3e-6) << i; // 40 mm as float
}

/// Which cube of the grid a point is in.
std::tuple<double, double, double> cube_of(const Eigen::Vector3d& p, double length)
{
    return {std::floor(p.x() / length), std::floor(p.y() / length), std::floor(p.z() / length)};
}

TEST(Thinning, KeepsInEachCubeThePointNearestToTheMean)
{
    const Eigen::Matrix3Xd xyz = sheet(3000);
    const double length = 1.7;
    const std::vector<char> stays = clean::thin(xyz, {clean::Thinning::Rule::voxel, length});
    for (Eigen::Index i = 0; i < xyz.cols(); i += 7) { // by brute force
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        std::vector<Eigen::Index> cube;
        for (Eigen::Index j = 0; j < xyz.cols(); ++j)
            if (cube_of(xyz.col(j), length) == cube_of(xyz.col(i), length)) {
                cube.push_back(j);
                sum += xyz.col(j);
            }
        const Eigen::Vector3d mean = sum / static_cast<double>(cube.size());
        Eigen::Index nearest = cube.front();
        for (const Eigen::Index j : cube)
            if ((xyz.col(j) - mean).squaredNorm() < (xyz.col(nearest) - mean).squaredNorm()) nearest = j;
        for (const Eigen::Index j : cube) EXPECT_EQ(stays[static_cast<std::size_t>(j)], j == nearest) << j;
    }
}

TEST(Thinning, BySpacingLeavesNoTwoNearerAndNoGap)
{
    const Eigen::Matrix3Xd xyz = sheet(3000);
    const double length = 1.7;
    const std::vector<char> stays = clean::thin(xyz, {clean::Thinning::Rule::spacing, length});
    for (Eigen::Index i = 0; i < xyz.cols();
         ++i) { // what stays are the points without an earlier one that stays near them
        bool is_near = false;
        for (Eigen::Index j = 0; j < i; ++j)
            is_near |= stays[static_cast<std::size_t>(j)] != 0 && (xyz.col(i) - xyz.col(j)).norm() < length;
        EXPECT_EQ(stays[static_cast<std::size_t>(i)], !is_near) << i;
    }
}

TEST(Thinning, RefusesLengthsFarBelowTheResolution)
{
    EXPECT_THROW(clean::thin(sheet(10), {clean::Thinning::Rule::voxel, 1e-6}), core::InputError);
}

TEST(Duplicates, AreAllButTheFirst)
{
    Eigen::Matrix3Xd xyz = sheet(5000);
    for (Eigen::Index i = 1000; i < 5000; i += 3) xyz.col(i) = xyz.col(i % 1000);
    xyz.col(4) << 0.0, 1, 2;
    xyz.col(4001) << -0.0, 1, 2; // the same place
    std::set<std::tuple<double, double, double>> seen;
    const std::vector<char> is_duplicate = clean::find_duplicates(xyz);
    for (Eigen::Index i = 0; i < xyz.cols(); ++i)
        EXPECT_EQ(is_duplicate[static_cast<std::size_t>(i)] != 0,
                  !seen.insert({xyz(0, i), xyz(1, i), xyz(2, i)}).second)
            << i;
}

TEST(Region, HoldsItsBorder)
{
    const clean::Region box = clean::parse_region("box:0,0,0,1,2,3").region;
    EXPECT_TRUE(clean::contains(box, {1, 2, 3}));
    EXPECT_FALSE(clean::contains(box, {1.001, 2, 3}));
    const clean::Region sphere = clean::scaled(clean::parse_region("sphere:1,0,0,2").region, 10);
    EXPECT_TRUE(clean::contains(sphere, {30, 0, 0}));
    EXPECT_FALSE(clean::contains(sphere, {30.01, 0, 0}));
    const clean::Region prism = clean::parse_region("polygon:-1,1,0,0,4,0,0,4").region; // a triangle
    EXPECT_TRUE(clean::contains(prism, {2, 2, 1}));
    EXPECT_FALSE(clean::contains(prism, {2.01, 2, 0}));
    EXPECT_FALSE(clean::contains(prism, {1, 1, 1.01}));
}

} // namespace clean_test
} // namespace fettle
