#include "merge/growth.h"

#include "align/pose_search.h"
#include "core/text.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <utility>

namespace fettle::merge {
namespace {

// A pair with a higher score is joined unless it contradicts. One with a lower score waits until all pairs with the
// group have been searched; if its score is still lower, or if another pose of the pair has more than this share of it,
// another scan must confirm it.
constexpr double kEarlyScore = 0.3, kSureScore = 0.1, kMaxSecondShare = 0.5, kMinScore = 0.04;
// A pair in which more than half of either scan agrees needs neither score nor tightness if no other pose comes near: a
// scanner's warp loosens real pairs, a foreign scan has many poses alike.
constexpr double kUnrivalledOverlap = 0.5, kUnrivalledAgreeing = 0.75, kUnrivalledShare = 0.05;
// Pairs that refinement moves farther than this, in scan radii, from where the others say, do not confirm them.
constexpr double kDuplicatePoseRadii = 0.05;

/// A scan outside of the group, on one of the group.
struct Candidate {
    std::size_t scan, on;
    Hypothesis hypothesis;
    bool is_sure; ///< needs no confirmation
};

class Grower {
  public:
    Grower(const Scans& scans, double length, const core::Progress& progress)
        : scans_(scans), length_(length), progress_(progress)
    {
    }

    /// Grows a group from a scan on among those that are `free`.
    std::vector<std::optional<Place>> group_from(std::size_t seed, const std::vector<bool>& free)
    {
        places_.assign(scans_.size(), std::nullopt);
        places_[seed] = Place{Eigen::Isometry3d::Identity(), 1};
        candidates_.clear();
        std::deque<std::size_t> unsearched{seed};
        while (!unsearched.empty()) {
            const std::size_t member = unsearched.front();
            unsearched.pop_front();
            std::vector<std::size_t> others;
            for (std::size_t other = 0; other < scans_.size(); ++other)
                if (free[other] && !places_[other]) others.push_back(other);
            search_pairs(others, member);
            for (const std::size_t other : others) add_candidates(other, member);
            while (const auto joined = join_best(kEarlyScore)) unsearched.push_back(*joined);
            if (!unsearched.empty()) continue;
            if (const auto joined = join_best(0)) unsearched.push_back(*joined);
        }
        return places_;
    }
    std::vector<Refusal> refused;

  private:
    /// Adds the poses of a scan on another that may be right to the candidates.
    void add_candidates(std::size_t scan, std::size_t on)
    {
        const std::vector<Hypothesis>& found = known_.at({scan, on});
        for (std::size_t k = 0; k < found.size(); ++k) {
            const double rival = found.size() < 2 ? 0 : found[k == 0 ? 1 : 0].score;
            const Agreement& agreement = found[k].agreement;
            const bool is_unrivalled = std::min(agreement.overlap_a, agreement.overlap_b) >= kUnrivalledOverlap &&
                                       agreement.agreeing >= kUnrivalledAgreeing &&
                                       rival <= kUnrivalledShare * found[k].score;
            const bool is_sure =
                is_unrivalled || (found[k].score >= kSureScore && rival <= kMaxSecondShare * found[k].score);
            if ((is_unrivalled || is_credible(agreement)) && found[k].score >= kMinScore)
                candidates_.push_back({scan, on, found[k], is_sure});
        }
    }

    /// Searches the pairs of the free scans with one that are not known yet: each once, the smaller scan on the larger,
    /// whatever their order.
    void search_pairs(const std::vector<std::size_t>& others, std::size_t on)
    {
        const auto size = [&](std::size_t s) { return scans_[s]->means.xyz.cols(); };
        std::vector<std::pair<std::size_t, std::size_t>> pairs;
        for (const std::size_t scan : others) {
            const bool turned = size(scan) > size(on) || (size(scan) == size(on) && scan > on);
            if (!known_.contains({scan, on})) pairs.emplace_back(turned ? on : scan, turned ? scan : on);
        }
        std::vector<std::vector<Hypothesis>> found(pairs.size());
        tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t k) {
            found[k] = search_pair(*scans_[pairs[k].first], *scans_[pairs[k].second], length_);
        });
        for (std::size_t k = 0; k < pairs.size(); ++k) {
            const auto [a, b] = pairs[k];
            known_[{a, b}] = found[k];
            for (Hypothesis& h : found[k]) {
                h.pose.T_b_a = h.pose.T_b_a.inverse();
                std::swap(h.agreement.overlap_a, h.agreement.overlap_b);
            }
            known_[{b, a}] = std::move(found[k]);
        }
        const double all = static_cast<double>(scans_.size() * (scans_.size() - 1));
        core::report_progress(progress_, std::min(1.0, static_cast<double>(known_.size()) / all));
    }

