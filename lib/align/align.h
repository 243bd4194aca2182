#pragma once

#include "align/icp.h"
#include "align/reference.h"
#include "align/rigid.h"
#include "units/units.h"
#include "json/document.h"

#include <array>
#include <optional>

namespace fettle {

struct AlignOptions {
    std::optional<Eigen::Isometry3d> start; ///< of T_reference_scan; nothing: looked for everywhere
    IcpOptions icp;
};

/// How well one direction of motion is determined.
struct Freedom {
    Twist motion;            ///< unit, in the alignment's frame
    double sd = 0;           ///< mm; of a turn: of a point one radius from the centre
    bool determined = false; ///< false: the points say nothing about it, it is as it was at the start
    bool held = false;       ///< by the options
};

struct Alignment {
    IcpFit fit;
    TwistFrame frame;                ///< about the scan's centroid on the reference
    std::array<Freedom, 6> freedoms; ///< from the best determined one to the worst
    std::optional<IcpFit> next;      ///< the best of the other places that were looked at
};

/// The rigid motion that puts a scan onto its reference.
/// @throws InputError if the scan has fewer than six points, or they are all one
Alignment align(const OrientedPoints& scan, const AlignReference& reference, const AlignOptions& options);

/// Does the next best place fit nearly as well, so that chance may have decided?
bool ambiguous(const Alignment& alignment);

/// "transform", "overlap", residuals over all points that overlap, "sd", "degrees_of_freedom", "next": in `units`.
/// @param matrix  the transform as it is applied, in `units`
/// @param points  of the scan as aligned, 3xN, mm
json::Value to_json(const Alignment& alignment, const Eigen::Matrix4d& matrix, const Eigen::Matrix3Xd& points,
                    const AlignReference& reference, const Units& units);

} // namespace fettle
