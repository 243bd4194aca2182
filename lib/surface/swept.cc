#include "surface/shapes.h"

namespace fettle::surface {

namespace {

/// Coordinate across the rulings, divided by `scale`, and along them, mm.
Eigen::Vector2d across_along(const Swept& swept, const Eigen::Vector2d& xy)
{
    const Eigen::Vector2d d = xy - swept.origin;
    return {(swept.ruling.x() * d.y() - swept.ruling.y() * d.x()) / swept.scale, swept.ruling.dot(d)};
}

} // namespace

double height(const Swept& swept, const Eigen::Vector2d& xy)
{
    const Eigen::Vector2d st = across_along(swept, xy);
    const Eigen::Vector4d& c = swept.section;
    return c[0] + st[0] * (c[1] + st[0] * (c[2] + st[0] * c[3])) + swept.slope * st[1];
}

Eigen::Vector2d slope(const Swept& swept, const Eigen::Vector2d& xy)
{
    const double s = across_along(swept, xy)[0];
    const Eigen::Vector4d& c = swept.section;
    const double section_slope = (c[1] + s * (2 * c[2] + s * 3 * c[3])) / swept.scale;
    return swept.slope * swept.ruling + section_slope * Eigen::Vector2d(-swept.ruling.y(), swept.ruling.x());
}

Eigen::VectorXd height_gradient(const Swept& swept, const Eigen::Vector2d& xy)
{
    const Eigen::Vector2d st = across_along(swept, xy);
    const double s = st[0];
    return (Eigen::VectorXd(5) << 1, s, s * s, s * s * s, st[1]).finished();
}

} // namespace fettle::surface
