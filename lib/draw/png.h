#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace fettle::draw {

/// Encodes a PNG file, 8 bit sRGB; the bytes depend on the pixels alone.
/// @param rgb  red, green, blue of each pixel, row by row from the top: 3 * width * height
/// @throws std::runtime_error if libpng fails: out of memory, or a side is 0 or beyond PNG's bounds
std::string encode_png(std::span<const std::uint8_t> rgb, int width, int height);

} // namespace fettle::draw
