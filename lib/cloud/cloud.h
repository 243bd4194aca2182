#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <string>
#include <vector>

namespace fettle::cloud {

/// A PCD field besides x y z with the bytes of the file, of whatever type.
struct Field {
    std::string name;
    char type = 'F';              ///< 'F', 'I', 'U' as in PCD
    int size = 4;                 ///< bytes of one element: 1, 2, 4, 8
    int count = 1;                ///< elements per point
    std::vector<std::byte> bytes; ///< points · count · size

    std::size_t stride() const { return static_cast<std::size_t>(size) * count; } ///< bytes of one point
};

/// Frame of the coordinates in a file: the part's own, or that of a job, which a header comment `# frame job` states.
/// They differ if the job has a pose (job/job.h).
enum class Frame { part, job };

/// Points with named fields, frame M, in mm; fields with a dimension are in base units (fields.h).
struct Cloud {
    Eigen::Matrix3Xd xyz;                                  ///< 3xN; NaN: no point
    std::vector<Field> fields;                             ///< in the order of the file
    Eigen::Vector3d view_origin = Eigen::Vector3d::Zero(); ///< VIEWPOINT, mm
    Eigen::Quaterniond view_orientation = Eigen::Quaterniond::Identity();
    std::size_t width = 0; ///< of an organised cloud; 0: not organised
    Frame frame = Frame::part;
    std::string comment; ///< a comment line for the header, "frame: part"; readers ignore it

    Eigen::Index size() const { return xyz.cols(); }
};

bool has_field(const Cloud& cloud, const std::string& name);

/// Values of a scalar field, in base units.
/// @throws InputError if it is missing or has more than one element per point
Eigen::VectorXd field(const Cloud& cloud, const std::string& name);

/// Adds or replaces a scalar field. @param size  4: float, 8: double
void set_field(Cloud& cloud, const std::string& name, const Eigen::VectorXd& values, int size = 4);

/// The fields normal_x, normal_y and normal_z.
bool has_normals(const Cloud& cloud);
Eigen::Matrix3Xd normals(const Cloud& cloud);
void set_normals(Cloud& cloud, const Eigen::Matrix3Xd& unit_normals);

/// Sets the field rgb, packed as in PCL, so that pcl_viewer and CloudCompare show it. @param rgb  3xN, 0 to 255
void set_colours(Cloud& cloud, const Eigen::Matrix<std::uint8_t, 3, Eigen::Dynamic>& rgb);

/// Names of the fields that hold the orientation of a pose at each point, a quaternion (cloud/poses.h).
inline constexpr const char* kQuaternion[] = {"qw", "qx", "qy", "qz"};
/// True if the cloud has these four fields.
bool has_poses(const Cloud& cloud);

/// Moves points, normals, poses and viewpoint of a cloud. Row by row x' = ((m00 x + m01 y) + m02 z) + m03 in double, so
/// that any program that applies the matrix gets the same bits; the order of the sums in
/// pcl::transformPointCloudWithNormals depends on the vector instructions that it is compiled for.
/// @param matrix  rigid, in units of `mm` millimetres
Cloud transformed(Cloud cloud, const Eigen::Matrix4d& matrix, double mm);

/// Copies consecutive points with all their fields, and the width of the whole cloud.
Cloud slice(const Cloud& cloud, Eigen::Index first, Eigen::Index count);

/// Copies points with all their fields, in the order of `indices`; the result is not organised.
Cloud select_points(const Cloud& cloud, const std::vector<Eigen::Index>& indices);

} // namespace fettle::cloud
