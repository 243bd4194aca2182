#pragma once

#include "belt/belt_grinding.h"

#include <functional>
#include <string>

namespace fettle {

/// Where a run is kept, so that one that was killed can go on.
struct BeltJournal {
    std::string file; ///< empty: it is not kept
    double every = 5; ///< s of work, which is what is lost at most; 0: after every point
};

/// Called after each point, and once before the first that is ground now.
using BeltListener = std::function<void(const BeltRun& run)>;

/// As grind(), but begun where the journal ends, if there is one; the journal appears whole or not at all, and says in
/// the end that all is done. The result is that of a run that was not interrupted, to the last digit. Losses are not
/// kept.
/// @throws InputError as grind(); also if the journal is none, or that of other surfels, another wheel, path or options
BeltRun grind(Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path, BeltOptions options,
              const BeltJournal& journal, const BeltListener& listener, const Progress& progress = {});

} // namespace fettle
