#pragma once

#include "belt/belt_grinding.h"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::belt {

/// State of a run with the surfels' displacements: all that the rest of the run depends on.
struct BeltCheckpoint {
    BeltState state;
    Eigen::VectorXd displacement; ///< of the surfels, mm
};

/// SHA-256 of everything that a run depends on: it identifies a journal of another run.
/// @param context  of what else it depends on
std::string run_digest(const Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path,
                       const BeltOptions& options, const std::string& context = {});

/// A checkpoint as the bytes of a journal: a title, the SHA-256 of the rest, the run's digest, and the numbers in the
/// processor's own format.
std::string encode_journal(const std::string& digest, BeltCheckpoint checkpoint);

/// The journal around numbers that are encoded already.
std::string seal_journal(const std::string& digest, std::string_view numbers);

/// Reads a checkpoint. Memory is bounded by the size of the journal.
/// @param initial      of this run before its first point: it says how many surfels there are, and whether errors are
///                     kept
/// @param path_length  points of the path   @param cells_per_side  of the contact's grid
/// @throws InputError without the file's name, if it is no journal, corrupt, or another run's
BeltCheckpoint decode_journal(std::string_view journal, const std::string& digest, const BeltCheckpoint& initial,
                              std::size_t path_length, Eigen::Index cells_per_side);

} // namespace fettle::belt