    /// Joins the scan of the best candidate with a score of at least `min_score`. @return  the scan; nothing if no
    /// candidate is good enough
    std::optional<std::size_t> join_best(double min_score)
    {
        std::ranges::stable_sort(candidates_, std::ranges::greater{},
                                 [](const Candidate& c) { return c.hypothesis.score; });
        for (std::size_t k = 0; k < candidates_.size(); ++k) {
            const Candidate candidate = candidates_[k];
            if (candidate.hypothesis.score < min_score) break;
            if (places_[candidate.scan]) continue;
            const Place& on = *places_[candidate.on];
            const PairPose& pose = candidate.hypothesis.pose;
            const Place place{align::orthonormalized(on.T_world_scan * pose.T_b_a), on.side * pose.side};
            const auto confirmed = confirmations(candidate, place);
            if (!confirmed) { // it never will
                candidates_.erase(candidates_.begin() + k--);
                continue;
            }
            if (!candidate.is_sure && *confirmed == 0) continue;
            places_[candidate.scan] = place;
            return candidate.scan;
        }
        return std::nullopt;
    }

    /// Number of other scans of the group that agree with a place; nothing if one of them contradicts it.
    std::optional<int> confirmations(const Candidate& candidate, const Place& place)
    {
        std::vector<std::size_t> members;
        for (std::size_t m = 0; m < scans_.size(); ++m)
            if (places_[m] && m != candidate.on) members.push_back(m);
        std::vector<Hypothesis> judged(members.size());
        const Scan& scan = *scans_[candidate.scan];
        std::vector<char> keeps_pose(members.size());
        tbb::parallel_for(std::size_t{0}, members.size(), [&](std::size_t k) {
            const PairPose expected = pose_between(place, *places_[members[k]]);
            judged[k] = judge_pair(scan, *scans_[members[k]], expected, length_);
            const double distance = align::pose_distance(judged[k].pose.T_b_a, expected.T_b_a, scan.frame);
            keeps_pose[k] = distance < kDuplicatePoseRadii * scan.frame.radius;
            if (!keeps_pose[k]) judged[k].agreement = agreement(scan, *scans_[members[k]], expected, length_);
        });
        int confirmed = 0;
        for (std::size_t k = 0; k < members.size(); ++k) {
            if (is_contradiction(judged[k].agreement)) {
                refused.push_back({candidate.scan, candidate.on,
                                   "the pose that fits them best contradicts " + scans_[members[k]]->name});
                return std::nullopt;
            }
            confirmed += keeps_pose[k] && is_credible(judged[k].agreement) ? 1 : 0;
        }
        return confirmed;
    }

    const Scans& scans_;
    double length_;
    const core::Progress& progress_;
    std::vector<std::optional<Place>> places_;
    std::vector<Candidate> candidates_;
    std::map<std::pair<std::size_t, std::size_t>, std::vector<Hypothesis>> known_; ///< by scan and the other
};

} // namespace

PairPose pose_between(const Place& a, const Place& b)
{
    return {b.T_world_scan.inverse() * a.T_world_scan, a.side * b.side};
}

Growth grow(const Scans& scans, double length, const core::Progress& progress)
{
    Growth growth;
    Grower grower(scans, length, progress);
    std::vector<bool> free(scans.size(), true); // of a group; a scan alone may still join another's
    std::size_t largest = 0, left = scans.size();
    for (std::size_t seed = 0; seed < scans.size() && left > largest; ++seed) {
        if (!free[seed]) continue;
        const std::vector<std::optional<Place>> places = grower.group_from(seed, free);
        const auto size =
            static_cast<std::size_t>(std::ranges::count_if(places, [](const auto& p) { return p.has_value(); }));
        for (std::size_t i = 0; i < scans.size(); ++i)
            if (places[i] && size > 1) free[i] = false;
        if (size > 1) left -= size;
        if (size > largest) {
            largest = size;
            growth.places = places;
        }
    }
    growth.refused = std::move(grower.refused);
    return growth;
}

} // namespace fettle::merge
