#include "compare/form.h"
#include "json/units.h"

namespace fettle::compare {

namespace {

/// Names in the standards (ISO 12780-1, 12180-1, 12781-1), which have none for spheres.
struct Names {
    const char* form;
    const char* parameter;
    const char* least_squares;
    const char* minimum_zone;
};
Names names_of(FormKind kind)
{
    switch (kind) {
    case FormKind::flatness:
        return {"flatness", "FLTt", "LSPL", "MZPL"};
    case FormKind::cylindricity:
        return {"cylindricity", "CYLt", "LSCY", "MZCY"};
    case FormKind::straightness:
        return {"straightness", "STRt", "LSLI", "MZLI"};
    case FormKind::sphericity:
        break;
    }
    return {"sphericity", nullptr, nullptr, nullptr};
}

void set_element(json::Value& value, const FormElement& e, double mm)
{
    value.set(e.kind == FormKind::sphericity ? "centre" : "point", Eigen::VectorXd(e.point / mm));
    if (is_flat(e.kind)) value.set("normal", Eigen::VectorXd(e.direction));
    if (e.kind == FormKind::cylindricity) value.set("axis", Eigen::VectorXd(e.direction));
    if (e.kind == FormKind::straightness) value.set("axis", Eigen::VectorXd(e.section.cross(e.direction)));
    if (!is_flat(e.kind)) value.set("radius", e.radius / mm);
}

json::Value zone_json(const FormZone& zone, const char* name, const Eigen::Matrix3Xd& points, double mm)
{
    json::Value value;
    if (name != nullptr) value.set("name", name);
    value.set("width", zone.width / mm).set("converged", zone.converged);
    set_element(value, zone.element, mm);
    if (zone.contacts.empty()) {
        value.set("peak", zone.peak / mm).set("valley", zone.valley / mm).set("rms", zone.rms / mm);
        return value;
    }
    Eigen::VectorXd sides(zone.contacts.size());
    for (Eigen::Index i = 0; i < sides.size(); ++i)
        sides[i] = deviation(zone.element, points.col(zone.contacts[i])) < 0 ? -1 : 1;
    value.set("contacts", Eigen::MatrixXd(points(Eigen::all, zone.contacts).transpose() / mm));
    return value.set("sides", sides);
}

} // namespace

json::Value to_json(const Form& form, const Eigen::Matrix3Xd& points, const units::Units& units)
{
    const Names names = names_of(form.least_squares.element.kind);
    const double mm = units.mm();
    json::Value elements, value;
    elements.set("least_squares", zone_json(form.least_squares, names.least_squares, points, mm));
    elements.set("minimum_zone", zone_json(form.minimum_zone, names.minimum_zone, points, mm));
    value.set("kind", "form").set("units", json::to_json(units.length)).set("form", names.form);
    if (names.parameter != nullptr) value.set("parameter", names.parameter);
    value.set("count", points.cols());
    value.set("least_squares", form.least_squares.width / mm).set("minimum_zone", form.minimum_zone.width / mm);
    return value.set("elements", elements);
}

} // namespace fettle::compare
