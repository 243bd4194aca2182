#include "fit/input.h"

#include "cloud/fields.h"
#include "core/error.h"
#include "core/text.h"

namespace fettle {

namespace {

Eigen::VectorXi roles(const Cloud& cloud, const std::string& source)
{
    if (!has_field(cloud, "role")) return Eigen::VectorXi::Ones(cloud.size());
    constexpr int kMostRole = 5;
    const Eigen::VectorXi numbers = whole_numbers(cloud, "role");
    for (Eigen::Index i = 0; i < numbers.size(); ++i)
        if (numbers[i] < 0 || numbers[i] > kMostRole)
            throw InputError(source, "point " + std::to_string(i) + ": " + to_text(field(cloud, "role")[i]) +
                                         " is no role (0 to 5)");
    return numbers;
}

} // namespace

FitInput fit_input(const Job& job, const Cloud& cloud, const std::string& source)
{
    FitInput input;
    input.xyz = cloud.xyz;
    input.roles = roles(cloud, source);
    if (has_field(cloud, "curve")) input.curves = whole_numbers(cloud, "curve");
    input.job = job;
    input.source = source;
    return input;
}

} // namespace fettle
