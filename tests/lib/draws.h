// The number of draws of a statistical test: all of them with `make test-all`, fewer with `make test`
// (FETTLE_DRAWS=few).
#pragma once

#include <algorithm>
#include <cstdlib>
#include <string_view>

// A quarter of `all`, or all. A bound that depends on the number follows from what this returns.
inline int draws(int all)
{
    const char* const amount = std::getenv("FETTLE_DRAWS");
    return amount != nullptr && std::string_view(amount) == "few" ? std::max(1, all / 4) : all;
}
