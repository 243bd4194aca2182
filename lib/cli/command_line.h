#pragma once

namespace CLI {
class App;
}

namespace fettle {

/// Refuses options that are unknown (with a guess at what was meant), stand twice, or lack their value, before CLI11
/// sees them: its own messages speak of its own matters. Says nothing if help is asked for.
/// @throws InputError
void check_options(const CLI::App& app, int argc, char** argv);

} // namespace fettle
