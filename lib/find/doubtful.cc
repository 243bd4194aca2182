#include "find/doubtful.h"

#include <algorithm>
#include <functional>

namespace fettle::find {
namespace {

// Two finds that share more than this of either's cells are at one place.
constexpr double kMaxSharedCells = 0.1;

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
    std::vector<const Verified*> order, taken, doubtful;
    for (const Verified& find : finds) order.push_back(&find);
    // The surer ones of a place come first: a doubtful find there is the same again.
    std::ranges::stable_sort(order, std::greater{}, &Verified::score);
    for (const Verified* find : order) {
        if (std::ranges::any_of(taken, [&](const Verified* other) { return is_one_place(*find, *other); })) continue;
        taken.push_back(find);
        if (is_doubtful(find->score)) doubtful.push_back(find);
    }
    for (Verified& find : finds) {
        find.doubtful_others = int(std::ranges::count_if(
            doubtful, [&](const Verified* other) { return other != &find && !is_one_place(find, *other); }));
        find.probability = probability_of(find.score, find.doubtful_others);
    }
}

} // namespace fettle::find
