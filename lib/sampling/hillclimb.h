#pragma once

#include "job/job.h"
#include "sampling/touch_plan.h"

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <vector>

namespace fettle::sampling {

/// Default number of candidates in S \ B: Wang's initial subsets, half of them, have 457 to 481 (2007, Table 4-1).
inline constexpr double kDefaultCandidates = 1000;

/// Candidate touch points: the points of a square grid in W, centred on S, that are in S \ B.
/// @param spacing  mm; 0: chosen for about kDefaultCandidates points
/// @return 2xN, M, mm
/// @throws InputError for more than 100,000 points
Eigen::Matrix2Xd candidate_touches(const job::Job& job, double spacing);

/// Objective of the search: the error of a subset of the candidates (ascending indices), such as its error band, mm.
/// Infinite for a subset that does not determine a surface. It must depend on nothing else.
using SubsetError = std::function<double(const std::vector<Eigen::Index>&)>;

/// Exchanges after the discards per mutation before them: with few touches an evaluation is cheap, and more are needed.
inline constexpr int kExchangesPerMutation = 10;

struct HillClimbOptions {
    Eigen::Index touches = 0; ///< size of the result; 0: as few as the discards leave
    int mutations = 1000;     ///< before the discards; times kExchangesPerMutation: exchanges after them
    double sharpness = 0;     ///< k, 1/mm: a discard whose error exceeds the best by d is accepted with exp(-k d)
    std::uint64_t seed = 1;
};

struct HillClimbResult {
    std::vector<Eigen::Index> chosen; ///< indices of the candidates, ascending
    double error = 0;                 ///< error of the chosen subset, mm
    double start_error = 0;           ///< error of the initial subset, a random half of the candidates, mm
    int evaluations = 0;              ///< number of evaluated subsets
};

/// Wang's modified two-phase random-mutation hill climbing (2007, Appendix A).
/// - Mutations: from a random half of the candidates, one at a time is moved into or out of the subset; a move is
///   kept if the error does not increase.
/// - Discards: one at a time is left out, with probability exp(-k max(error - best, 0)), until `touches` are left.
///   If all were rejected in a row and there are still too many, the one with the smallest error is left out.
/// - Exchanges, if `touches` > 0: one member is exchanged for a candidate outside, accepted with the same
///   probability. The best subset is returned.
/// @throws InputError for fewer candidates than `touches`, or if no subset determined a surface
HillClimbResult hill_climb(Eigen::Index candidates, const SubsetError& error, const HillClimbOptions& options);

/// Touch plan of a subset. Its touches are on no line (kNoLine); the role of each is that of the closer boundary.
/// @param chosen  2xN, M, mm
TouchPlan make_touch_plan(const job::Job& job, const Eigen::Matrix2Xd& chosen);

} // namespace fettle::sampling
