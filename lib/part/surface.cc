#include "part/surface.h"

#include "core/constants.h"
#include "surface/basis.h"
#include "surface/patches.h"

#include <Eigen/QR>

#include <cmath>
#include <filesystem>

namespace fettle::part {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

Vector2d read_direction(json::Reader& reader)
{
    const double angle = reader.number("direction_deg") * core::kRadPerDegree;
    return {std::cos(angle), std::sin(angle)};
}

ScalarField2d plane(json::Reader& reader, double mm)
{
    const Vector3d point = mm * reader.vector("point", 3);
    const Vector2d slope = reader.has("slope") ? Vector2d(reader.vector("slope", 2)) : Vector2d::Zero();
    return [=](const Vector2d& p) { return point.z() + slope.dot(p - point.head<2>()); };
}

/// The upper (convex) or lower (concave) half of a sphere or cylinder.
/// @param distance2  squared distance from the centre or axis in the x-y plane, mm²
ScalarField2d round_surface(const ScalarField2d& distance2, double z, double radius, bool concave)
{
    return [=](const Vector2d& p) {
        const double rise2 = radius * radius - distance2(p);
        if (rise2 < 0) return core::kNaN;
        return concave ? z - std::sqrt(rise2) : z + std::sqrt(rise2);
    };
}

ScalarField2d sphere(json::Reader& reader, double mm)
{
    const Vector3d centre = mm * reader.vector("centre", 3);
    const double radius = mm * reader.number("radius", core::Range::positive());
    return round_surface([=](const Vector2d& p) { return (p - centre.head<2>()).squaredNorm(); }, centre.z(), radius,
                         reader.flag_or("concave", false));
}

ScalarField2d cylinder(json::Reader& reader, double mm)
{
    const Vector3d point = mm * reader.vector("point", 3);
    const Vector2d axis = read_direction(reader);
    const Vector2d across(-axis.y(), axis.x());
    const double radius = mm * reader.number("radius", core::Range::positive());
    const ScalarField2d distance2 = [=](const Vector2d& p) { return std::pow(across.dot(p - point.head<2>()), 2); };
    return round_surface(distance2, point.z(), radius, reader.flag_or("concave", false));
}

constexpr int kDegree = 3;

/// Cubic B-spline of one variable.
struct Cubic {
    VectorXd knots, control;

    double operator()(double t) const
    {
        const surface::BasisFunctions basis = surface::basis_functions(knots, kDegree, t);
        return basis.value.dot(control.segment(basis.first, kDegree + 1));
    }
};

/// The spline through values at ascending parameters from 0 to 1; its knots are averages of these (Piegl and Tiller
/// 1997, 9.2.1).
Cubic cubic_through(const VectorXd& at, const VectorXd& values)
{
    Cubic spline{VectorXd(at.size() + kDegree + 1), values};
    spline.knots.head(kDegree + 1).setZero();
    spline.knots.tail(kDegree + 1).setOnes();
    for (Eigen::Index j = 1; j < at.size() - kDegree; ++j) spline.knots[j + kDegree] = at.segment(j, kDegree).mean();
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(at.size(), at.size());
    for (Eigen::Index i = 0; i < at.size(); ++i) {
        const surface::BasisFunctions basis = surface::basis_functions(spline.knots, kDegree, at[i]);
        A.row(i).segment(basis.first, kDegree + 1) = basis.value;
    }
    spline.control = A.householderQr().solve(values);
    return spline;
}

ScalarField2d swept(json::Reader& reader, double mm)
{
    const Vector3d point = mm * reader.vector("point", 3);
    const Vector2d ruling = read_direction(reader);
    const Vector2d across(-ruling.y(), ruling.x());
    const double slope = reader.number_or("slope", 0);
    const Eigen::MatrixXd section = mm * reader.matrix("section", 2);
    const Eigen::Index last = section.rows() - 1;
    if (last < kDegree) reader.refuse("section", "needs 4 points or more, got " + std::to_string(last + 1));
    for (Eigen::Index i = 1; i <= last; ++i)
        if (!(section(i, 0) > section(i - 1, 0)))
            reader.refuse("section", "s must increase from point to point, see point " + std::to_string(i + 1));
    const double first = section(0, 0), length = section(last, 0) - first;
    const VectorXd at = (section.col(0).array() - first) / length;
    const Cubic spline = cubic_through(at, section.col(1));
    return [=](const Vector2d& p) {
        const double t = (across.dot(p - point.head<2>()) - first) / length;
        if (t < 0 || t > 1) return core::kNaN;
        return point.z() + spline(t) + slope * ruling.dot(p - point.head<2>());
    };
}

ScalarField2d patches(json::Reader& reader, const std::string& folder)
{
    const std::string file = (std::filesystem::path(folder) / reader.text("file")).string();
    return [patches = surface::read_patches(file)](const Vector2d& p) {
        for (const surface::Patch& patch : patches)
            if (const double z = surface::height(patch, p); std::isfinite(z)) return z;
        return core::kNaN;
    };
}

} // namespace

ScalarField2d read_part_surface(json::Reader reader, double mm, const std::string& folder)
{
    const std::string type = reader.choice("type", {"plane", "sphere", "cylinder", "swept", "patches"});
    const ScalarField2d surface = type == "plane"      ? plane(reader, mm)
                                  : type == "sphere"   ? sphere(reader, mm)
                                  : type == "cylinder" ? cylinder(reader, mm)
                                  : type == "swept"    ? swept(reader, mm)
                                                       : patches(reader, folder);
    reader.reject_unknown_keys();
    return surface;
}

} // namespace fettle::part
