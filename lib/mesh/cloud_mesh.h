#pragma once

#include "cloud/cloud.h"
#include "mesh/mesh.h"
#include "mesh/shape_file.h"
#include "units/units.h"

#include <Eigen/Core>

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace fettle::mesh {

/// A part as it was scanned: points with all their fields, and the triangles over them if it is a mesh (as
/// pcl::PolygonMesh). Frame M, mm.
struct CloudMesh {
    cloud::Cloud points;        ///< of a cloud, or vertices of a mesh
    Eigen::Matrix3Xi triangles; ///< 3xT, indices of columns of `points.xyz`; of a mesh at least one
    bool is_mesh() const { return triangles.cols() > 0; }
};

CloudMesh as_cloud_mesh(MeshOrCloud shape);

struct CloudMeshFile {
    CloudMesh part;
    units::Units units; ///< of the file
    MeshRepair repair;  ///< what reading a mesh dropped or repaired
};

/// Reads a cloud or a mesh as read_shape() does, with the fields of a PLY mesh's vertices.
/// @param path  a file, or "-" for stdin   @param units  of the file; without them those that a PCD states, else mm
/// @throws InputError as read_shape()
CloudMeshFile read_cloud_mesh(const std::string& path, const std::optional<units::Units>& units);

/// The points of `indices`, ascending, with their fields, and the triangles whose three corners are among them. Of a
/// mesh vertices without a triangle go too.
CloudMesh select_points(const CloudMesh& part, const std::vector<Eigen::Index>& indices);
/// The triangles of `indices`, ascending, and the vertices that they need, with their fields.
CloudMesh select_triangles(const CloudMesh& part, const std::vector<Eigen::Index>& indices);

/// Formats in which a cloud or a mesh is written.
enum class PartFormat { pcd, pcd_ascii, ply, csv, vtk, stl };

/// The format of a file's suffix (.pcd, .ply, .csv, .vtk, .stl in either case), unless one is stated: that of stdout,
/// and of other suffixes, is STL for a mesh and PCD for a cloud.
/// @param stated  "pcd", "ply", "csv", "vtk" or "stl"; empty: by the suffix
/// @throws InputError for a mesh as PCD, CSV or VTK, which have no triangles, and for a cloud as STL
PartFormat part_format(const std::string& path, const std::string& stated, bool is_mesh);

/// Writes a part. STL holds no fields. @param units  of the numbers written
void write_cloud_mesh(std::ostream& out, const CloudMesh& part, PartFormat format, const units::Units& units);

} // namespace fettle::mesh
