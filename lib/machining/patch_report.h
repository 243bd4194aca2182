#pragma once

#include "cloud/cloud.h"
#include "machining/patch_error.h"
#include "json/document.h"

#include <Eigen/Core>

#include <cstddef>
#include <iosfwd>

namespace fettle {

/// A verdict on patches by one error each: mu, or the distance of the centre from the design's closest point.
struct PatchVerdict {
    PatchErrors patches;
    Eigen::VectorXd closest; ///< signed, mm, of each centre; empty if it was not asked for
    bool by_closest = false; ///< which of them decides
    PatchTolerances tolerances;

    const Eigen::VectorXd& error() const { return by_closest ? closest : patches.mu; } ///< NaN: undefined
};

/// How many patches are over-cut beyond the tolerance.
std::size_t over_cut(const PatchVerdict& verdict);

/// Numbers over all patches, by class (count, area, volume), why others are undefined, and how far the two errors are
/// apart on slopes up to 45 degrees and on steeper ones.
json::Value to_json(const PatchVerdict& verdict);

/// A point at the centre of each patch: error, closest (if there), d, class, normal of the design, rgb.
Cloud to_cloud(const PatchVerdict& verdict);

/// The data sheet: a row for each patch; why it is undefined stands for the class.
void write_csv(std::ostream& out, const PatchVerdict& verdict);

} // namespace fettle
