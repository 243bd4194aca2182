#pragma once

#include "core/error.h"

namespace fettle {

/// A file holds something else than it should, as when two arguments of a tool have changed places: tool_main adds
/// their order.
class WrongKind : public InputError {
  public:
    /// @param name  of the file, as in messages
    WrongKind(const std::string& name, const std::string& problem) : InputError(name, problem), file(name) {}

    std::string file;
};

} // namespace fettle
