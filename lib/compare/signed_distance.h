#pragma once

#include "cloud/cloud.h"
#include "compare/reference_mesh.h"
#include "mesh/mesh.h"

#include <Eigen/Core>

#include <limits>
#include <memory>

namespace fettle {

/// Along what the error of a point is measured.
enum class DistanceMode {
    normal,    ///< to the closest point of the reference
    direction, ///< along a line of given direction (z is one)
};

struct DistanceOptions {
    DistanceMode mode = DistanceMode::normal;
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();          ///< unit, out of the material
    double max_distance = std::numeric_limits<double>::infinity(); ///< beyond it the error is undefined, mm
    Winding winding = Winding::mend;                               ///< of a mesh
};

/// The signed distance of test points from a reference. Where the reference says nothing (beyond an open border or
/// max_distance, in a gap of a cloud, NaN points) everything is NaN: never guessed.
struct ErrorMap {
    Eigen::VectorXd error;   ///< + material left, mm
    Eigen::Matrix3Xd normal; ///< of the reference at the foot of each point, unit, outward
    Eigen::Matrix3Xd foot;   ///< the point of the reference that the error is measured to, mm
    Eigen::VectorXd facet;   ///< of a mesh: the number of the facet that holds the foot; empty for a cloud
    /// Standard deviation of the reference's own height at the foot, mm: of the fit to a cloud; empty for a mesh.
    Eigen::VectorXd reference_sigma;
};

/// A reference made ready for points that come block by block. Thread-safe.
///
/// Mesh: exact distance (vertices, edges, facets), signed by angle-weighted pseudo-normals. Along a direction: from the
/// nearest crossing of the line with a facet that faces the direction; if the line meets none of these beside the
/// point, from the nearest crossing.
/// Cloud: distance from a quadratic surface fitted to the neighbours of the foot (cloud_reference.h). The cloud's
/// normals say which side is out, without them +Z; in mode direction, the direction does.
class Reference {
  public:
    Reference(Mesh mesh, const DistanceOptions& options);
    Reference(const Cloud& cloud, const DistanceOptions& options);
    Reference(Reference&&) noexcept;
    ~Reference();

    /// @param points  3xN, mm
    ErrorMap operator()(const Eigen::Matrix3Xd& points) const;
    /// What was mended of the mesh; of a cloud nothing is.
    const ReferenceRepair& repair() const;

  private:
    struct State;
    std::unique_ptr<const State> state_;
};

ErrorMap signed_distance(const Eigen::Matrix3Xd& points, const Mesh& reference, const DistanceOptions& options = {});
ErrorMap signed_distance(const Eigen::Matrix3Xd& points, const Cloud& reference, const DistanceOptions& options = {});

} // namespace fettle
