#pragma once

#include <Eigen/Core>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstddef>

namespace fettle::cloud {

// To PCL and back. PCL's coordinates are floats: points are converted about a centre, so that a part far from the
// origin keeps its digits. Point i of one cloud is point i of the other: fields stay where they are, and follow the
// indices that a filter of PCL returns by select_points(). Whoever includes this header needs libpcl-dev, and links
// pcl_common.

/// Points as PCL's, relative to a centre. @param xyz  3xN, mm; NaN: no point   @param centre  mm
inline pcl::PointCloud<pcl::PointXYZ>::Ptr to_pcl(const Eigen::Matrix3Xd& xyz, const Eigen::Vector3d& centre)
{
    const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
    cloud->resize(static_cast<std::size_t>(xyz.cols()));
    for (Eigen::Index i = 0; i < xyz.cols(); ++i) (*cloud)[i].getVector3fMap() = (xyz.col(i) - centre).cast<float>();
    cloud->is_dense = xyz.allFinite();
    return cloud;
}

/// Points with normals as PCL's, relative to a centre. @param normals  3xN, unit
inline pcl::PointCloud<pcl::PointNormal>::Ptr to_pcl(const Eigen::Matrix3Xd& xyz, const Eigen::Matrix3Xd& normals,
                                                     const Eigen::Vector3d& centre)
{
    const pcl::PointCloud<pcl::PointNormal>::Ptr cloud(new pcl::PointCloud<pcl::PointNormal>);
    cloud->resize(static_cast<std::size_t>(xyz.cols()));
    for (Eigen::Index i = 0; i < xyz.cols(); ++i) {
        pcl::PointNormal& point = (*cloud)[static_cast<std::size_t>(i)];
        point.getVector3fMap() = (xyz.col(i) - centre).cast<float>();
        point.getNormalVector3fMap() = normals.col(i).cast<float>();
    }
    cloud->is_dense = xyz.allFinite() && normals.allFinite();
    return cloud;
}

/// Coordinates of PCL's points, of any type with x, y and z. @param centre  that of to_pcl(), mm   @return  3xN, mm
template <typename Point>
Eigen::Matrix3Xd from_pcl(const pcl::PointCloud<Point>& cloud, const Eigen::Vector3d& centre)
{
    Eigen::Matrix3Xd xyz(3, cloud.size());
    for (Eigen::Index i = 0; i < xyz.cols(); ++i)
        xyz.col(i) = cloud[i].getVector3fMap().template cast<double>() + centre;
    return xyz;
}

} // namespace fettle::cloud
