#pragma once

#include "find/bounds.h"
#include "mesh/cloud_mesh.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace fettle::find {

/// An anomaly of a part. Lengths mm.
struct FoundAnomaly {
    double probability = 0;  ///< that it is one, by the logistic model
    double height = 0;       ///< largest over the surface beneath, along its mean normal
    double area = 0;         ///< of the surface beneath, mm²
    double volume = 0;       ///< over that surface, mm³
    double significance = 0; ///< height in standard deviations of the surface beneath
    std::string doubt;       ///< why a person should look at it; empty: nothing speaks against it

    Eigen::Isometry3d T_view_part; ///< turns its surroundings to +z
    Eigen::Matrix2Xd boundary;     ///< 2xN, polygon B in the view's plane: around all of it
    Eigen::Matrix2Xd sampling;     ///< 2xM, polygon S around B in the view's plane: as far as the metal is good
    double cell = 0;               ///< of the view's map: what the polygons resolve
    std::vector<Eigen::Index> points; ///< of the part, ascending
    Eigen::VectorXd heights;          ///< of these over the surface beneath
};

struct FindResult {
    double noise = 0;                     ///< standard deviation of the part's points, mm
    std::vector<FoundAnomaly> anomalies;  ///< most probable first; the fields number them from 1
};

/// Finds anomalies of a part without a model: the part itself is the witness (docs/methods/find.md).
/// @throws InputError if the part has no surface
FindResult find_anomalies(const mesh::CloudMesh& part, const SearchBounds& bounds = {});

/// The part with fields `anomaly` (0 none, else the row of the result from 1) and `height` (over the surface beneath,
/// mm; 0 outside of anomalies).
mesh::CloudMesh labelled(mesh::CloudMesh part, const FindResult& result);

} // namespace fettle::find
