#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fettle::merge {

/// Points sorted into the cubes of a grid, for what lies near a place: a lookup is a few binary searches among the
/// occupied cubes. Thread-safe.
class VoxelGrid {
  public:
    /// @param xyz  3xN, mm, finite, at least one   @param length  of a cube's edges, mm
    /// @throws InputError if the points extend over more than 2^20 lengths
    VoxelGrid(const Eigen::Matrix3Xd& xyz, double length);

    std::size_t size() const { return keys_.size(); } ///< number of occupied cubes
    /// Indices of the points in occupied cube `voxel`, ascending.
    std::span<const std::uint32_t> points(std::size_t voxel) const
    {
        return std::span(order_).subspan(first_[voxel], first_[voxel + 1] - first_[voxel]);
    }
    /// The occupied ones of the 27 cubes around a place, ascending.
    std::vector<std::size_t> around(const Eigen::Vector3d& place) const;

  private:
    Eigen::Array3d low_;              ///< corner of the grid, mm
    double length_;                   ///< mm
    std::vector<std::uint64_t> keys_; ///< of the occupied cubes, ascending
    std::vector<std::size_t> first_;  ///< cube -> its first point in `order_`; one more at the end
    std::vector<std::uint32_t> order_;
};

/// A scan made smaller without loss of information: what the points in each cube of a grid say together (the cells of
/// the normal distributions transform, Biber & Strasser 2003).
struct VoxelMeans {
    Eigen::Matrix3Xd xyz;                ///< means of the points in each cube, mm
    Eigen::Matrix3Xd normals;            ///< unit; of the plane through a cube and its neighbours; zero: no direction
    Eigen::VectorXd counts;              ///< points in each
    std::vector<std::uint32_t> of_point; ///< the mean that has each point
    double noise = 0;                    ///< standard deviation of a point along the normal, mm
    bool outward = false;                ///< the normals point out of the material; else all to one side, unknown which
};

/// What is known of the side on which a scan was seen.
struct Sides {
    Eigen::Matrix3Xd normals;      ///< of the points, outward; empty: none
    bool has_view = false;         ///< `view` is known
    Eigen::Vector3d view{0, 0, 0}; ///< where the scanner stood, mm
};

/// @param xyz  3xN, mm   @param grid  of the points   @param length  of its cubes, mm
VoxelMeans voxel_means(const Eigen::Matrix3Xd& xyz, const VoxelGrid& grid, const Sides& sides, double length);

} // namespace fettle::merge
