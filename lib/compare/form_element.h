#pragma once

#include <Eigen/Core>

#include <string>

namespace fettle::compare {

enum class FormKind { flatness, cylindricity, sphericity, straightness };

/// An ideal plane, cylinder or sphere, or a line in a section plane.
struct FormElement {
    FormKind kind = FormKind::flatness;
    Eigen::Vector3d point;     ///< mm: on the plane; on the axis; the centre; on the line
    Eigen::Vector3d direction; ///< unit: normal of plane or line (in its section); axis; unused for a sphere
    double radius = 0;         ///< mm; unused for a plane and a line
    Eigen::Vector3d section = Eigen::Vector3d::Zero(); ///< unit: normal of the section that a line lies in
};

/// Whether the zone lies between parallels and not between radii.
inline bool is_flat(FormKind kind) { return kind == FormKind::flatness || kind == FormKind::straightness; }

/// Signed orthogonal distance (from a line: in its section), mm: + on the side of the normal, or outside.
double deviation(const FormElement& element, const Eigen::Vector3d& point);
Eigen::VectorXd deviations(const FormElement& element, const Eigen::Matrix3Xd& points);

/// One number for each motion; at most five, so that none is allocated on the heap.
using FormVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 5, 1>;
using FormMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 5, 5>;

/// Parameters of small motions of an element, all in mm and of similar size: shifts, tilts · scale and, where there is
/// one, the radius. Plane: 3 (tilt, tilt, shift); cylinder: 5 (shift, shift, tilt, tilt, radius); sphere: 4;
/// line: 2 (tilt, shift).
class FormMotion {
  public:
    /// @param scale  half the size of the part: a tilt moves a point at this distance by the same length as a shift
    FormMotion(const FormElement& element, double scale);
    Eigen::Index parameter_count() const;
    /// ∂ deviation / ∂ motion at zero motion.
    FormVector gradient(const Eigen::Vector3d& point) const;
    FormElement apply(const FormVector& motion) const;

  private:
    FormElement element_;
    double scale_;
    Eigen::Vector3d u_, v_; ///< unit, across the direction
};

} // namespace fettle::compare
