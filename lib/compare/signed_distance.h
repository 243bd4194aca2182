#pragma once

#include "cloud/cloud.h"
#include "compare/reference_mesh.h"
#include "mesh/mesh.h"

#include <Eigen/Core>

#include <limits>
#include <memory>

namespace fettle::compare {

/// Direction in which the error of a point is measured.
enum class DistanceMode {
    normal,    ///< to the closest point of the reference, its foot
    direction, ///< along a given direction, such as Z
};

struct DistanceOptions {
    DistanceMode mode = DistanceMode::normal;
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();          ///< unit, out of the material
    double max_distance = std::numeric_limits<double>::infinity(); ///< beyond it the error is undefined, mm
    Winding winding = Winding::repair;                             ///< of a mesh
};

/// Signed distances of test points from a reference. Where they are undefined (beyond an open border or max_distance,
/// in a gap of a cloud, NaN points) all values are NaN: never guessed.
struct ErrorMap {
    Eigen::VectorXd error;   ///< + material left, - over-cut, mm
    Eigen::Matrix3Xd normal; ///< of the reference at the foot of each point, unit, outward
    Eigen::Matrix3Xd foot;   ///< the point of the reference that the error is measured to, mm
    Eigen::VectorXd facet;   ///< of a mesh: index of the facet with the foot in the original mesh; empty for a cloud
    /// Standard deviation of the surface fitted to a cloud at the foot, mm; empty for a mesh.
    Eigen::VectorXd reference_sigma;
};

/// A reference indexed for queries with blocks of points. Thread-safe.
///
/// Mesh: exact distance (vertices, edges, facets), signed by angle-weighted pseudo-normals. Along a direction: distance
/// from the first facet above the point or the first below it; one that faces the direction has precedence, then the
/// nearer one.
/// Cloud: distance from a quadratic surface fitted to the neighbours of the foot (cloud_reference.h). Outward is the
/// side of the cloud's normals, +Z without normals, or in mode direction the direction.
class Reference {
  public:
    Reference(mesh::Mesh mesh, const DistanceOptions& options);
    Reference(const cloud::Cloud& cloud, const DistanceOptions& options);
    Reference(Reference&&) noexcept;
    ~Reference();

    /// @param points  3xN, mm
    ErrorMap operator()(const Eigen::Matrix3Xd& points) const;
    /// Repairs of a mesh; none for a cloud.
    const ReferenceRepair& repair() const;

  private:
    struct State;
    std::unique_ptr<const State> state_;
};

ErrorMap signed_distance(const Eigen::Matrix3Xd& points, const mesh::Mesh& reference,
                         const DistanceOptions& options = {});
ErrorMap signed_distance(const Eigen::Matrix3Xd& points, const cloud::Cloud& reference,
                         const DistanceOptions& options = {});

} // namespace fettle::compare
