#include "compare/shape_file.h"

#include "cloud/pcd.h"
#include "core/file.h"
#include "mesh/mesh_file.h"

namespace fettle {

ShapeFile read_shape(const std::string& path, const std::optional<Units>& units)
{
    const std::string bytes = read_whole(path);
    const std::string name = display_name(path);
    if (looks_like_cloud(bytes)) {
        CloudFile file = parse_cloud(bytes, name, units);
        return {std::move(file.cloud), file.units};
    }
    const Units stated = units.value_or(Units{});
    return {parse_mesh(bytes, name, stated.length), stated};
}

Cloud points_of(const MeshOrCloud& shape)
{
    if (const Cloud* cloud = std::get_if<Cloud>(&shape)) return *cloud;
    Cloud vertices;
    vertices.xyz = std::get<Mesh>(shape).vertices;
    return vertices;
}

} // namespace fettle
