#pragma once

#include <Eigen/Core>

#include <string>
#include <string_view>

namespace fettle::job {

/// Which points of a list of picked ones are wanted.
struct WantedPicks {
    char boundary = 0; ///< 'B' or 'S': of a list with labels B1, B2, …, S1, …, as a page of fettle-view --pick writes
                       ///< it, those of this boundary; 0, or other labels: all
    bool may_be_flat = false; ///< points may have no z, which is NaN then
};

/// Points picked on a scan in a viewer, 3xN, in the order of picking, in the scan's unit. CloudCompare's picking list,
/// or that of a page: lines "x,y,z", with index and label first. A cloud that CloudCompare has saved as text: numbers
/// between blanks, tabs or semicolons, of which the first three count, or those below X, Y and Z in a first line
/// "//X Y Z". The output of pcd_viewer: the lines "Point index picked: … - [x, y, z]" count and others are skipped.
/// Comments begin with #.
/// @throws InputError that names a malformed line, or if there are no points
Eigen::Matrix3Xd read_picked_points(const std::string& path, const WantedPicks& wanted = {});
Eigen::Matrix3Xd parse_picked_points(std::string_view bytes, const std::string& source, const WantedPicks& wanted = {});

/// True if a list has points labelled as corners of B and as corners of S.
/// @param bytes  the list
bool holds_both_boundaries(std::string_view bytes);

} // namespace fettle::job
