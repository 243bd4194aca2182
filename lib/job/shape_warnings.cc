#include "job/shape_warnings.h"

#include "geometry/bounding_box.h"
#include "job/plausible.h"

namespace fettle::job {

std::vector<std::string> shape_warnings(const mesh::ShapeFile& file, const std::string& name, const units::Units& units)
{
    const Eigen::Matrix3Xd& points = mesh::coordinates_of(file.shape);
    std::vector<std::string> warnings;
    for (const std::string& warning :
         {mesh::repair_warning(file.repair), size_warning(geometry::finite_bounding_box(points), points.cols(), units)})
        if (!warning.empty()) warnings.push_back(name + ": " + warning);
    return warnings;
}

} // namespace fettle::job
