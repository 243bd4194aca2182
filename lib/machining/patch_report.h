#pragma once

#include "cloud/cloud.h"
#include "machining/patch_error.h"
#include "json/document.h"

#include <Eigen/Core>

#include <cstddef>
#include <iosfwd>

namespace fettle::machining {

/// Patches judged by one error each: mu, or the distance of the centroid from the closest point of the design.
struct PatchVerdict {
    PatchErrors patches;
    Eigen::VectorXd closest;        ///< closest_errors(), mm; empty if not computed
    bool use_closest_point = false; ///< whether `closest` is the error; else mu
    PatchTolerances tolerances;

    const Eigen::VectorXd& error() const { return use_closest_point ? closest : patches.mu; } ///< NaN: undefined
    /// Areas that belong to the errors, mm²: of the design's triangles; where only the closest point defines an error,
    /// of the machined ones.
    Eigen::VectorXd area() const;
};

/// Number of patches that are over-cut beyond the tolerance.
std::size_t count_over_cut(const PatchVerdict& verdict);

/// Statistics over all patches and by class (count, area, volume), the counts of undefined patches by reason, and the
/// difference of both errors on slopes up to 45 degrees and on steeper ones.
json::Value to_json(const PatchVerdict& verdict);

/// One point at the centroid of each patch. Fields: error, closest (if computed), d, class, normal of the design, rgb.
cloud::Cloud to_cloud(const PatchVerdict& verdict);

/// The machined vertices with the field error, along Z. @param z_error  PatchErrors::z_error
cloud::Cloud z_errors_to_cloud(const mesh::Mesh& machined, const Eigen::VectorXd& z_error);

/// CSV with a row for each patch; for an undefined patch the class is the reason.
void write_csv(std::ostream& out, const PatchVerdict& verdict);

} // namespace fettle::machining
