#include "fit/input.h"

#include "cloud/fields.h"
#include "core/error.h"
#include "core/text.h"

namespace fettle::fit {

namespace {

Eigen::VectorXi roles(const cloud::Cloud& cloud, const std::string& source)
{
    if (!cloud::has_field(cloud, "role")) return Eigen::VectorXi::Ones(cloud.size());
    const Eigen::VectorXi numbers = cloud::integer_field(cloud, "role");
    for (Eigen::Index i = 0; i < numbers.size(); ++i)
        if (numbers[i] < 0 || numbers[i] > kMaxRole)
            throw core::InputError(source, "point " + std::to_string(i) + ": " +
                                               core::to_text(cloud::field(cloud, "role")[i]) +
                                               " is not a role (0 to 5)");
    return numbers;
}

} // namespace

FitInput fit_input(const job::Job& job, const cloud::Cloud& cloud, const std::string& source)
{
    FitInput input;
    input.xyz = cloud.xyz;
    input.roles = roles(cloud, source);
    if (cloud::has_field(cloud, "curve")) input.curves = cloud::integer_field(cloud, "curve");
    input.job = job;
    input.source = source;
    return input;
}

} // namespace fettle::fit
