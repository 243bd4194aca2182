#pragma once

#include "cloud/cloud.h"
#include "cloud/point_source.h"
#include "mesh/mesh.h"
#include "units/units.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <variant>

namespace fettle {

/// A mesh or a cloud, mm.
using MeshOrCloud = std::variant<Mesh, Cloud>;

struct ShapeFile {
    MeshOrCloud shape;
    Units units;       ///< of the file
    MeshRepair repair; ///< what reading a mesh dropped
};

/// Reads a mesh or a cloud, told by content. @param path  "-": stdin
/// @param units  what the file is in; nothing: what a PCD says of itself, else mm
ShapeFile read_shape(const std::string& path, const std::optional<Units>& units);

/// Points to compare: of a cloud, or the vertices of a mesh.
struct TestPoints {
    std::optional<Mesh> mesh; ///< if it is one
    PointSource points;
    /// Some of the points, with all fields.
    std::function<Cloud(std::size_t first, std::size_t count)> part;
    Units units; ///< of the file
};
TestPoints test_points(const MeshOrCloud& shape, const Units& units);

/// Where they are, mm: of a cloud, or the vertices of a mesh. 3xN
const Eigen::Matrix3Xd& places_of(const MeshOrCloud& shape);

/// The same from a file. A binary PCD is not held in memory. @throws InputError as read_shape()
TestPoints open_test_points(const std::string& path, const std::optional<Units>& units);

} // namespace fettle
