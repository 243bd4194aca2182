#pragma once

#include "find/verification.h"

#include <vector>

namespace fettle::find {

/// Sets the probabilities of a view's finds from their scores, and from the numbers of doubtful finds and of finds
/// alike beside each. Of finds at one place the one with the highest score counts.
void set_probabilities(std::vector<Verified>& finds);

} // namespace fettle::find
