#pragma once

#include "cloud/cloud.h"

#include <string>
#include <string_view>

namespace fettle::cloud {

/// Parses PTX text (Leica): of each scan the numbers of columns and rows, position and axes of the scanner, a 4 x 4
/// matrix, then columns x rows points x y z intensity [r g b] in the scanner's frame. The points are moved by the
/// matrix, whose last row is the translation; 0 0 0, which stands for no echo, becomes NaN. A file of one scan is
/// organised: its width is the number of rows, because the points of a column follow each other. The viewpoint is the
/// scanner's, if the file has one scan. Fields: intensity, and rgb where all scans have colours. The cloud is in the
/// units of the file.
/// @throws InputError with the line
Cloud parse_ptx(std::string_view bytes, const std::string& source);

/// True if the first lines are two whole numbers, four lines of three and four of four numbers.
bool looks_like_ptx(std::string_view bytes);

} // namespace fettle::cloud
