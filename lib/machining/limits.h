#pragma once

#include "core/range.h"

#include <string>

namespace fettle::machining {

/// Lengths of options, mm: from a picometre to a kilometre. No machine or part is beyond them, and squares and cubes of
/// lengths within them neither overflow nor vanish.
inline constexpr core::Range kLengthRange{1e-9, 1e6};
/// Lengths that may be 0.
inline constexpr core::Range kLengthOrZeroRange{0, 1e6};
/// Speeds of options, mm/s: the slowest makes a metre in 30 000 years, the fastest is three times that of sound.
inline constexpr core::Range kSpeedRange{1e-9, 1e6};

/// @throws InputError if a value is not within the range: "the diameter must be in [1e-09, 1e+06], not 0"
void require_within(const std::string& name, double value, const core::Range& range);

} // namespace fettle::machining
