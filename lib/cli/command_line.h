#pragma once

#include <map>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fettle::cli {

/// Rejects options that are unknown (with a suggestion), given twice, or without their value. It runs before CLI11,
/// whose messages are about its internals. Accepts everything if help is requested.
/// @throws InputError
void check_options(const CLI::App& app, int argc, char** argv);

/// Attaches values to options whose value is optional: the next word if it is one of the option's choices, else the
/// first choice. @param choices_of  the choices of such options by name   @return  all words of the command line
std::vector<std::string> attach_optional_values(int argc, char** argv,
                                                const std::map<std::string, std::vector<std::string>>& choices_of);

/// Addition to a message about an unsuitable file: the order of the arguments, " (the arguments are JOB [POINTS])".
/// Empty if the file is not an argument or the only one.
std::string describe_argument_order(const CLI::App& app, const std::string& file);

} // namespace fettle::cli
