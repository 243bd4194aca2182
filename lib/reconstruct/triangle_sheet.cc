#include "reconstruct/triangle_sheet.h"

#include <algorithm>
#include <limits>
#include <map>

namespace fettle::reconstruct {

bool TriangleSheet::add(const Eigen::Vector3i& corners)
{
    for (int k = 0; k < 3; ++k)
        if (edges_.contains(key(corners[k], corners[(k + 1) % 3]))) return false;
    for (int k = 0; k < 3; ++k)
        edges_.emplace(key(corners[k], corners[(k + 1) % 3]), static_cast<int>(triangles_.size()));
    triangles_.push_back(corners);
    return true;
}

std::vector<std::vector<int>> TriangleSheet::open_loops() const
{
    // The open side of an edge a to b without a triangle b to a runs from b to a.
    std::map<int, std::vector<int>> next; // in the order of the vertices, so that the loops do not depend on hashes
    for (const Eigen::Vector3i& corners : triangles_)
        for (int k = 0; k < 3; ++k) {
            const int from = corners[k], to = corners[(k + 1) % 3];
            if (!edges_.contains(key(to, from))) next[to].push_back(from);
        }
    std::vector<std::vector<int>> loops;
    std::vector<int> way;
    std::unordered_map<int, std::size_t> place; // of a vertex in the way
    for (auto& [start, followers] : next)
        while (!followers.empty()) {
            way = {start};
            place = {{start, 0}};
            while (!way.empty()) {
                std::vector<int>& onward = next[way.back()];
                if (onward.empty()) break; // a loop through this vertex was closed before
                const int vertex = onward.back();
                onward.pop_back();
                const auto seen = place.find(vertex);
                if (seen == place.end()) {
                    place.emplace(vertex, way.size());
                    way.push_back(vertex);
                    continue;
                }
                // The way has come back to a vertex: a loop, which is cut off.
                const auto begin = way.begin() + static_cast<std::ptrdiff_t>(seen->second);
                loops.emplace_back(begin, way.end());
                for (auto v = begin + 1; v != way.end(); ++v) place.erase(*v);
                way.erase(begin + 1, way.end());
                if (way.size() == 1) break;
            }
        }
    return loops;
}

std::vector<Eigen::Vector3i> triangulate_loop(const std::vector<int>& loop, const Eigen::Matrix3Xd& xyz)
{
    const auto n = static_cast<int>(loop.size());
    const auto corner = [&](int k) { return Eigen::Vector3d(xyz.col(loop[static_cast<std::size_t>(k)])); };
    Eigen::MatrixXd area = Eigen::MatrixXd::Zero(n, n); // of the best triangles between corners i and j
    Eigen::MatrixXi middle = Eigen::MatrixXi::Zero(n, n);
    for (int width = 2; width < n; ++width)
        for (int i = 0; i + width < n; ++i) {
            const int j = i + width;
            area(i, j) = std::numeric_limits<double>::infinity();
            for (int k = i + 1; k < j; ++k) {
                const double sum =
                    area(i, k) + area(k, j) + (corner(k) - corner(i)).cross(corner(j) - corner(i)).norm() / 2;
                if (sum < area(i, j)) {
                    area(i, j) = sum;
                    middle(i, j) = k;
                }
            }
        }
    std::vector<Eigen::Vector3i> triangles;
    std::vector<std::pair<int, int>> open = {{0, n - 1}};
    while (!open.empty()) {
        const auto [i, j] = open.back();
        open.pop_back();
        if (j - i < 2) continue;
        const int k = middle(i, j);
        triangles.emplace_back(loop[static_cast<std::size_t>(i)], loop[static_cast<std::size_t>(k)],
                               loop[static_cast<std::size_t>(j)]);
        open.emplace_back(i, k);
        open.emplace_back(k, j);
    }
    return triangles;
}

} // namespace fettle::reconstruct
