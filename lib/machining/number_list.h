#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fettle {

/// The numbers of an option's value like "12,3", as many as there are names.
/// @param names  of what they are, for messages
/// @throws InputError for anything but finite numbers with commas between
std::vector<double> numbers_of(std::string_view list, const std::vector<std::string>& names);

} // namespace fettle
