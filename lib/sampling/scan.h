#pragma once

#include "cloud/cloud.h"
#include "job/job.h"
#include "mesh/mesh.h"
#include "units/units.h"

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fettle::sampling {

/// A part on the machine table that is touched from above: a mesh or a point cloud. Thread-safe.
class Scan {
  public:
    /// @param repair  what reading the mesh has dropped
    explicit Scan(mesh::Mesh mesh, const mesh::MeshRepair& repair = {});
    explicit Scan(cloud::Cloud cloud);
    Scan(Scan&&) noexcept;
    ~Scan();

    /// z of a touch over xy with a point probe: on a mesh the highest intersection of the vertical line, on a cloud the
    /// local quadratic (see PointSurface). Nothing if there is no surface.
    std::optional<double> height(const Eigen::Vector2d& xy) const;
    /// z of the lowest point of a ball that is lowered over xy until it first touches. On a mesh it is exact (facets,
    /// edges, vertices); on a cloud it touches the local quadratics.
    std::optional<double> drop_ball(const Eigen::Vector2d& xy, double radius) const;
    /// z of a cloud's highest point within `radius` of the vertical line, for places without a local quadratic, such as
    /// beside a wall. Nothing for a mesh.
    std::optional<double> highest_point(const Eigen::Vector2d& xy, double radius) const;
    /// The mesh; null for a cloud.
    const mesh::Mesh* mesh() const;
    /// What of the file the mesh does not have.
    const mesh::MeshRepair& repair() const;
    /// Bounding box, mm: column 0 is the min corner, column 1 the max corner.
    Eigen::AlignedBox3d bounds() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Reads a mesh or a cloud, in the job's frame; the content decides which.
/// @param stated  length unit of the file; nothing: that of the job
/// @throws InputError as read_shape() (mesh/shape_file.h), or if no point of a cloud is finite
Scan read_scan(const std::string& path, const job::Job& job, std::optional<units::Units::Length> stated);

/// Warnings about a part: what was left out of it, and that it may be the wrong one. @param name  of its file
std::vector<std::string> scan_warnings(const Scan& scan, const job::Job& job, const std::string& name);

} // namespace fettle::sampling
