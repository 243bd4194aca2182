#pragma once

#include "report/html.h"

#include <string>

namespace fettle {

/// Decimals that give the largest of some numbers three digits that matter, as a table's cells share them.
int decimals_for(double largest);

/// With a true minus sign and without a minus before 0; "–" for NaN.
std::string fixed_text(double value, int decimals);
/// Three digits that matter.
std::string short_text(double value);
/// "12.5 s", "4 min 31 s", "2 h 05 min".
std::string duration_text(double seconds);
/// 1234567 as "1 234 567", with spaces that do not break.
std::string count_text(double count);

/// A number that can be read back: the text as it is shown, the whole number and its key as attributes.
/// @param key  where it stands in the input, "comparison.regions.inside.mean"
Html figure(const std::string& key, double value, const std::string& text);

} // namespace fettle
