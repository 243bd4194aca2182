#pragma once

#include "job/job.h"
#include "units/units.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <string>

namespace fettle::job {

/// Checks a part's bounding box against the job's boundary. A mismatch suggests a wrong unit or another part's job.
/// @param box  M, mm; NaN: the part has no points
/// @return a sentence for a warning, empty if the box is plausible
std::string part_box_warning(const Eigen::AlignedBox3d& box, const Job& job);

/// Checks the size of a part without a job: no casting that is ground is shorter than a few millimetres or longer than
/// a hundred metres, but one in metres or inches seems so if it is read in mm, and one in mm if it is read in metres.
/// @param box     mm; NaN or empty: the part has no points
/// @param points  of the cloud, or vertices of the mesh: a few may be touches or a sketch, of any size
/// @param units   in which the size is stated
/// @return a sentence for a warning, empty if the size is plausible
std::string size_warning(const Eigen::AlignedBox3d& box, Eigen::Index points, const units::Units& units);

/// Checks for a point far from all others (geometry/stray_point.h), as damaged files have it.
/// @param points  3xN, mm   @return a sentence that names it, empty if there is none
std::string stray_point_warning(const Eigen::Matrix3Xd& points, const units::Units& units);

/// Refuses points with a stray one, for what depends on how far they extend.
/// @param source  of the points, for messages   @throws InputError with stray_point_warning()
void require_no_stray_point(const Eigen::Matrix3Xd& points, const units::Units& units, const std::string& source);

/// A length that parts go with, and how much longer or shorter than it a part plausibly is.
struct LengthScale {
    std::string name;  ///< "the cutter's diameter"
    double length = 0; ///< mm
    double min_ratio = 0, max_ratio = 0;
};

/// Compares the diagonal of a part in plan view with a scale. A mismatch suggests a wrong unit.
/// @param size  of the part along x, y, z, mm; NaN: the part has no points   @param units  of the message
/// @return a sentence for a warning, empty if the size is plausible
std::string scale_warning(const std::string& part, const Eigen::Vector3d& size, const units::Units& units,
                          const LengthScale& scale);

/// Checks whether touches are above or below the job's boundary points by more than the boundary's length, which
/// suggests a wrong unit or a part that has moved since the job was taught.
/// @param touches  3xN, M, mm; NaN: no touch
/// @return a sentence for a warning, empty if the heights are plausible or if no boundary point has a z
std::string touch_height_warning(const Eigen::Matrix3Xd& touches, const Job& job);

/// Touches with their roles (docs/conventions.md), as a fit takes them.
struct PlacedTouches {
    Eigen::Matrix3Xd xyz;  ///< 3xN, M, mm
    Eigen::VectorXi roles; ///< N
};

/// Checks the touches' places against the sampling boundary S, by more than the probe's accuracy and its tip's radius.
/// Corners of B (role 0), the job's own points of S, estimated points (3) and points without a height are not looked
/// at, nor is anything without an S.
/// @param source  the touches' name in messages
/// @return a sentence for a warning if some lie outside S, else empty
/// @throws InputError if half of them or more do: such touches are another job's, or the part has moved
std::string check_touch_places(const PlacedTouches& touches, const Job& job, const std::string& source);

/// Checks the heights of the job's boundary points against the touch next to each (of those that
/// check_touch_places() looks at).
/// @return a sentence for a warning if more than half of those with a z are farther above or below it than a slope of
///         45° and the tolerance explain, else empty
std::string boundary_height_warning(const PlacedTouches& touches, const Job& job);

} // namespace fettle::job
