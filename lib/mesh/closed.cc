#include "mesh/closed.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace fettle::mesh {

bool is_closed(const Mesh& mesh)
{
    std::vector<std::pair<int, int>> edges; // directed
    for (const auto t : mesh.triangles.colwise())
        for (int k = 0; k < 3; ++k) edges.emplace_back(t[k], t[(k + 1) % 3]);
    std::ranges::sort(edges);
    if (std::ranges::adjacent_find(edges) != edges.end()) return false;
    return std::ranges::all_of(
        edges, [&](const auto& edge) { return std::ranges::binary_search(edges, std::pair(edge.second, edge.first)); });
}

} // namespace fettle::mesh
