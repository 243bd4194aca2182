#pragma once

#include <span>
#include <string_view>

namespace fettle {

/// Unpacks LZF, as in `DATA binary_compressed`, into exactly `unpacked`. Our own, since the library that has it (PCL's
/// input and output) loads sixty others into each tool, at 15 ms a start.
/// @return  false if the packed bytes are corrupt: a back reference before the beginning, too little or too much
bool unpack_lzf(std::string_view packed, std::span<char> unpacked);

} // namespace fettle
