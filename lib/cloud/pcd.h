#pragma once

#include "cloud/cloud.h"
#include "units/units.h"

#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

namespace fettle::cloud {

enum class PcdEncoding { ascii, binary };
/// The encoding that the option --ascii of a tool asks for.
constexpr PcdEncoding pcd_encoding(bool ascii) { return ascii ? PcdEncoding::ascii : PcdEncoding::binary; }

/// A cloud read from a file.
struct CloudFile {
    Cloud cloud;        ///< mm and N
    units::Units units; ///< units of the file
};

/// Reads a point cloud from PCD (ascii, binary, binary_compressed), PLY, E57, PTX or XYZ text; the content decides
/// which. The header is checked against the size of the file before memory is allocated.
/// @param path   a file, or "-" for stdin
/// @param units  units of the file, which its `# units` comment may not contradict; without them those of the comment,
/// else mm
/// @throws InputError
CloudFile read_cloud(const std::string& path, std::optional<units::Units> units = std::nullopt);

/// Reads a point cloud from the bytes of a file. @param source  its name for messages
CloudFile parse_cloud(std::string_view bytes, const std::string& source,
                      std::optional<units::Units> units = std::nullopt);

struct PcdHeader;

/// Decodes points of a binary PCD. @param records  complete points of the file   @param units  of the file
Cloud parse_pcd_records(const PcdHeader& header, std::string_view records, const units::Units& units);

/// Writes x y z as F4 and the fields in their order, with a `# units` comment.
/// @param units  of the numbers written
void write_pcd(std::ostream& out, const Cloud& cloud, const units::Units& units,
               PcdEncoding encoding = PcdEncoding::binary);

/// Writes a cloud in parts: first the header for `points` points with the fields of `some`, then the points.
void write_pcd_header(std::ostream& out, const Cloud& some, std::size_t points, const units::Units& units,
                      PcdEncoding encoding);
void write_pcd_points(std::ostream& out, const Cloud& part, const units::Units& units, PcdEncoding encoding);

} // namespace fettle::cloud
