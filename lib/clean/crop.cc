#include "clean/crop.h"

#include "core/constants.h"
#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"
#include "job/job.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

namespace fettle::clean {
namespace {

std::vector<double> parse_numbers(std::string_view list)
{
    std::vector<double> numbers;
    for (std::size_t begin = 0; begin <= list.size();) {
        const std::size_t end = std::min(list.find(',', begin), list.size());
        const std::string_view word = list.substr(begin, end - begin);
        const std::optional<double> number = core::parse_number(word);
        if (!number || !std::isfinite(*number)) throw core::InputError(core::in_quotes(word) + " is not a number");
        numbers.push_back(*number);
        begin = end + 1;
    }
    return numbers;
}

Region parse_box(const std::vector<double>& n)
{
    if (n.size() != 6)
        throw core::InputError("expected box:X0,Y0,Z0,X1,Y1,Z1, got " + std::to_string(n.size()) + " numbers");
    const Eigen::AlignedBox3d box(Eigen::Vector3d(n[0], n[1], n[2]), Eigen::Vector3d(n[3], n[4], n[5]));
    if (!(box.sizes().minCoeff() > 0)) throw core::InputError("X0, Y0, Z0 of a box must be less than X1, Y1, Z1");
    return box;
}

Region parse_sphere(const std::vector<double>& n)
{
    if (n.size() != 4)
        throw core::InputError("expected sphere:X,Y,Z,RADIUS, got " + std::to_string(n.size()) + " numbers");
    if (!(n[3] > 0))
        throw core::InputError("the radius of a sphere must be positive, got " + core::to_short_text(n[3]));
    return Sphere{{n[0], n[1], n[2]}, n[3]};
}

Region parse_prism(const std::vector<double>& n)
{
    if (n.size() < 8 || n.size() % 2 != 0)
        throw core::InputError("expected polygon:Z0,Z1,X1,Y1,X2,Y2,X3,Y3,…, got " + std::to_string(n.size()) +
                               " numbers");
    if (!(n[0] < n[1])) throw core::InputError("Z0 of a polygon must be less than Z1");
    return Prism{Eigen::Map<const Eigen::Matrix2Xd>(n.data() + 2, 2, static_cast<Eigen::Index>(n.size() / 2 - 1)), n[0],
                 n[1]};
}

StatedRegion region_of_job(const std::string& file)
{
    const job::Job job = job::read_job(file);
    const auto& boundary = job.sampling.cols() > 0 ? job.sampling : job.anomaly;
    return {Prism{boundary.topRows<2>(), -core::kInfinity, core::kInfinity,
                  job.T_part_job.value_or(Eigen::Isometry3d::Identity()).inverse()},
            job.units};
}

} // namespace

StatedRegion parse_region(const std::string& text)
{
    const auto after = [&](std::string_view prefix) {
        return parse_numbers(std::string_view(text).substr(prefix.size()));
    };
    if (text.starts_with("box:")) return {parse_box(after("box:")), {}};
    if (text.starts_with("sphere:")) return {parse_sphere(after("sphere:")), {}};
    if (text.starts_with("polygon:")) return {parse_prism(after("polygon:")), {}};
    return region_of_job(text);
}

Region scaled(Region region, double factor)
{
    if (auto* box = std::get_if<Eigen::AlignedBox3d>(&region))
        return Eigen::AlignedBox3d(factor * box->min(), factor * box->max());
    if (auto* sphere = std::get_if<Sphere>(&region)) return Sphere{factor * sphere->centre, factor * sphere->radius};
    const auto& prism = std::get<Prism>(region);
    return Prism{factor * prism.polygon, factor * prism.min_z, factor * prism.max_z, prism.T_prism_part};
}

Region in_job_frame(Region region)
{
    if (auto* prism = std::get_if<Prism>(&region)) prism->T_prism_part.setIdentity();
    return region;
}

bool contains(const Region& region, const Eigen::Vector3d& point)
{
    if (const auto* box = std::get_if<Eigen::AlignedBox3d>(&region)) return box->contains(point);
    if (const auto* sphere = std::get_if<Sphere>(&region)) return (point - sphere->centre).norm() <= sphere->radius;
    const auto& prism = std::get<Prism>(region);
    const Eigen::Vector3d p = prism.T_prism_part * point;
    return p.z() >= prism.min_z && p.z() <= prism.max_z && job::contains(prism.polygon, p.head<2>());
}

} // namespace fettle::clean
