#include "job/shape_warnings.h"

#include "geometry/bounding_box.h"
#include "job/plausible.h"

namespace fettle::job {

namespace {

std::vector<std::string> warnings_of(const mesh::MeshRepair& repair, const Eigen::Matrix3Xd& points,
                                     const std::string& name, const units::Units& units)
{
    std::vector<std::string> warnings;
    std::string size = stray_point_warning(points, units);
    if (size.empty()) size = size_warning(geometry::finite_bounding_box(points), points.cols(), units);
    for (const std::string& warning : {mesh::repair_warning(repair), size})
        if (!warning.empty()) warnings.push_back(name + ": " + warning);
    return warnings;
}

} // namespace

std::vector<std::string> shape_warnings(const mesh::ShapeFile& file, const std::string& name, const units::Units& units)
{
    return warnings_of(file.repair, mesh::coordinates_of(file.shape), name, units);
}

std::vector<std::string> shape_warnings(const mesh::CloudMeshFile& file, const std::string& name)
{
    return warnings_of(file.repair, file.part.points.xyz, name, file.units);
}

std::vector<std::string> shape_warnings(const mesh::Mesh& mesh, const mesh::MeshRepair& repair, const std::string& name,
                                        const units::Units& units)
{
    return warnings_of(repair, mesh.vertices, name, units);
}

} // namespace fettle::job
