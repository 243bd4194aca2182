#pragma once

#include "cloud/cloud.h"

#include <string>
#include <string_view>

namespace fettle {

/// XYZ text: a point a line, 3 or more numbers with blanks or tabs between, the same count on every line. Comments (#)
/// and blank lines are skipped. The first line may name the columns, beginning with x y z (also "//X Y Z …"); without
/// it the further columns are called column4, column5, …; they are F8. In the units of the file.
/// @throws InputError with the line
Cloud parse_xyz(std::string_view bytes, const std::string& source);

/// Does the first line that is no comment hold numbers, or names that begin with x y z?
bool looks_like_xyz(std::string_view bytes);

} // namespace fettle
