#include "merge/registration.h"

#include "align/pose_search.h"
#include "core/constants.h"
#include "core/error.h"
#include "core/text.h"
#include "merge/joint_fit.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace fettle::merge {
namespace {

// What is compared follows the poses: so many rounds at most, until no scan moves farther than this share of the
// standard deviation of its pose.
constexpr int kMaxRounds = 40;
constexpr double kStepToleranceSigmas = 0.1;
// Width of Cauchy's loss while wrong pairs may be among them, and from where on a pair is one: in standard deviations
// over √6, which are of the noise alone.
constexpr double kRobustWidth = 3, kMaxMisfit = 30;

using Places = std::vector<std::optional<Place>>;

/// The pairs of placed scans that agree there.
std::vector<IndexPair> agreeing_pairs(const Scans& scans, const Places& places, double length)
{
    std::vector<IndexPair> all, agreeing;
    for (std::size_t a = 0; a < scans.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
            if (places[a] && places[b]) all.push_back({a, b});
    std::vector<char> agrees(all.size());
    tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t k) {
        constexpr double kMinOverlap = 0.03; // a pair in a common fit need not stand alone
        const auto [a, b] = all[k];
        const Eigen::Index every = std::max<Eigen::Index>(1, scans[a]->means.xyz.cols() / 4000);
        const Agreement found = agreement(*scans[a], *scans[b], pose_between(*places[a], *places[b]), length, every);
        agrees[k] = std::min(found.overlap_a, found.overlap_b) >= kMinOverlap && !is_contradiction(found);
    });
    for (std::size_t k = 0; k < all.size(); ++k)
        if (agrees[k]) agreeing.push_back(all[k]);
    return agreeing;
}

/// The poses of the placed scans as a graph; those that are not placed get no edges.
PoseGraph graph_of(const Scans& scans, const Places& places, const JointFit& fit, std::size_t fixed)
{
    PoseGraph graph;
    std::vector<std::size_t> number(scans.size(), 0);
    for (std::size_t i = 0; i < scans.size(); ++i) {
        if (!places[i]) continue;
        number[i] = graph.T_world_scan.size();
        graph.T_world_scan.push_back(places[i]->T_world_scan);
        graph.frames.push_back(scans[i]->frame);
    }
    for (const JointPair& pair : fit.pairs) {
        graph.edges.push_back(pair.edge);
        graph.edges.back().a = number[pair.edge.a];
        graph.edges.back().b = number[pair.edge.b];
    }
    graph.fixed = number[fixed];
    return graph;
}

/// Drops the pairs whose own pose is far from the graph's, and names them. @return  them
std::vector<IndexPair> drop_misfits(std::vector<IndexPair>& pairs, const std::vector<double>& misfits,
                                    std::vector<Refusal>& refused)
{
    std::vector<IndexPair> kept, dropped;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const double misfit = misfits[k] / std::sqrt(6.0);
        if (misfit <= kMaxMisfit) {
            kept.push_back(pairs[k]);
            continue;
        }
        dropped.push_back(pairs[k]);
        refused.push_back({pairs[k].a, pairs[k].b,
                           "its own pose is " + core::to_short_text(std::round(misfit)) +
                               " standard deviations from that of all pairs"});
    }
    pairs = std::move(kept);
    return dropped;
}

/// Puts the solution into `places`. @return  largest motion of a scan, in standard deviations of its pose
double apply(const PoseGraphSolution& solution, double variance_scale, const Scans& scans, Places& places)
{
    double largest = 0;
    std::size_t next = 0;
    for (std::size_t i = 0; i < scans.size(); ++i) {
        if (!places[i]) continue;
        const Eigen::Isometry3d& T = solution.T_world_scan[next];
        const double moved = align::pose_distance(T, places[i]->T_world_scan, scans[i]->frame);
        const double variance =
            solution.covariances ? variance_scale * (*solution.covariances)[next].trace() : 0; // 0: the first scan's
        if (moved > 0) largest = std::max(largest, moved / std::sqrt(variance));
        places[i]->T_world_scan = T;
        ++next;
    }
    return largest;
}

