#pragma once

#include "cloud/cloud.h"
#include "cloud/stated_units.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::cloud {

/// A field as declared by the header of a PCD file.
struct PcdColumn {
    std::string name;
    char type = 'F';
    int size = 4;
    int count = 1;

    std::size_t bytes() const { return static_cast<std::size_t>(size) * count; } ///< bytes of one point
};

/// A validated PCD header: all numbers are in range, x y z occur once, and WIDTH · HEIGHT = POINTS. A file of nothing
/// but joints of a robot (joint1, …) and times (t) needs no x y z.
struct PcdHeader {
    enum class Data { ascii, binary, compressed };

    std::vector<PcdColumn> columns;
    std::size_t width = 0;
    std::size_t height = 1;
    std::size_t points = 0;
    Eigen::Vector3d view_origin = Eigen::Vector3d::Zero(); ///< in the units of the file
    Eigen::Quaterniond view_orientation = Eigen::Quaterniond::Identity();
    std::optional<DeclaredUnits> units; ///< of the `# units` comment
    Frame frame = Frame::part;          ///< of the `# frame` comment
    std::string stamp; ///< text of the `# checked` comment of a checked path: the only one that readers keep
    Data data = Data::ascii;
    std::size_t body = 0;  ///< offset of the first byte after the header
    std::size_t lines = 0; ///< number of header lines, for line numbers in messages

    std::size_t stride() const;         ///< bytes of one point
    std::size_t values_per_row() const; ///< numbers in one ascii row
};

/// @param bytes   the file, or at least its header
/// @param source  name for messages
/// @throws InputError with the line and its content
PcdHeader parse_pcd_header(std::string_view bytes, const std::string& source);

/// Checks the size of a binary body against POINTS. The zeros are accepted that PCL may leave after the last point.
/// @param size  of the body, bytes   @param next  bytes after the last point: all, or at least 64 KiB
/// @throws InputError if the size differs
void check_binary_size(const PcdHeader& header, std::size_t size, std::string_view next, const std::string& source);

/// Checks that a PCD header can hold the names of fields from another format.
/// @throws InputError for fields named x, y or z, for control characters, and if all names together exceed a line
void check_field_names(const std::vector<Field>& fields, const std::string& source);

/// True if the first line that is not a comment begins with an entry of a PCD header.
bool looks_like_pcd(std::string_view bytes);

} // namespace fettle::cloud
