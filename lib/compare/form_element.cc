#include "compare/form_element.h"

#include <Eigen/Geometry>

namespace fettle::compare {

namespace {

Eigen::Vector3d radial_part(const Eigen::Vector3d& from_axis_point, const Eigen::Vector3d& axis)
{
    return from_axis_point - axis.dot(from_axis_point) * axis;
}

} // namespace

double deviation(const FormElement& element, const Eigen::Vector3d& point)
{
    const Eigen::Vector3d q = point - element.point;
    if (is_flat(element.kind)) return element.direction.dot(q);
    if (element.kind == FormKind::sphericity) return q.norm() - element.radius;
    return radial_part(q, element.direction).norm() - element.radius;
}

Eigen::VectorXd deviations(const FormElement& element, const Eigen::Matrix3Xd& points)
{
    Eigen::VectorXd d(points.cols());
    for (Eigen::Index i = 0; i < d.size(); ++i) d[i] = deviation(element, points.col(i));
    return d;
}

FormMotion::FormMotion(const FormElement& element, double scale) : element_(element), scale_(scale)
{
    u_ = element.kind == FormKind::straightness ? Eigen::Vector3d(element.section.cross(element.direction))
                                                : element.direction.unitOrthogonal();
    v_ = element.direction.cross(u_);
}

Eigen::Index FormMotion::parameter_count() const
{
    switch (element_.kind) {
    case FormKind::flatness:
        return 3;
    case FormKind::cylindricity:
        return 5;
    case FormKind::sphericity:
        return 4;
    case FormKind::straightness:
        break;
    }
    return 2;
}

FormVector FormMotion::gradient(const Eigen::Vector3d& point) const
{
    const Eigen::Vector3d q = point - element_.point;
    FormVector g(parameter_count());
    if (element_.kind == FormKind::flatness) {
        g << u_.dot(q) / scale_, v_.dot(q) / scale_, -1;
    } else if (element_.kind == FormKind::straightness) {
        g << u_.dot(q) / scale_, -1;
    } else if (element_.kind == FormKind::sphericity) {
        g << -q.normalized(), -1;
    } else {
        const Eigen::Vector3d outward = radial_part(q, element_.direction).normalized();
        const double along = element_.direction.dot(q) / scale_;
        g << -outward.dot(u_), -outward.dot(v_), -along * outward.dot(u_), -along * outward.dot(v_), -1;
    }
    return g;
}

FormElement FormMotion::apply(const FormVector& motion) const
{
    FormElement element = element_;
    if (element.kind == FormKind::flatness) {
        element.direction = (element.direction + (motion[0] * u_ + motion[1] * v_) / scale_).normalized();
        element.point += motion[2] * element_.direction;
    } else if (element.kind == FormKind::straightness) {
        element.direction = (element.direction + motion[0] * u_ / scale_).normalized();
        element.point += motion[1] * element_.direction;
    } else if (element.kind == FormKind::sphericity) {
        element.point += motion.head<3>();
        element.radius += motion[3];
    } else {
        element.point += motion[0] * u_ + motion[1] * v_;
        element.direction = (element.direction + (motion[2] * u_ + motion[3] * v_) / scale_).normalized();
        element.radius += motion[4];
    }
    return element;
}

} // namespace fettle::compare
