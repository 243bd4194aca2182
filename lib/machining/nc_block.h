#pragma once

// The words of one line of an NC program. Only for nc_program.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::machining {

/// The words of one line (a block).
struct NcBlock {
    std::vector<double> g; ///< not always whole: G61.1
    std::vector<int> m;
    std::array<std::optional<double>, 26> values{}; ///< values of the other letters, from 'A'

    const std::optional<double>& operator[](char letter) const { return values[letter - 'A']; }
    bool has_any(std::string_view letters) const;
    bool has(double g_code) const;
    bool changes_tool() const; ///< M6
    bool ends_program() const; ///< M2 or M30
    bool empty() const;
};

/// Parses a line. Comments in brackets or after a semicolon, blanks and the case of letters have no effect.
/// @throws InputError, without the line number, for anything but words of letters and plain numbers, a letter other
/// than G or M given twice, two G words of one modal group, or words that are not accepted
NcBlock parse_nc_block(std::string_view line);

/// A line that parse_nc_block() accepts, without the words of motion: N, X to Z, I to K, R, F, G0 to G3, G17 to G19,
/// G90 and G91. Comments stay.
std::string strip_motion_words(std::string_view line);

} // namespace fettle::machining
