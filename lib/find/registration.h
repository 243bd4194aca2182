#pragma once

#include "align/align.h"
#include "find/find.h"
#include "mesh/shape_file.h"

#include <optional>

namespace fettle::find {

/// A part registered to its reference.
struct Registration {
    Eigen::Isometry3d T_reference_part;
    bool converged = true;           ///< or stated
    std::vector<std::string> doubts; ///< of align::doubts()
};

/// Registers a part to a reference as fettle-align does, without scaling. @param stated  taken as it is
/// @throws InputError as align::align()
Registration register_part(const mesh::CloudMesh& part, const mesh::MeshOrCloud& reference,
                           const std::optional<Eigen::Isometry3d>& stated);

/// Points with normals, to which another casting of the same kind can be registered: at most 20,000, evenly over it.
cloud::Cloud registration_points(const mesh::CloudMesh& part);

/// Distances of the part's points along the reference's normals (compare::signed_distance), after the slow field
/// between both (slow_field.h) has been subtracted.
/// @throws InputError if the part is another one than the reference
SignedDistances signed_distances(const mesh::CloudMesh& part, const mesh::MeshOrCloud& reference,
                                 const Eigen::Isometry3d& T_reference_part);

} // namespace fettle::find
