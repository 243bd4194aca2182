#pragma once

#include "job/job.h"
#include "sampling/touch_plan.h"

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <vector>

namespace fettle {

/// Candidates in S \ B where nothing else is said: Wang's first subsets hold 457 to 481 of them (2007, 4.4.3.2 and
/// Table 4-1), half of what there is to choose from.
inline constexpr double kCandidates = 1000;

/// Places that may be touched: a square grid in W, centred on S, as far as it lies in S \ B.
/// @param spacing  mm; 0: so that there are about kCandidates
/// @return 2xN, M, mm
/// @throws InputError for more than 100,000 places
Eigen::Matrix2Xd candidate_touches(const Job& job, double spacing);

/// What the search lowers: the error of a subset of the candidates (ascending indices), such as its error band, mm.
/// Infinite for a subset that makes no surface. It must not depend on anything else.
using SubsetError = std::function<double(const std::vector<Eigen::Index>&)>;

/// Exchanges after the discards, for each mutation before them: with few touches an evaluation costs less, and more of
/// them are needed.
inline constexpr int kExchanges = 10;

struct HillClimb {
    Eigen::Index touches = 0; ///< to be left; 0: as few as the discards leave
    int mutations = 1000;     ///< before the discards; kExchanges times as many after them, if a number is wanted
    double sharpness = 0;     ///< k, 1/mm: a discard that costs d more than the best error is accepted with exp(-k d)
    std::uint64_t seed = 1;
};

struct HillClimbed {
    std::vector<Eigen::Index> chosen; ///< ascending
    double error = 0;                 ///< of the chosen, mm
    double start_error = 0;           ///< of the random half of the candidates that the search began with
    int evaluations = 0;
};

/// Wang's modified two-phase random-mutation hill climbing (2007, Appendix A). Mutations: from a random half of the
/// candidates one after the other changes sides, which stays if the error is no larger. Discards: one after the other
/// is left out, with probability exp(-k max(error - best, 0)), until as many as wanted are left, or until each of them
/// was refused in a row; then the cheapest goes if there are still too many. With a wanted number mutations follow that
/// keep it, an exchange being accepted as a discard is, and the best of all subsets of that number is returned.
/// @throws InputError for fewer candidates than wanted touches, or if no subset made a surface
HillClimbed hill_climb(Eigen::Index candidates, const SubsetError& error, const HillClimb& options);

/// The touches of a subset. Each stands for itself: its curve is -1, its role that of the boundary it is nearer to.
TouchPlan plan_of(const Job& job, const Eigen::Matrix2Xd& chosen);

} // namespace fettle
