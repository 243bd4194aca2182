#pragma once

#include "belt/belt_grinding.h"
#include "core/progress.h"

#include <functional>
#include <string>

namespace fettle::belt {

/// Checkpoint file of a run, from which a killed run resumes.
struct BeltJournal {
    std::string file;    ///< empty: no checkpoints
    double interval = 5; ///< time between checkpoints, s; 0: after every point
};

/// Called after each point, and once before the first point that this process grinds.
using BeltListener = std::function<void(const BeltRun& run)>;

/// Grinds as grind() does, but resumes from the journal if it exists. The journal is replaced atomically; after the
/// last point it holds the finished run. The result equals that of an uninterrupted run bit for bit. With a journal
/// BeltRun::losses stays empty.
/// @throws InputError as grind(); also if the file is not a journal, is corrupt, or its surfels, wheel, path or options
/// differ
BeltRun grind(Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path, BeltOptions options,
              const BeltJournal& journal, const BeltListener& listener, const core::Progress& progress = {});

} // namespace fettle::belt
