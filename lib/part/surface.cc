#include "part/surface.h"

#include "core/constants.h"
#include "surface/patches.h"

#include <unsupported/Eigen/Splines>

#include <cmath>
#include <filesystem>

namespace fettle {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();

Vector2d heading(json::Reader& reader)
{
    const double angle = reader.number("direction_deg") * kRadPerDegree;
    return {std::cos(angle), std::sin(angle)};
}

OverPlane plane(json::Reader& reader, double mm)
{
    const Vector3d point = mm * reader.vector("point", 3);
    const Vector2d slope = reader.has("slope") ? Vector2d(reader.vector("slope", 2)) : Vector2d::Zero();
    return [=](const Vector2d& p) { return point.z() + slope.dot(p - point.head<2>()); };
}

/// The upper (convex) or lower (concave) half over a distance from the centre or axis.
OverPlane round_over(const OverPlane& distance2, double z, double radius, bool concave)
{
    return [=](const Vector2d& p) {
        const double rise2 = radius * radius - distance2(p);
        if (rise2 < 0) return kNowhere;
        return concave ? z - std::sqrt(rise2) : z + std::sqrt(rise2);
    };
}

OverPlane sphere(json::Reader& reader, double mm)
{
    const Vector3d centre = mm * reader.vector("centre", 3);
    const double radius = mm * reader.number("radius", Range::positive());
    return round_over([=](const Vector2d& p) { return (p - centre.head<2>()).squaredNorm(); }, centre.z(), radius,
                      reader.flag_or("concave", false));
}

OverPlane cylinder(json::Reader& reader, double mm)
{
    const Vector3d point = mm * reader.vector("point", 3);
    const Vector2d axis = heading(reader);
    const Vector2d across(-axis.y(), axis.x());
    const double radius = mm * reader.number("radius", Range::positive());
    const OverPlane distance2 = [=](const Vector2d& p) { return std::pow(across.dot(p - point.head<2>()), 2); };
    return round_over(distance2, point.z(), radius, reader.flag_or("concave", false));
}

OverPlane swept(json::Reader& reader, double mm)
{
    const Vector3d point = mm * reader.vector("point", 3);
    const Vector2d ruling = heading(reader);
    const Vector2d across(-ruling.y(), ruling.x());
    const double slope = reader.number_or("slope", 0);
    const Eigen::MatrixXd section = mm * reader.matrix("section", 2);
    const Eigen::Index last = section.rows() - 1;
    constexpr int kDegree = 3;
    if (last < kDegree) reader.refuse("section", "needs 4 points or more, got " + std::to_string(last + 1));
    for (Eigen::Index i = 1; i <= last; ++i)
        if (!(section(i, 0) > section(i - 1, 0)))
            reader.refuse("section", "s must grow from point to point, see point " + std::to_string(i + 1));
    const double least = section(0, 0), length = section(last, 0) - least;
    using Spline1d = Eigen::Spline<double, 1>;
    const Eigen::RowVectorXd at = (section.col(0).array() - least).transpose() / length;
    const Spline1d spline = Eigen::SplineFitting<Spline1d>::Interpolate(section.col(1).transpose(), kDegree, at);
    return [=](const Vector2d& p) {
        const double t = (across.dot(p - point.head<2>()) - least) / length;
        if (t < 0 || t > 1) return kNowhere;
        return point.z() + spline(t)(0) + slope * ruling.dot(p - point.head<2>());
    };
}

OverPlane patches(json::Reader& reader, const std::string& folder)
{
    const std::string file = (std::filesystem::path(folder) / reader.text("file")).string();
    return [patches = read_patches(file)](const Vector2d& p) {
        for (const Patch& patch : patches)
            if (const double z = height(patch, p); std::isfinite(z)) return z;
        return kNowhere;
    };
}

} // namespace

OverPlane read_part_surface(json::Reader reader, double mm, const std::string& folder)
{
    const std::string type = reader.choice("type", {"plane", "sphere", "cylinder", "swept", "patches"});
    const OverPlane surface = type == "plane"      ? plane(reader, mm)
                              : type == "sphere"   ? sphere(reader, mm)
                              : type == "cylinder" ? cylinder(reader, mm)
                              : type == "swept"    ? swept(reader, mm)
                                                   : patches(reader, folder);
    reader.done();
    return surface;
}

} // namespace fettle
