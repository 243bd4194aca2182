#pragma once

#include <stdexcept>
#include <string>

namespace fettle::core {

/// Bad input or usage, which the user can correct. `what()` is one line, "FILE: what is wrong, with the value and the
/// place"; tool_main prints it after the tool's name and exits 2.
class InputError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
    InputError(const std::string& source, const std::string& problem) : std::runtime_error(source + ": " + problem) {}
};

/// Calls `work` and returns its result; prefixes messages of InputError with the name of an option or a file, unless
/// they begin with an option already.
template <typename Work>
auto with_error_prefix(const std::string& name, const Work& work)
{
    try {
        return work();
    } catch (const InputError& error) {
        if (std::string(error.what()).starts_with("--")) throw;
        throw InputError(name, error.what());
    }
}

} // namespace fettle::core
