#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fettle::core {

/// Names what a file holds, for the message about a file of the wrong kind: "a PNG picture", "compressed by gzip",
/// "nothing but zero bytes", "binary data of no known format". A binary STL is known by its size.
/// @param bytes  of the whole file   @return  nothing for text, and for what begins as text: also binary PCD and PLY
std::optional<std::string> describe_content(std::string_view bytes);

/// Called where a reader has found none of its own formats.
/// @param expected  as in ", expected points"   @throws WrongFileType if describe_content() names the content
void refuse_other_content(std::string_view bytes, const std::string& source, const std::string& expected);

} // namespace fettle::core
