#pragma once

#include <string>

namespace fettle {

/// The library computes in mm, N, s and rad. A job declares the units of its files and reports; numbers are converted
/// where they are read and written, nowhere else.
struct Units {
    enum class Length { mm, in, m };
    enum class Force { N, lbf };

    Length length = Length::mm;
    Force force = Force::N;

    /// Millimetres in one length unit: multiply a number from a file by it, divide a number for a file by it.
    double mm() const;
    /// Newtons in one force unit.
    double newton() const;

    bool operator==(const Units&) const = default;
};

/// "mm", "in", "m"; "N", "lbf".
std::string to_string(Units::Length length);
std::string to_string(Units::Force force);

/// @throws InputError for any other word
Units::Length parse_length_unit(const std::string& word);
Units::Force parse_force_unit(const std::string& word);

double mm_per(Units::Length length);

/// What a measured quantity is made of: length^length_power · force^force_power (time is always in seconds).
struct Dimension {
    int length_power = 0;
    int force_power = 0;
};

/// Factor that turns a number in `units` into mm and N.
double to_base(const Units& units, Dimension dimension);

} // namespace fettle
