#pragma once

#include <string>

namespace fettle::units {

/// Units of a file or report. The library itself computes in mm, N, s and rad; numbers are converted only where they
/// are read and written.
struct Units {
    enum class Length { mm, in, m };
    enum class Force { N, lbf };

    Length length = Length::mm;
    Force force = Force::N;

    /// Millimetres per length unit: multiply lengths read from a file by it, divide lengths to write by it.
    double mm() const;
    /// Newtons per force unit.
    double newton() const;

    bool operator==(const Units&) const = default;
};

/// "mm", "in", "m"; "N", "lbf".
std::string to_string(Units::Length length);
std::string to_string(Units::Force force);

/// Inverse of to_string(). @throws InputError for other words
Units::Length parse_length_unit(const std::string& word);
Units::Force parse_force_unit(const std::string& word);

/// Millimetres per length unit.
double mm_per(Units::Length length);

/// Dimension of a quantity: length^length_power · force^force_power (time is always in seconds).
struct Dimension {
    int length_power = 0;
    int force_power = 0;
};

/// Factor that converts a quantity from `units` to base units, mm and N.
double base_unit_factor(const Units& units, Dimension dimension);

} // namespace fettle::units
