#pragma once

#include "cloud/cloud.h"
#include "cloud/point_source.h"
#include "mesh/shape_file.h"
#include "units/units.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace fettle {

/// Points to compare: of a cloud, or the vertices of a mesh.
struct TestPoints {
    std::optional<Mesh> mesh; ///< if it is one
    PointSource points;
    /// Some of the points, with all fields.
    std::function<Cloud(std::size_t first, std::size_t count)> part;
    Units units; ///< of the file
};
TestPoints test_points(const MeshOrCloud& shape, const Units& units);

/// The same from a file. A binary PCD is not held in memory. @throws InputError as read_shape()
TestPoints open_test_points(const std::string& path, const std::optional<Units>& units);

} // namespace fettle
