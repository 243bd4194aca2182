#pragma once

#include "cloud/cloud.h"
#include "units/units.h"

#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

namespace fettle {

enum class PcdEncoding { ascii, binary };

/// A cloud read from a file, and the units that its numbers were in.
struct CloudFile {
    Cloud cloud; ///< mm and N
    Units units; ///< of the file
};

/// Reads a point cloud: PCD (ascii, binary, binary_compressed), or PLY or XYZ text, told by content. Strict: the header
/// is checked against the bytes that are there before anything is allocated.
/// @param path   a file, or "-" for stdin
/// @param units  what the file must be in: its `# units` comment may not disagree. Nothing: what the comment says, else
/// mm
/// @throws InputError
CloudFile read_cloud(const std::string& path, std::optional<Units> units = std::nullopt);

/// The same from bytes. @param source  the name for messages
CloudFile parse_cloud(std::string_view bytes, const std::string& source, std::optional<Units> units = std::nullopt);

struct PcdHeader;

/// Points of a binary PCD. @param records  a whole number of points as they stand in the file  @param units  of the
/// file
Cloud parse_pcd_records(const PcdHeader& header, std::string_view records, const Units& units);

/// Writes x y z as F4, then the fields in their order, with a `# units` comment.
/// @param units  of the numbers written
void write_pcd(std::ostream& out, const Cloud& cloud, const Units& units, PcdEncoding encoding = PcdEncoding::binary);

/// The same by parts: the header for so many points like those of `some`, then the points, part by part.
void write_pcd_header(std::ostream& out, const Cloud& some, std::size_t points, const Units& units,
                      PcdEncoding encoding);
void write_pcd_points(std::ostream& out, const Cloud& part, const Units& units, PcdEncoding encoding);

} // namespace fettle
