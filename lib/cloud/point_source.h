#pragma once

#include "cloud/pcd.h"
#include "core/file.h"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace fettle::cloud {

/// Consecutive points of a source, mm.
struct PointBlock {
    Eigen::Matrix3Xd xyz;
    Eigen::VectorXd roles;    ///< field `role`, unchecked; empty if the source has none
    Eigen::VectorXd normal_z; ///< z of the unit normals; NaN: none; empty if the source has none
};

/// Points that are read in blocks, repeatedly if needed, by several threads at once.
struct PointSource {
    std::size_t points = 0;
    std::size_t block_size = 1; ///< points of a block: a fixed partition, so that sums do not depend on the threads
    bool has_roles = false;
    bool has_normals = false;
    /// Reads `count` points from point `first` on.
    std::function<void(std::size_t first, std::size_t count, PointBlock& into)> read;

    std::size_t block_count() const { return (points + block_size - 1) / block_size; }
};

/// Calls `use` with the index of each block and its points, in parallel and in any order.
void for_each_block(const PointSource& points, const std::function<void(std::size_t, const PointBlock&)>& use);

/// Source of the points of a cloud in memory; it shares ownership of the cloud.
PointSource make_point_source(std::shared_ptr<const Cloud> cloud);

/// Validated file of a point cloud. A binary PCD is streamed: only the blocks being processed are in memory, and a pipe
/// is copied to an unnamed file first (InputFile). Other formats are read entirely.
class CloudStream {
  public:
    /// @param path  a file, or "-" for stdin
    /// @throws InputError as read_cloud()
    explicit CloudStream(const std::string& path, std::optional<units::Units> units = std::nullopt);
    /// @param name  of the file, for messages
    CloudStream(std::shared_ptr<const core::InputFile> file, const std::string& name,
                std::optional<units::Units> units);

    const PointSource& points() const { return points_; }
    /// Reads consecutive points with all their fields.
    Cloud slice(std::size_t first, std::size_t count) const { return part_(first, count); }
    /// Units of the file.
    const units::Units& units() const { return units_; }
    Frame frame() const { return frame_; }
    /// Reads all points with all their fields.
    std::shared_ptr<const Cloud> read_all() const;

  private:
    std::function<std::shared_ptr<const Cloud>()> load_;
    std::function<Cloud(std::size_t first, std::size_t count)> part_;
    PointSource points_;
    units::Units units_;
    Frame frame_ = Frame::part;
};

} // namespace fettle::cloud
