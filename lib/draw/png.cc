#include "draw/png.h"

#include <png.h>

#include <stdexcept>

namespace fettle::draw {

// libpng's simplified interface handles its longjmp internally and returns an error message.
std::string encode_png(std::span<const std::uint8_t> rgb, int width, int height)
{
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width);
    image.height = static_cast<png_uint_32>(height);
    image.format = PNG_FORMAT_RGB;
    // Buffer for the worst case: asking for the size first would compress twice.
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string bytes(size, '\0');
    if (png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr) == 0)
        throw std::runtime_error(std::string("PNG: ") + image.message);
    bytes.resize(size);
    return bytes;
}

} // namespace fettle::draw
