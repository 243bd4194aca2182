#pragma once

#include "cloud/cloud.h"

#include <string>
#include <string_view>

namespace fettle::cloud {

/// Parses XYZ text: a point per line, with 3 or more numbers between blanks or tabs, commas, or semicolons, the same
/// number on all lines. Comments (#) and blank lines are skipped. The first line may name the columns, beginning with x
/// y z (also "//X Y Z …"); without names the columns after z become fields column4, column5, …, of type F8. The cloud
/// is in the units of the file.
/// @throws InputError with the line
Cloud parse_xyz(std::string_view bytes, const std::string& source);

/// True if the first line that is not a comment begins with a number or names columns x y z.
bool looks_like_xyz(std::string_view bytes);

} // namespace fettle::cloud
