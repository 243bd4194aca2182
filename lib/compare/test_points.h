#pragma once

#include "cloud/cloud.h"
#include "cloud/point_source.h"
#include "job/job.h"
#include "mesh/shape_file.h"
#include "units/units.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace fettle::compare {

/// Points to be compared: those of a cloud, or the vertices of a mesh.
struct TestPoints {
    std::optional<mesh::Mesh> mesh; ///< none: a cloud
    cloud::PointSource points;
    /// Reads `count` points with all fields.
    std::function<cloud::Cloud(std::size_t first, std::size_t count)> slice;
    units::Units units; ///< of the file
    cloud::Frame frame = cloud::Frame::part;
    mesh::MeshRepair repair; ///< what reading a mesh dropped
};
TestPoints test_points(const mesh::MeshOrCloud& shape, const units::Units& units);

/// Opens a file of points; a binary PCD is streamed, other files are read, and those that must be moved into the frame
/// of the job. @throws InputError as read_shape()
TestPoints open_test_points(const std::string& path, const std::optional<units::Units>& units,
                            const std::optional<job::Job>& job);

} // namespace fettle::compare
