#pragma once

#include "cloud/cloud.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::cloud {

/// The header of a PLY file.
struct PlyHeader {
    enum class Encoding { ascii, little_endian, big_endian };

    struct Property {
        std::string name;
        char type = 'F'; ///< as in PCD; for a list that of its elements
        int size = 4;
        bool list = false;
        int count_size = 1; ///< bytes of a list's length, which is an integer
        bool count_signed = false;
    };
    struct Element {
        std::string name;
        std::size_t count = 0;
        std::vector<Property> properties;
    };

    Encoding encoding = Encoding::ascii;
    std::vector<Element> elements;
    Frame frame = Frame::part; ///< of the comment `frame job`
    std::size_t body = 0;      ///< offset of the first byte after the header
    std::size_t lines = 0;     ///< number of header lines
};

/// @throws InputError with the line
PlyHeader parse_ply_header(std::string_view bytes, const std::string& source);

} // namespace fettle::cloud
