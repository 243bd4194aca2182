#pragma once

#include "draw/html.h"

#include <string>

namespace fettle::draw {

/// Number of decimals that give the largest number of a table column three significant digits.
int decimals_for(double largest);

/// Fixed-point text with a typographic minus sign, none before 0; "–" for NaN.
std::string fixed_text(double value, int decimals);
/// Text with three significant digits.
std::string short_text(double value);
/// "12.5 s", "4 min 31 s", "2 h 05 min".
std::string duration_text(double seconds);
/// 1234567 as "1 234 567", with spaces that do not break.
std::string count_text(double count);

/// A number in a page with its full precision and its origin as attributes, so that it can be traced and read back.
/// @param key  path in the input, "comparison.regions.inside.mean"
Html number_element(const std::string& key, double value, const std::string& text);

} // namespace fettle::draw
