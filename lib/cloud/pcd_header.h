#pragma once

#include "cloud/cloud.h"
#include "cloud/stated_units.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fettle {

/// One field as the header of a PCD file declares it.
struct PcdColumn {
    std::string name;
    char type = 'F';
    int size = 4;
    int count = 1;

    std::size_t bytes() const { return static_cast<std::size_t>(size) * static_cast<std::size_t>(count); }
};

/// The header of a PCD file, checked: every number in range, x y z there once, WIDTH · HEIGHT = POINTS.
struct PcdHeader {
    enum class Data { ascii, binary, compressed };

    std::vector<PcdColumn> columns;
    std::size_t width = 0;
    std::size_t height = 1;
    std::size_t points = 0;
    Eigen::Vector3d view_origin = Eigen::Vector3d::Zero(); ///< in the units of the file
    Eigen::Quaterniond view_orientation = Eigen::Quaterniond::Identity();
    std::optional<StatedUnits> units;
    Data data = Data::ascii;
    std::size_t body = 0;  ///< offset of the first byte after the header
    std::size_t lines = 0; ///< of the header, for the line numbers of what follows

    std::size_t stride() const;         ///< bytes of one point
    std::size_t values_per_row() const; ///< numbers in one ascii row
};

/// @param bytes   of the whole file, from its first byte
/// @param source  the name for messages
/// @throws InputError with the line and what it says
PcdHeader parse_pcd_header(std::string_view bytes, const std::string& source);

/// Refuses a binary body that is not as long as POINTS say. @param size  of the body in bytes  @param next  what
/// follows the last point
void check_binary_size(const PcdHeader& header, std::size_t size, std::string_view next, const std::string& source);

/// Refuses fields that the header of a PCD could not name: after x, y or z, with a control character, or with all names
/// longer than a line. Files of other formats may have such.
/// @throws InputError with the field
void check_names(const std::vector<Field>& fields, const std::string& source);

/// Could these bytes be a PCD file: does the first line that is no comment begin with one of its words?
bool looks_like_pcd(std::string_view bytes);

} // namespace fettle
