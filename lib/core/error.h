#pragma once

#include <stdexcept>
#include <string>

namespace fettle {

/// Bad input or usage: the user can mend it. `what()` is one line, "FILE: what is wrong, with the value and the place";
/// tool_main prints it after the tool's name and exits 2.
class InputError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
    InputError(const std::string& source, const std::string& problem) : std::runtime_error(source + ": " + problem) {}
};

} // namespace fettle
