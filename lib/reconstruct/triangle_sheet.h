#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace fettle::reconstruct {

/// Triangles that grow one by one into an orientable surface: each directed edge belongs to at most one triangle, and
/// so no edge to more than two.
class TriangleSheet {
  public:
    /// Adds a triangle, counter-clockwise seen from outside. @return  false if one of its edges is taken
    bool add(const Eigen::Vector3i& corners);

    const std::vector<Eigen::Vector3i>& triangles() const { return triangles_; }
    /// Closed lines of vertices around what is open, on the left of their direction.
    std::vector<std::vector<int>> open_loops() const;

  private:
    static std::uint64_t key(int from, int to)
    {
        return std::uint64_t{static_cast<std::uint32_t>(from)} << 32 | static_cast<std::uint32_t>(to);
    }

    std::vector<Eigen::Vector3i> triangles_;
    std::unordered_map<std::uint64_t, int> edges_; ///< directed edge -> its triangle
};

/// Triangles in a closed line of vertices with the smallest total area (Barequet & Sharir, Filling gaps in the boundary
/// of a polyhedron, 1995). @param loop  at least three   @param xyz  of all vertices
std::vector<Eigen::Vector3i> triangulate_loop(const std::vector<int>& loop, const Eigen::Matrix3Xd& xyz);

} // namespace fettle::reconstruct
