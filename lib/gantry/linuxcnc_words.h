#pragma once

#include "core/fixed_text.h"

#include <string>

namespace fettle::gantry {

/// A word of G-code, " X1.5". @param value  mm or degrees
inline std::string word(const char* name, double value)
{
    return std::string(" ") + name + core::to_fixed_text(value, 5);
}

inline std::string feed_word(double mm_per_s) { return word("F", 60 * mm_per_s); }

} // namespace fettle::gantry
