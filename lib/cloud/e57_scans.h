#pragma once

#include <Eigen/Geometry>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::cloud {

/// A column of the records of an E57 scan. The value of an integer `raw` is raw · scale + offset.
struct E57Column {
    enum class Type { float32, float64, integer };
    std::string name;
    Type type = Type::float64;
    std::int64_t min = INT64_MIN, max = INT64_MAX; ///< of raw integers, which are stored as raw - min
    double scale = 1, offset = 0;

    /// Bits of a stored value: of an integer as many as max - min needs, none if they are equal.
    int bits() const;
    double min_value() const { return static_cast<double>(min) * scale + offset; }
    double max_value() const { return static_cast<double>(max) * scale + offset; }
};

/// A scan (data3D) as the XML section describes it.
struct E57Scan {
    Eigen::Isometry3d T_file_scanner = Eigen::Isometry3d::Identity(); ///< m
    bool has_pose = false;                                            ///< the file states it
    std::uint64_t offset = 0;                                         ///< physical, of its binary section
    std::uint64_t records = 0;
    std::vector<E57Column> columns;
};

/// Reads the descriptions of all scans that have points.
/// @throws InputError for XML that is not E57's, and for a column of text, which points do not have
std::vector<E57Scan> parse_e57_scans(std::string_view xml, const std::string& source);

} // namespace fettle::cloud
