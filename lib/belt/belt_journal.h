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
    /// Digest of what else the run depends on, such as what its supervisor knows beforehand.
    std::string context_digest;
};

/// Measures the passes of a path, and may change the feeds of those to come. A pass is the path from a touchdown to the
/// next. What it changes must follow from the passes in BeltRun alone, so that a resumed run ends as an uninterrupted
/// one.
class PassSupervisor {
  public:
    virtual ~PassSupervisor() = default;
    /// Before the first point of this process. @param run  as the journal left it
    virtual void resume(const BeltRun& run) = 0;
    /// Before the point `first` of a pass that ends before the point `end`.
    virtual void begin_pass(const BeltGrinding& grinding, std::size_t first, std::size_t end) = 0;
    virtual MeasuredPass end_pass(const BeltRun& run) = 0;
};

/// Called after each point, and once before the first point that this process grinds.
using BeltListener = std::function<void(const BeltRun& run)>;

/// Grinds as grind() does, but resumes from the journal if it exists. The journal is replaced atomically; after the
/// last point it holds the finished run. The result equals that of an uninterrupted run bit for bit. With a journal
/// BeltRun::removals stays empty; with a supervisor, checkpoints are between passes.
/// @param supervisor  of the passes; null: none
/// @throws InputError as grind(); also if the file is not a journal, is corrupt, or its surfels, wheel, path or options
/// differ
BeltRun grind(Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path, BeltOptions options,
              const BeltJournal& journal, const BeltListener& listener, PassSupervisor* supervisor = nullptr,
              const core::Progress& progress = {});

} // namespace fettle::belt
