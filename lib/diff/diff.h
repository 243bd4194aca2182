#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fettle {

/// Two numbers are equal if they differ by at most absolute + relative · the greater of their magnitudes. NaN equals
/// NaN.
struct Tolerance {
    double absolute = 0;
    double relative = 0;
};

/// What two files differ in.
struct Difference {
    std::vector<std::string> structure; ///< kind, units, fields, number of points, members: one line each
    std::size_t values = 0;             ///< numbers and texts compared
    std::size_t unequal = 0;            ///< of them, beyond the tolerance
    double largest = 0; ///< difference of two numbers, equal or not; infinite: number against NaN or text
    std::string where;  ///< of the largest, with the two values; empty if all are the same

    bool equal() const { return structure.empty() && unequal == 0; }
};

/// Compares two texts of the same kind: JSON, points (PCD, PLY, XYZ) or a mesh (STL, PLY, OBJ, OFF), told by content.
/// Members of JSON objects may have any order; fields, points and triangles may not. Lengths are compared in the units
/// that the files name.
/// @param name_a, name_b  for messages
/// @throws InputError if one cannot be read
Difference difference(std::string_view a, const std::string& name_a, std::string_view b, const std::string& name_b,
                      const Tolerance& tolerance);

} // namespace fettle
