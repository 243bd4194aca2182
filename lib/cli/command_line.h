#pragma once

#include <map>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fettle {

/// Refuses options that are unknown (with a guess at what was meant), stand twice, or lack their value, before CLI11
/// sees them: its own messages speak of its own matters. Says nothing if help is asked for.
/// @throws InputError
void check_options(const CLI::App& app, int argc, char** argv);

/// All words; an option that may stand alone has its value attached: the next word if it is one of its choices, else
/// the first choice. @param alone  names of such options, and their choices
std::vector<std::string> with_values(int argc, char** argv,
                                     const std::map<std::string, std::vector<std::string>>& alone);

/// Where a file among several arguments is not what it should be: how they follow each other, " (the arguments are JOB
/// [POINTS])"; empty if it is none of them.
std::string order_of_arguments(const CLI::App& app, const std::string& file);

} // namespace fettle
