#pragma once

#include <string>

namespace fettle {

/// What fettle was built with: the compiler and the libraries, in one line.
std::string built_with();

} // namespace fettle
