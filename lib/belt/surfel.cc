#include "belt/surfel.h"

#include "cloud/fields.h"
#include "core/error.h"
#include "core/file.h"
#include "mesh/shape_file.h"

namespace fettle::belt {

Eigen::Matrix3Xd displaced_positions(const Surfels& surfels)
{
    return surfels.position + surfels.normal * surfels.displacement.asDiagonal();
}

Eigen::Matrix3Xd outer_positions(const Surfels& surfels)
{
    Eigen::Matrix3Xd outer = surfels.position;
    for (Eigen::Index i = 0; i < surfels.size(); ++i)
        if (surfels.displacement[i] > 0) outer.col(i) += surfels.displacement[i] * surfels.normal.col(i);
    return outer;
}

Surfels surfels_from_cloud(const cloud::Cloud& cloud, const std::string& source)
{
    if (!cloud::has_normals(cloud)) throw core::InputError(source, "no fields normal_x normal_y normal_z");
    const auto field_or_zero = [&](const std::string& name) -> Eigen::VectorXd {
        return cloud::has_field(cloud, name) ? cloud::field(cloud, name) : Eigen::VectorXd::Zero(cloud.size());
    };
    Surfels surfels;
    surfels.position = cloud.xyz;
    surfels.normal = cloud::normals(cloud);
    for (Eigen::Index i = 0; i < surfels.size(); ++i) {
        const double length = surfels.normal.col(i).norm();
        if (surfels.position.col(i).allFinite() && !(length > 0))
            throw core::InputError(source, "point " + std::to_string(i) + " has a zero normal");
        surfels.normal.col(i) /= length;
    }
    surfels.radius = field_or_zero("radius");
    surfels.displacement = field_or_zero("displacement");
    surfels.uv.resize(2, surfels.size());
    surfels.uv << field_or_zero("u").transpose(), field_or_zero("v").transpose();
    surfels.patch =
        cloud::has_field(cloud, "patch") ? cloud::integer_field(cloud, "patch") : Eigen::VectorXi::Zero(surfels.size());
    if (cloud::has_field(cloud, "area")) surfels.area = cloud::field(cloud, "area");
    return surfels;
}

SurfelFile read_surfels(const std::string& path, const std::optional<units::Units::Length>& unit)
{
    cloud::CloudFile file = cloud::read_cloud(path, mesh::resolve_file_units(unit));
    Surfels surfels = surfels_from_cloud(file.cloud, core::display_name(path));
    return {std::move(file), std::move(surfels)};
}

cloud::Cloud to_cloud(const Surfels& surfels)
{
    cloud::Cloud cloud;
    cloud.xyz = surfels.position;
    cloud.comment = "frame: part";
    cloud::set_normals(cloud, surfels.normal);
    cloud::set_field(cloud, "radius", surfels.radius);
    cloud::set_field(cloud, "u", surfels.uv.row(0).transpose());
    cloud::set_field(cloud, "v", surfels.uv.row(1).transpose());
    cloud::set_field(cloud, "patch", surfels.patch.cast<double>());
    if (surfels.area.size() > 0) cloud::set_field(cloud, "area", surfels.area);
    // Double: single precision would lose a light pass on a large displacement.
    cloud::set_field(cloud, "displacement", surfels.displacement, 8);
    return cloud;
}

} // namespace fettle::belt
