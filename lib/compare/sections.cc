#include "compare/sections.h"

#include "core/error.h"

#include <cmath>
#include <cstdint>
#include <map>

namespace fettle {

Eigen::Vector3d section_normal(double direction) { return {-std::sin(direction), std::cos(direction), 0}; }

std::vector<Section> vertical_sections(const Eigen::Matrix3Xd& points, double direction, double spacing, double width)
{
    constexpr double kMostPlanes = 1e7; // closer planes than any scan has lines
    const Eigen::RowVectorXd across = section_normal(direction).transpose() * points;
    if (across.size() > 0 && (across.maxCoeff() - across.minCoeff()) / spacing > kMostPlanes)
        throw InputError("the section planes are too close: more than ten million");
    std::map<std::int64_t, Section> sections;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        // A point may be near two planes and more, if the width is larger than the spacing.
        const auto first = static_cast<std::int64_t>(std::ceil((across[i] - width / 2) / spacing));
        const auto last = static_cast<std::int64_t>(std::floor((across[i] + width / 2) / spacing));
        for (std::int64_t k = first; k <= last; ++k) sections[k].points.push_back(i);
    }
    std::vector<Section> found;
    for (auto& [k, section] : sections) {
        section.offset = static_cast<double>(k) * spacing;
        found.push_back(std::move(section));
    }
    return found;
}

} // namespace fettle
