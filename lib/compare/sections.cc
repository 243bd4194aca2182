#include "compare/sections.h"

#include "core/error.h"

#include <cmath>
#include <cstdint>
#include <map>

namespace fettle::compare {

Eigen::Vector3d section_normal(double direction) { return {-std::sin(direction), std::cos(direction), 0}; }

std::vector<Section> vertical_sections(const Eigen::Matrix3Xd& points, double direction, double spacing, double width)
{
    constexpr double kMaxPlanes = 1e7; // more than any scan has lines
    const Eigen::RowVectorXd offsets = section_normal(direction).transpose() * points;
    if (offsets.size() > 0 && (offsets.maxCoeff() - offsets.minCoeff()) / spacing > kMaxPlanes)
        throw core::InputError("more than ten million section planes: the spacing is too small");
    std::map<std::int64_t, Section> sections;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        // If the width exceeds the spacing, a point may be near several planes.
        const auto first = static_cast<std::int64_t>(std::ceil((offsets[i] - width / 2) / spacing));
        const auto last = static_cast<std::int64_t>(std::floor((offsets[i] + width / 2) / spacing));
        for (std::int64_t k = first; k <= last; ++k) sections[k].points.push_back(i);
    }
    std::vector<Section> ascending;
    for (auto& [k, section] : sections) {
        section.offset = static_cast<double>(k) * spacing;
        ascending.push_back(std::move(section));
    }
    return ascending;
}

} // namespace fettle::compare
