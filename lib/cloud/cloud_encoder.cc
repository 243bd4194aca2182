#include "cloud/cloud_encoder.h"

namespace fettle::cloud {

bool is_colour(const Field& field) { return field.name == "rgb" && field.size == 4 && field.count == 1; }

Eigen::Matrix3Xf to_file_coordinates(const Cloud& part, const units::Units& units)
{
    return (part.xyz / units.mm()).cast<float>();
}

std::vector<std::string> element_names(const Field& field)
{
    if (field.count == 1) return {field.name};
    std::vector<std::string> names;
    for (int k = 0; k < field.count; ++k) names.push_back(field.name + '_' + std::to_string(k));
    return names;
}

} // namespace fettle::cloud