/// From twists in mm to a shift in mm and a rotation in rad.
align::TwistMatrix in_radians(const align::TwistMatrix& covariance, double radius)
{
    align::Twist scale;
    scale << 1, 1, 1, 1 / radius, 1 / radius, 1 / radius;
    return scale.asDiagonal() * covariance * scale.asDiagonal();
}

void set_poses(Registration& registration, const Scans& scans, const Places& places, const PoseGraphSolution& solution,
               double variance_scale)
{
    registration.scans.resize(scans.size());
    std::size_t next = 0;
    for (std::size_t i = 0; i < scans.size(); ++i) {
        if (!places[i]) continue;
        ScanPose pose{places[i]->T_world_scan, align::TwistMatrix::Zero(), places[i]->side};
        if (solution.covariances)
            pose.covariance = variance_scale * in_radians((*solution.covariances)[next], scans[i]->frame.radius);
        else
            pose.covariance.diagonal().setConstant(core::kInfinity);
        registration.scans[i] = pose;
        ++next;
    }
}

/// Fits all pairs at once until the poses stay, and leaves out those that do not fit.
void fit_all(Registration& registration, const Scans& scans, Places& places, std::size_t fixed, double length)
{
    std::vector<IndexPair> pairs = agreeing_pairs(scans, places, length), dropped;
    JointFit fit;
    PoseGraphSolution solution;
    constexpr int kMovingRounds = 3; // later the places at which the scans are compared stay
    std::vector<SurfacePlace> surface;
    for (int round = 0; round < kMaxRounds; ++round) {
        if (round < kMovingRounds) surface = surface_places(scans, places, length);
        fit = fit_jointly(scans, places, pairs, surface, length);
        const bool is_first = round == 0;
        solution = solve_pose_graph(graph_of(scans, places, fit, fixed), is_first ? kRobustWidth : 0);
        if (is_first) dropped = drop_misfits(pairs, solution.misfits, registration.refused);
        if (is_first && !dropped.empty()) continue;
        const double moved = apply(solution, fit.variance_scale, scans, places);
        if (round == 1) { // more of them agree in better poses
            pairs = agreeing_pairs(scans, places, length);
            std::erase_if(pairs, [&](const IndexPair& pair) {
                return std::ranges::any_of(
                    dropped, [&](const IndexPair& other) { return pair.a == other.a && pair.b == other.b; });
            });
        }
        registration.converged = solution.converged && round > 1 && moved <= kStepToleranceSigmas;
        if (registration.converged) break;
    }
    fit = fit_jointly(scans, places, pairs, surface, length);
    solution = solve_pose_graph(graph_of(scans, places, fit, fixed), 0);
    set_poses(registration, scans, places, solution, fit.variance_scale);
    registration.scatter = fit.scatter;
    for (std::size_t k = 0; k < pairs.size(); ++k)
        registration.pairs.push_back({pairs[k].a, pairs[k].b, fit.pairs[k].overlap_a, fit.pairs[k].overlap_b,
                                      fit.pairs[k].rms, solution.misfits[k] / std::sqrt(6 * fit.variance_scale)});
}

} // namespace

Registration register_scans(const Scans& scans, const RegistrationRequest& request)
{
    Registration registration;
    Growth growth;
    if (request.starts.empty())
        growth = grow(scans, request.length, request.progress);
    else
        for (const Eigen::Isometry3d& start : request.starts) growth.places.emplace_back(Place{start, 1});
    std::size_t fixed = 0;
    while (!growth.places[fixed]) ++fixed;
    if (std::ranges::count_if(growth.places, [](const auto& place) { return place.has_value(); }) < 2)
        throw core::InputError("no two of the scans fit each other: do they overlap by a third?");
    registration.refused = std::move(growth.refused);
    for (std::size_t i = 0; i < scans.size(); ++i)
        if (!growth.places[i]) registration.refused.push_back({i, std::nullopt, "fits none of the other scans"});
    fit_all(registration, scans, growth.places, fixed, request.length);
    return registration;
}

} // namespace fettle::merge
