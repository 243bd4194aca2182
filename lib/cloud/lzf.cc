#include "cloud/lzf.h"

#include <algorithm>
#include <cstddef>

namespace fettle {

// A control byte c says what follows:
//   c < 32   c + 1 bytes as they are
//   else     a copy of bytes written before. Length: the upper three bits + 2; if all three are set, the next byte is
//            added. Distance: the lower five bits and the next byte, + 1. A copy may overlap what it writes.
bool unpack_lzf(std::string_view packed, std::span<char> unpacked)
{
    constexpr std::size_t kLongestRun = 32;
    constexpr std::size_t kExtended = 7;
    std::size_t from = 0;
    std::size_t to = 0;
    const auto byte = [&packed](std::size_t at) {
        return static_cast<std::size_t>(static_cast<unsigned char>(packed[at]));
    };
    while (from < packed.size()) {
        const std::size_t control = byte(from++);
        if (control < kLongestRun) {
            const std::size_t length = control + 1;
            if (length > packed.size() - from || length > unpacked.size() - to) return false;
            std::copy_n(packed.data() + from, length, unpacked.data() + to);
            from += length;
            to += length;
            continue;
        }
        std::size_t length = control >> 5;
        const std::size_t more = length == kExtended ? 2 : 1; // bytes that the reference still has
        if (more > packed.size() - from) return false;
        if (length == kExtended) length += byte(from++);
        length += 2;
        const std::size_t distance = ((control & 31) << 8) + byte(from++) + 1;
        if (distance > to || length > unpacked.size() - to) return false;
        for (std::size_t i = 0; i < length; ++i, ++to) unpacked[to] = unpacked[to - distance]; // may overlap
    }
    return to == unpacked.size();
}

} // namespace fettle
