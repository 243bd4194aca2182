#pragma once

#include "align/icp.h"
#include "align/reference.h"
#include "align/rigid.h"
#include "units/units.h"
#include "json/document.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace fettle::align {

struct AlignOptions {
    std::optional<Eigen::Isometry3d> start; ///< T_reference_scan; without it, all poses are searched
    IcpOptions icp;
};

/// A mode of motion (an eigenvector of the information matrix), and how well the points determine it.
struct MotionMode {
    Twist motion;            ///< unit, in the alignment's frame
    double sd = 0;           ///< standard deviation, mm; of a rotation, at a point one radius from the centre
    bool determined = false; ///< false: the points do not constrain it, so it kept its start value
    bool held = false;       ///< by the options
};

struct Alignment {
    IcpFit fit;
    TwistFrame frame;                  ///< at the scan's centroid on the reference
    std::array<MotionMode, 6> modes;   ///< from the best determined one to the worst
    std::optional<IcpFit> second_best; ///< second best of the poses that the search compared
};

/// Registers a scan to its reference: the rigid motion that puts the scan onto it.
/// @throws InputError if the scan has fewer than six points, or they all coincide
Alignment align(const OrientedPoints& scan, const AlignReference& reference, const AlignOptions& options);

/// Whether the second best pose fits nearly as well, so that chance may have decided.
bool is_ambiguous(const Alignment& alignment);

/// What makes an alignment doubtful, a sentence each: it did not converge, another pose fits nearly as well, motions
/// are undetermined, or little of the scan lies on the reference although `options` do not say so.
std::vector<std::string> doubts(const Alignment& alignment, const IcpOptions& options);

/// "transform", "overlap", residuals over all overlapping points, "sd", "degrees_of_freedom", "next": in `units`.
/// @param matrix  the transform as it is applied, in `units`
/// @param points  the aligned scan, 3xN, mm
json::Value to_json(const Alignment& alignment, const Eigen::Matrix4d& matrix, const Eigen::Matrix3Xd& points,
                    const AlignReference& reference, const units::Units& units);

} // namespace fettle::align
