#pragma once

#include "core/error.h"

namespace fettle::core {

/// A file has another format or content than expected, as when arguments are swapped; tool_main() adds their order to
/// the message.
class WrongFileType : public InputError {
  public:
    /// @param name  of the file, as in messages
    WrongFileType(const std::string& name, const std::string& problem) : InputError(name, problem), file(name) {}

    std::string file;
};

} // namespace fettle::core
