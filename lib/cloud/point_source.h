#pragma once

#include "cloud/pcd.h"
#include "core/file.h"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace fettle {

/// Some points of a source, mm.
struct PointBlock {
    Eigen::Matrix3Xd xyz;
    Eigen::VectorXd roles; ///< as they stand in the file; empty where the source has none
};

/// Points that are read piece by piece, as often as wanted, by several threads at once.
struct PointSource {
    std::size_t points = 0;
    std::size_t block = 1; ///< points to read at a time: a fixed partition, so that sums do not depend on the threads
    bool has_roles = false;
    /// Reads `count` points from the first-th on.
    std::function<void(std::size_t first, std::size_t count, PointBlock& into)> read;

    std::size_t blocks() const { return (points + block - 1) / block; }
};

/// Calls `use` with the number of each block, from 0, and its points: several at once, in any order.
void for_each_block(const PointSource& points, const std::function<void(std::size_t, const PointBlock&)>& use);

/// The points of a cloud in memory. It holds the cloud.
PointSource point_source(std::shared_ptr<const Cloud> cloud);

/// A cloud's file, checked but not yet in memory. A binary PCD is streamed: no more than a block is held at a time, and
/// a pipe is copied to an unnamed file first (InputFile). Other encodings are read whole.
class CloudStream {
  public:
    /// The checks and messages of read_cloud(). @param path  a file, or "-" for stdin
    /// @throws InputError
    explicit CloudStream(const std::string& path, std::optional<Units> units = std::nullopt);
    /// @param name  of the file, for messages
    CloudStream(std::shared_ptr<const InputFile> file, const std::string& name, std::optional<Units> units);

    const PointSource& points() const { return points_; }
    /// Some of the points, with all fields.
    Cloud part(std::size_t first, std::size_t count) const { return part_(first, count); }
    /// Of the file.
    const Units& units() const { return units_; }
    /// All of it in memory, with all fields.
    std::shared_ptr<const Cloud> cloud() const;

  private:
    std::function<std::shared_ptr<const Cloud>()> whole_;
    std::function<Cloud(std::size_t first, std::size_t count)> part_;
    PointSource points_;
    Units units_;
};

} // namespace fettle
