#pragma once

#include "cloud/cloud.h"
#include "mesh/mesh.h"
#include "units/units.h"

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <string>

namespace fettle {

/// A part as it lies on the table, to be touched from above: a mesh or a point cloud. Thread-safe.
class Scan {
  public:
    explicit Scan(Mesh mesh);
    explicit Scan(Cloud cloud);
    Scan(Scan&&) noexcept;
    ~Scan();

    /// z of a touch over xy with a point: on a mesh the vertical ray's highest hit; on a cloud the local quadratic of
    /// the points within 3 spacings of the vertical line. Nothing there: no touch.
    std::optional<double> height(const Eigen::Vector2d& xy) const;
    /// z of the lowest point of a ball of `radius` that comes down over xy, when it first touches. On a mesh exact
    /// (facets, edges, vertices); on a cloud against the local quadratics.
    std::optional<double> drop_ball(const Eigen::Vector2d& xy, double radius) const;
    /// z of a cloud's highest point within `radius` of the vertical line: beside a wall there is no local quadratic.
    std::optional<double> highest_point(const Eigen::Vector2d& xy, double radius) const;
    /// The triangles; nothing for a cloud.
    const Mesh* mesh() const;
    /// Column 0 the least corner, column 1 the greatest, mm.
    Eigen::Matrix<double, 3, 2> bounds() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Reads a mesh or a cloud, told by content.
/// @param units   of the job
/// @param stated  the file's length unit; nothing: the job's
/// @throws InputError as read_shape() (mesh/shape_file.h), or if no point of a cloud is finite
Scan read_scan(const std::string& path, const Units& units, std::optional<Units::Length> stated);

} // namespace fettle
