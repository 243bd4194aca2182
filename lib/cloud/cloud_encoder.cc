#include "cloud/cloud_encoder.h"

#include "cloud/fields.h"

namespace fettle {

bool is_colour(const Field& field) { return field.name == "rgb" && field.size == 4 && field.count == 1; }

std::vector<Field> converted(const Cloud& part, const Units& units)
{
    std::vector<Field> fields = part.fields;
    for (Field& field : fields)
        if (const double factor = to_base(units, field_dimension(field.name)); factor != 1) scale(field, 1, factor);
    return fields;
}

Eigen::Matrix3Xf places(const Cloud& part, const Units& units) { return (part.xyz / units.mm()).cast<float>(); }

std::vector<std::string> element_names(const Field& field)
{
    if (field.count == 1) return {field.name};
    std::vector<std::string> names;
    for (int k = 0; k < field.count; ++k) names.push_back(field.name + '_' + std::to_string(k));
    return names;
}

} // namespace fettle
