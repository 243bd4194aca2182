#include "robot/walk.h"

#include "core/constants.h"

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {

// Between two steps the way is halved at most so often: 1 m to the hundredth of a micrometre.
constexpr std::size_t kMostHalvings = 26;
// A pair is looked at as far ahead as it would move in so many steps: it is then left alone for about as many.
constexpr double kStepsAhead = 16;

} // namespace

Walk::Walk(const Cell& cell)
    : cell_(cell), middle_(kMostHalvings), gone_(cell.bodies()), apart_(cell.pairs().size()),
      last_(cell.looked_at().empty() ? 0 : cell.looked_at().front())
{
}

void Walk::leave() { steps_ = 0; }

void Walk::look(Place& place, std::size_t pair, double beyond)
{
    beyond = std::min(beyond, cell_.options().beyond);
    const double bound = cell_.look(place.stance, pair, beyond);
    place.exact[pair] = bound < beyond || beyond == cell_.options().beyond;
    if (&place != &here_) return;
    const CellPair& p = cell_.pairs()[pair];
    apart_[pair] = bound + gone_[p.a] + gone_[p.b];
}

CellClearance Walk::step(const CellJoints& joints)
{
    std::swap(before_, here_);
    here_.joints = joints;
    cell_.stand(joints, here_.stance);
    here_.exact.assign(cell_.pairs().size(), 0);
    std::vector<double> chords(cell_.bodies(), 0.0);
    if (steps_++ == 0) {
        std::fill(gone_.begin(), gone_.end(), 0.0);
        std::fill(apart_.begin(), apart_.end(), -kInfinity);
    } else {
        here_.stance.leaf = before_.stance.leaf;
        for (std::size_t b = 0; b < chords.size(); ++b) {
            chords[b] = cell_.chord(b, before_.stance, here_.stance);
            gone_[b] += chords[b];
        }
    }
    CellClearance least;
    least.clearance = kInfinity;
    if (cell_.looked_at().empty()) return least;
    look(here_, last_, kInfinity);
    least = here_.stance.pairs[last_];
    const double most = cell_.options().beyond;
    for (const std::size_t i : cell_.looked_at()) {
        if (i == last_) continue;
        const CellPair& pair = cell_.pairs()[i];
        const double way = chords[pair.a] + chords[pair.b], bound = apart_[i] - gone_[pair.a] - gone_[pair.b];
        // A body may come to lie wholly inside the workpiece only where it touched it.
        if (bound > 0 && bound >= std::min(least.clearance + way, most)) {
            here_.stance.pairs[i].clearance = std::min(bound, most);
            here_.stance.pairs[i].pair = i;
            continue;
        }
        look(here_, i, steps_ == 1 ? most : std::max(least.clearance, 0.0) + kStepsAhead * way);
        if (here_.stance.pairs[i].clearance < least.clearance) least = here_.stance.pairs[i];
    }
    last_ = least.pair;
    return least;
}

CellClearance Walk::way() { return between(before_, here_, cell_.looked_at(), 0); }

double Walk::motion(const Place& from, Place& to, std::size_t pair) const
{
    const auto of_body = [&](std::size_t b) {
        double& known = to.motions[b];
        if (std::isnan(known)) known = cell_.motion(b, from.joints, from.stance, to.joints, to.stance);
        return known;
    };
    return of_body(cell_.pairs()[pair].a) + of_body(cell_.pairs()[pair].b);
}

CellClearance Walk::between(Place& from, Place& to, std::vector<std::size_t> some, std::size_t halvings)
{
    const CollisionOptions& options = cell_.options();
    to.motions.assign(cell_.bodies(), std::numeric_limits<double>::quiet_NaN());
    // The one that is probably least comes first: the others need then not be looked at so well.
    const auto nearest = std::min_element(some.begin(), some.end(), [&](std::size_t i, std::size_t k) {
        return to.stance.pairs[i].clearance < to.stance.pairs[k].clearance;
    });
    if (nearest != some.end()) std::swap(*nearest, some.front());
    CellClearance least;
    least.clearance = kInfinity;
    double least_seen = kInfinity; // what is told will be no more
    std::vector<std::size_t> unclear;
    for (const std::size_t i : some) {
        const double way = motion(from, to, i);
        const CellClearance &c0 = from.stance.pairs[i], &c1 = to.stance.pairs[i];
        const auto bound = [&] {
            return std::min({(c0.clearance + c1.clearance - way) / 2, c0.clearance, c1.clearance});
        };
        if (bound() >= least_seen) continue;
        for (Place* place : {&from, &to})
            if (!place->exact[i]) look(*place, i, kInfinity);
        const CellClearance& nearer = c1.clearance < c0.clearance ? c1 : c0;
        least_seen = std::min(least_seen, nearer.clearance);
        const bool known = nearer.clearance < -options.tolerance; // it collides at a look already
        if (bound() < -options.tolerance && !known && way > options.resolution && halvings < kMostHalvings) {
            unclear.push_back(i);
            continue;
        }
        // What cannot be resolved further is told as it was seen.
        CellClearance told = nearer;
        if (!known && way > options.resolution) told.clearance = bound();
        if (told.clearance < least.clearance) least = told;
    }
    if (unclear.empty()) return least;
    Place& middle = middle_[halvings];
    middle.joints = (from.joints + to.joints) / 2;
    cell_.stand(middle.joints, middle.stance);
    middle.stance.leaf = from.stance.leaf;
    middle.exact.assign(cell_.pairs().size(), 0);
    for (const std::size_t i : unclear) look(middle, i, kInfinity);
    ++looks_;
    for (const bool second : {false, true}) {
        const CellClearance c =
            second ? between(middle, to, unclear, halvings + 1) : between(from, middle, unclear, halvings + 1);
        if (c.clearance < least.clearance) least = c;
    }
    return least;
}

} // namespace fettle
