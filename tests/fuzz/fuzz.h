#pragma once

// What the targets share. A target hands bytes to a reader of the library: it reads them, or refuses them by
// InputError; anything else is a finding.

#include "core/error.h"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

namespace fettle::fuzz {

/// Ends the program, for libFuzzer to keep the input, unless it is so.
inline void require(bool is_so, std::string_view what)
{
    if (is_so) return;
    std::fprintf(stderr, "not so: %.*s\n", static_cast<int>(what.size()), what.data());
    std::abort();
}

/// Runs `read`. A refusal must be a message of one line.
/// @return  has it been read?
template <typename Read>
bool is_read(const Read& read)
{
    try {
        read();
        return true;
    } catch (const core::InputError& error) {
        for (const char* c = error.what(); *c != '\0'; ++c) require(*c != '\n', "a refusal is one line of text");
        return false;
    }
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size)
{
    return {reinterpret_cast<const char*>(data), size};
}

} // namespace fettle::fuzz
