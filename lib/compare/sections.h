#pragma once

#include <Eigen/Core>

#include <vector>

namespace fettle::compare {

/// Points near a vertical section plane.
struct Section {
    double offset = 0;                ///< distance of the plane from the origin along its normal, mm
    std::vector<Eigen::Index> points; ///< columns, ascending
};

/// Vertical section planes along `direction` (radians from X, counter-clockwise) at each multiple of `spacing`, each
/// with the points within half of `width` of it. Ascending; planes without points are omitted.
/// @param points  3xN, mm, finite
/// @throws InputError if the planes would be more than ten million
std::vector<Section> vertical_sections(const Eigen::Matrix3Xd& points, double direction, double spacing, double width);

/// Unit normal of the section planes along `direction`.
Eigen::Vector3d section_normal(double direction);

} // namespace fettle::compare
