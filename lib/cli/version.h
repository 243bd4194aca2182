#pragma once

#include <string>

namespace fettle::cli {

/// Versions of the compiler and of the libraries that this program is made with, on one line: those that every tool
/// compiles in, and of the heavy ones those that it is linked with.
std::string describe_build();

} // namespace fettle::cli
