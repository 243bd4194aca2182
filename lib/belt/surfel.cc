#include "belt/surfel.h"

#include "cloud/fields.h"
#include "core/error.h"

namespace fettle {

Eigen::Matrix3Xd displaced(const Surfels& surfels)
{
    return surfels.position + surfels.normal * surfels.displacement.asDiagonal();
}

Surfels surfels_of(const Cloud& cloud, const std::string& source)
{
    if (!has_normals(cloud)) throw InputError(source, "no fields normal_x normal_y normal_z");
    const auto or_zero = [&](const std::string& name) -> Eigen::VectorXd {
        return has_field(cloud, name) ? field(cloud, name) : Eigen::VectorXd::Zero(cloud.size());
    };
    Surfels surfels;
    surfels.position = cloud.xyz;
    surfels.normal = normals(cloud);
    for (Eigen::Index i = 0; i < surfels.size(); ++i) {
        const double length = surfels.normal.col(i).norm();
        if (surfels.position.col(i).allFinite() && !(length > 0))
            throw InputError(source, "point " + std::to_string(i) + " has a normal without direction");
        surfels.normal.col(i) /= length;
    }
    surfels.radius = or_zero("radius");
    surfels.displacement = or_zero("displacement");
    surfels.uv.resize(2, surfels.size());
    surfels.uv << or_zero("u").transpose(), or_zero("v").transpose();
    surfels.patch = has_field(cloud, "patch") ? whole_numbers(cloud, "patch") : Eigen::VectorXi::Zero(surfels.size());
    if (has_field(cloud, "area")) surfels.area = field(cloud, "area");
    return surfels;
}

Cloud to_cloud(const Surfels& surfels)
{
    Cloud cloud;
    cloud.xyz = surfels.position;
    cloud.comment = "frame: part";
    set_normals(cloud, surfels.normal);
    set_field(cloud, "radius", surfels.radius);
    set_field(cloud, "u", surfels.uv.row(0).transpose());
    set_field(cloud, "v", surfels.uv.row(1).transpose());
    set_field(cloud, "patch", surfels.patch.cast<double>());
    if (surfels.area.size() > 0) set_field(cloud, "area", surfels.area);
    // A float would lose what a light pass removes from a large displacement.
    set_field(cloud, "displacement", surfels.displacement, 8);
    return cloud;
}

} // namespace fettle
