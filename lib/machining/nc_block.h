#pragma once

// A line of a machine program as words. Only for nc_program.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fettle {

/// The words of one line.
struct NcBlock {
    std::vector<int> g, m;
    std::array<std::optional<double>, 26> values{}; ///< of the other letters

    const std::optional<double>& operator[](char letter) const
    {
        return values[static_cast<std::size_t>(letter - 'A')];
    }
    bool has_any(std::string_view letters) const;
    bool has(int g_code) const;
    bool empty() const;
};

/// Comments in brackets or after a semicolon, blanks and the case of letters mean nothing.
/// @throws InputError, without the line's number, for anything but words of letters and plain numbers, a letter other
/// than G or M given twice, two G words of one group, or words that are not accepted
NcBlock parse_nc_block(std::string_view line);

/// A line that parse_nc_block() takes, without what says where and how to move: the words N, X to Z, I to K, R, F, and
/// G0 to G3, G17 to G19, G90, G91. Comments stay.
std::string without_moves(std::string_view line);

} // namespace fettle
