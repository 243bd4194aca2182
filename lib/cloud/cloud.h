#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <string>
#include <vector>

namespace fettle {

/// One PCD field besides x y z, as it stands in the file: kept byte for byte, whatever its type.
struct Field {
    std::string name;
    char type = 'F';              ///< 'F', 'I', 'U' as in PCD
    int size = 4;                 ///< bytes of one element: 1, 2, 4, 8
    int count = 1;                ///< elements a point
    std::vector<std::byte> bytes; ///< points · count · size
};

/// Points with named fields, in mm (fields with a unit: base units, see fields.h), in the frame M.
struct Cloud {
    Eigen::Matrix3Xd xyz;                                  ///< 3xN; NaN: no point there
    std::vector<Field> fields;                             ///< in the order of the file
    Eigen::Vector3d view_origin = Eigen::Vector3d::Zero(); ///< VIEWPOINT, mm
    Eigen::Quaterniond view_orientation = Eigen::Quaterniond::Identity();
    std::size_t width = 0; ///< of an organised cloud; 0: not organised
    std::string comment;   ///< a line for the header, "frame: part"; not read back

    Eigen::Index size() const { return xyz.cols(); }
};

bool has_field(const Cloud& cloud, const std::string& name);

/// A scalar field as numbers, in base units.
/// @throws InputError if it is missing or has more than one element a point
Eigen::VectorXd field(const Cloud& cloud, const std::string& name);

/// Adds a scalar field or replaces it in its place. @param size  4: float, 8: double
void set_field(Cloud& cloud, const std::string& name, const Eigen::VectorXd& values, int size = 4);

/// Fields normal_x normal_y normal_z.
bool has_normals(const Cloud& cloud);
Eigen::Matrix3Xd normals(const Cloud& cloud);
void set_normals(Cloud& cloud, const Eigen::Matrix3Xd& unit_normals);

/// Field rgb, packed as PCL packs it: pcl_viewer and CloudCompare show it without a click. @param rgb  3xN, 0 to 255
void set_colours(Cloud& cloud, const Eigen::Matrix<std::uint8_t, 3, Eigen::Dynamic>& rgb);

/// Consecutive points with all their fields; they keep the width of the whole.
Cloud part(const Cloud& cloud, Eigen::Index first, Eigen::Index count);

/// The chosen points with all their fields, in the order of `indices`; no longer organised.
Cloud select(const Cloud& cloud, const std::vector<Eigen::Index>& indices);

} // namespace fettle
