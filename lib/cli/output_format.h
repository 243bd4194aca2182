#pragma once

#include <string>
#include <vector>

namespace fettle::cli {

/// Suffix of a file's name in lower case, without the dot; that of FILE for FILE.part, a file not yet complete. Empty
/// if there is none: a suffix begins with a letter, so that "run-0.5" has none.
std::string suffix_of(const std::string& path);

/// The format in which an output is written, by the suffix of its name: one of `formats`. Empty for stdout, devices,
/// and names without a suffix.
/// @param formats  suffixes in lower case   @throws InputError with the known suffixes, if it has another
std::string format_of_output(const std::string& path, const std::vector<std::string>& formats);

} // namespace fettle::cli
