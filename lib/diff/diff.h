#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::diff {

/// Two numbers are equal if they differ by at most absolute + relative · max(|a|, |b|). NaN equals NaN.
struct Tolerance {
    double absolute = 0;
    double relative = 0;
};

/// Differences of two files.
struct Difference {
    std::vector<std::string> structure; ///< one line for each difference of kind, units, fields, sizes or members
    std::size_t values = 0;             ///< numbers and texts compared
    std::size_t unequal = 0;            ///< number of values that differ by more than the tolerance
    double largest = 0;                 ///< largest difference of two numbers; infinite if one of them is NaN or a text
    std::string where; ///< position of the largest difference and both values; empty if all values are identical

    bool equal() const { return structure.empty() && unequal == 0; }
};

/// Compares the contents of two files of the same kind: JSON, points (PCD, PLY, XYZ) or a mesh (STL, PLY, OBJ, OFF).
/// The kind is detected from the content. The order of members of JSON objects is irrelevant, that of fields, points
/// and triangles is not. Lengths are compared in the unit that the files name.
/// @param name_a, name_b  names of the files for messages
/// @throws InputError if a file cannot be parsed
Difference compare_contents(std::string_view a, const std::string& name_a, std::string_view b,
                            const std::string& name_b, const Tolerance& tolerance);

} // namespace fettle::diff
