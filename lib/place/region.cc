#include "place/region.h"

#include "cloud/pcl.h"
#include "core/decompositions.h"
#include "core/error.h"
#include "geometry/bounding_box.h"

#include <pcl/console/print.h>
#include <pcl/ModelCoefficients.h>
#include <pcl/PointIndices.h>
#include <pcl/sample_consensus/method_types.h>
#include <pcl/sample_consensus/model_types.h>
#include <pcl/segmentation/impl/sac_segmentation.hpp> // the library of that name takes 60 ms to load

#include <cmath>
#include <vector>

namespace fettle::place {
namespace {

constexpr int kMaxIterations = 2000; // a region of a tenth of the points is then found with a probability of .99

// Weight of the angle between normals against the distance: PCL's default in its tutorials.
constexpr double kNormalWeight = 0.1;

// The mean of unit normals all around a cylinder is 0, that of a half is 2/π.
constexpr double kMinMeanNormal = 0.2;

// Normals of a scanned plane scatter by less than 30°.
constexpr double kMinNormalCosine = 0.866;

struct Segment {
    pcl::ModelCoefficients model;
    std::vector<Eigen::Index> points;
};

Segment segment(const align::OrientedPoints& points, const Eigen::Vector3d& middle, int model, double threshold)
{
    const pcl::PointCloud<pcl::Normal>::Ptr normals(new pcl::PointCloud<pcl::Normal>);
    normals->resize(static_cast<std::size_t>(points.normals.cols()));
    for (Eigen::Index i = 0; i < points.normals.cols(); ++i)
        (*normals)[i].getNormalVector3fMap() = points.normals.col(i).cast<float>();
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); // what it finds is judged here; it would print
    pcl::SACSegmentationFromNormals<pcl::PointXYZ, pcl::Normal> search;
    search.setModelType(model);
    search.setMethodType(pcl::SAC_RANSAC);
    search.setNormalDistanceWeight(kNormalWeight);
    search.setDistanceThreshold(threshold);
    search.setMaxIterations(kMaxIterations);
    search.setOptimizeCoefficients(true);
    // A cylinder wider than the part is long cannot be distinguished from a plane.
    search.setRadiusLimits(0, geometry::bounding_box(points.xyz).diagonal().norm());
    search.setInputCloud(cloud::to_pcl(points.xyz, middle));
    search.setInputNormals(normals);
    Segment found;
    pcl::PointIndices inliers;
    search.segment(inliers, found.model);
    found.points.assign(inliers.indices.begin(), inliers.indices.end());
    return found;
}

/// The direction in which points scatter least. Those next to the edges of other faces are left out by their normals.
/// @param normals  unit   @param rough  unit, the normal within a few degrees
Eigen::Vector3d plane_normal(const Eigen::Matrix3Xd& xyz, const Eigen::Matrix3Xd& normals, const Eigen::Vector3d& rough)
{
    std::vector<Eigen::Index> on_plane;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; i < xyz.cols(); ++i)
        if (std::abs(normals.col(i).dot(rough)) > kMinNormalCosine) {
            on_plane.push_back(i);
            sum += xyz.col(i);
        }
    if (on_plane.size() < 3) return rough;
    const Eigen::Vector3d mean = sum / static_cast<double>(on_plane.size());
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const Eigen::Index i : on_plane) scatter += (xyz.col(i) - mean) * (xyz.col(i) - mean).transpose();
    return core::symmetric_eigen<3>(scatter).vectors.col(0);
}

} // namespace

FoundRegion find_region(const align::OrientedPoints& points, RegionShape shape, double threshold)
{
    const bool is_plane = shape == RegionShape::plane;
    if (points.xyz.cols() < 3) throw core::InputError("has fewer than three points");
    const Eigen::Vector3d middle = geometry::bounding_box(points.xyz).center();
    const Segment found =
        segment(points, middle, is_plane ? pcl::SACMODEL_NORMAL_PLANE : pcl::SACMODEL_CYLINDER, threshold);
    if (found.points.empty())
        throw core::InputError(std::string("no ") + (is_plane ? "plane" : "cylinder") + " is found");
    const Eigen::Matrix3Xd xyz = points.xyz(Eigen::all, found.points);
    Eigen::Vector3d mean_normal = points.normals(Eigen::all, found.points).rowwise().mean();
    FoundRegion region;
    region.centre = xyz.rowwise().mean();
    region.share = static_cast<double>(found.points.size()) / static_cast<double>(points.xyz.cols());
    if (is_plane) {
        const std::vector<float>& n = found.model.values;
        const Eigen::Vector3d rough = Eigen::Vector3f(n[0], n[1], n[2]).cast<double>().normalized();
        const Eigen::Vector3d normal = plane_normal(xyz, points.normals(Eigen::all, found.points), rough);
        region.up = normal.dot(mean_normal) < 0 ? Eigen::Vector3d(-normal) : normal;
        return region;
    }
    const std::vector<float>& c = found.model.values; // a point of the axis, its direction, the radius
    const Eigen::Vector3d axis = Eigen::Vector3f(c[3], c[4], c[5]).cast<double>().normalized();
    mean_normal -= axis.dot(mean_normal) * axis;
    if (mean_normal.norm() < kMinMeanNormal)
        throw core::InputError("the cylinder is seen from all around: none of its sides is up");
    region.up = mean_normal.normalized();
    region.radius = c[6];
    return region;
}

} // namespace fettle::place
