#include "find/doubtful.h"

#include "find/design.h"

#include <algorithm>
#include <functional>

namespace fettle::find {
namespace {

// Two finds that share more than this of either's cells are at one place.
constexpr double kMaxSharedCells = 0.1;

// Each find that is alike lowers a score by this, which divides the odds by 100: half of the bosses by design have one
// alike, and one in 240 pairs with an anomaly has that height and size (docs/methods/find.md).
constexpr double kAlikeScore = 3.1;

bool is_one_place(const Verified& a, const Verified& b)
{
    const cv::Rect both = a.window & b.window;
    if (both.empty()) return false;
    const int shared = cv::countNonZero(a.mask(both - a.window.tl()) & b.mask(both - b.window.tl()));
    return shared > kMaxSharedCells * std::min(cv::countNonZero(a.mask), cv::countNonZero(b.mask));
}

} // namespace

void set_probabilities(std::vector<Verified>& finds)
{
    std::vector<const Verified*> order, places;
    std::vector<double> by_evidence;
    for (Verified& find : finds) {
        by_evidence.push_back(find.score);
        find.score -= flat_top_score(find.evidence);
        order.push_back(&find);
    }
    // Among finds at one place the first, which has the highest score, counts.
    std::ranges::stable_sort(order, std::greater{}, &Verified::score);
    for (const Verified* find : order)
        if (std::ranges::none_of(places, [&](const Verified* other) { return is_one_place(*find, *other); }))
            places.push_back(find);
    for (Verified& find : finds) {
        find.doubtful_others = find.alike = 0;
        for (const Verified* other : places) {
            if (other == &find || is_one_place(find, *other)) continue;
            find.doubtful_others += is_doubtful(other->score);
            find.alike += are_alike(find, *other);
        }
    }
    for (std::size_t i = 0; i < finds.size(); ++i) {
        Verified& find = finds[i];
        find.score -= kAlikeScore * find.alike;
        find.probability = probability_of(find.score, find.doubtful_others);
        find.probability_by_evidence = probability_of(by_evidence[i], find.doubtful_others);
    }
}

} // namespace fettle::find
