#include "robot/clearance_tracker.h"

#include "core/constants.h"

#include <algorithm>
#include <cmath>

namespace fettle::robot {

namespace {

// Maximum depth of the bisection between two steps: it divides 1 m into hundredths of a micrometre.
constexpr std::size_t kMaxBisections = 26;
// A clearance is measured as far as the pair would travel in this many steps like the last one. Pairs farther apart are
// then not measured again for about as many steps.
constexpr double kLookAheadSteps = 16;

} // namespace

ClearanceTracker::ClearanceTracker(const Cell& cell)
    : cell_(cell), midpoints_(kMaxBisections + 1), distance_travelled_(cell.body_count()),
      clearance_bound_at_reset_(cell.pairs().size()),
      nearest_pair_(cell.active_pairs().empty() ? 0 : cell.active_pairs().front())
{
}

// Measures the clearance of a pair. In the current state the result also renews the pair's lower bound since the reset.
void ClearanceTracker::measure(State& state, std::size_t pair, double max_clearance)
{
    CellClearance& found = state.cell_state.clearances[pair];
    const double bound = cell_.measure_clearance(state.cell_state, pair, max_clearance);
    found.clearance = std::min(found.clearance, cell_.options().max_clearance);
    state.bounds[pair] = {bound, max_clearance};
    if (&state != &current_) return;
    const auto& [a, b, margin] = cell_.pairs()[pair];
    clearance_bound_at_reset_[pair] = bound + distance_travelled_[a] + distance_travelled_[b];
}

void ClearanceTracker::set_current_bound(std::size_t pair, double lower_bound)
{
    const auto& [a, b, margin] = cell_.pairs()[pair];
    current_.bounds[pair].clearance = lower_bound;
    clearance_bound_at_reset_[pair] = lower_bound + distance_travelled_[a] + distance_travelled_[b];
}

// Tries to renew the lower bound of a pair at the current state without measuring the pair.
// @return  true if the new bound is at least `required`, mm
bool ClearanceTracker::renew_bound(std::size_t pair, double required, double look_ahead)
{
    if (cell_.options().model != nullptr) return false;
    double bound = cell_.ball_clearance(current_.cell_state, pair);
    const bool is_far = bound > 0 && bound >= look_ahead;
    if (!is_far) {
        // The tree's bounds say nothing of a body that may lie wholly inside the workpiece.
        if (cell_.is_of_workpiece(pair) ? !(clearance_lower_bound(pair) > 0) : !cell_.has_mesh(pair)) return false;
        bound = cell_.bound_clearance(current_.cell_state, pair, look_ahead);
        if (!(bound > 0 && bound >= required)) return false;
    }
    set_current_bound(pair, bound);
    return true;
}

double ClearanceTracker::clearance_lower_bound(std::size_t pair) const
{
    const auto& [a, b, margin] = cell_.pairs()[pair];
    return clearance_bound_at_reset_[pair] - distance_travelled_[a] - distance_travelled_[b];
}

CellClearance ClearanceTracker::advance(const CellJoints& joints)
{
    std::swap(previous_, current_);
    current_.joints = joints;
    cell_.place_bodies(joints, current_.cell_state);
    current_.bounds.assign(cell_.pairs().size(), Bound());
    std::vector<double>& displacement = step_displacement_;
    displacement.assign(cell_.body_count(), 0.0);
    if (step_count_++ == 0) {
        std::ranges::fill(distance_travelled_, 0.0);
        std::ranges::fill(clearance_bound_at_reset_, -core::kInfinity);
    } else {
        current_.cell_state.start_leaves = previous_.cell_state.start_leaves;
        for (std::size_t body = 0; body < displacement.size(); ++body) {
            displacement[body] = cell_.displacement_bound(body, previous_.cell_state, current_.cell_state);
            distance_travelled_[body] += displacement[body];
        }
    }
    CellClearance minimum;
    minimum.clearance = core::kInfinity;
    if (cell_.active_pairs().empty()) return minimum;
    // The nearest pair of the last step comes first: its clearance is probably the minimum and spares the other pairs.
    const double max_clearance = cell_.options().max_clearance;
    measure(current_, nearest_pair_, max_clearance);
    minimum = current_.cell_state.clearances[nearest_pair_];
    for (const std::size_t pair : cell_.active_pairs()) {
        if (pair == nearest_pair_) continue;
        const auto& [a, b, margin] = cell_.pairs()[pair];
        const double relative_motion = displacement[a] + displacement[b], lower_bound = clearance_lower_bound(pair);
        const double required = std::min(minimum.clearance + relative_motion, max_clearance);
        // While the bound is positive a body cannot have moved into the workpiece without touching its surface.
        if (lower_bound > 0 && lower_bound >= required) {
            current_.bounds[pair].clearance = lower_bound;
            continue;
        }
        double look_ahead = std::max(minimum.clearance, 0.0) + kLookAheadSteps * relative_motion;
        look_ahead = step_count_ == 1 ? max_clearance : std::min(look_ahead, max_clearance);
        if (renew_bound(pair, required, look_ahead)) continue;
        measure(current_, pair, look_ahead);
        const CellClearance& found = current_.cell_state.clearances[pair];
        if (found.clearance < minimum.clearance) minimum = found;
    }
    nearest_pair_ = minimum.pair;
    return minimum;
}

CellClearance ClearanceTracker::swept_clearance()
{
    Sweep result;
    result.minimum.clearance = core::kInfinity;
    sweep(previous_, current_, cell_.active_pairs(), 0, result);
    return result.minimum;
}

// Upper bound of the sum of the distances that the two bodies of a pair move between two states, mm.
double ClearanceTracker::body_motion_bound(const State& from, State& to, std::size_t pair) const
{
    const auto motion_of = [&](std::size_t body) {
        double& bound = to.motion_bounds[body];
        if (!std::isnan(bound)) return bound;
        const bool is_step = &from == &previous_ && &to == &current_;
        const double displacement =
            is_step ? step_displacement_[body] : cell_.displacement_bound(body, from.cell_state, to.cell_state);
        return bound = displacement + cell_.arc_excess(body, to.joints - from.joints);
    };
    const auto& [a, b, margin] = cell_.pairs()[pair];
    return motion_of(a) + motion_of(b);
}

// Raises the lower bound of a pair that has not been measured by a rough estimate.
void ClearanceTracker::raise_bound(State& state, std::size_t pair) const
{
    double& bound = state.bounds[pair].clearance;
    if (state.bounds[pair].measured_to == -core::kInfinity)
        bound = std::max(bound, cell_.rough_clearance(state.cell_state, pair));
}

// Adds a pair's swept clearance between two states to the result, if the clearances at both ends decide whether the
// pair collides on the way.
// @return  false if they do not: the motion is to be bisected
bool ClearanceTracker::sweep_pair(State& from, State& to, std::size_t pair, std::size_t bisections, Sweep& result)
{
    const CollisionOptions& options = cell_.options();
    const Bound &c0 = from.bounds[pair], &c1 = to.bounds[pair];
    double motion = body_motion_bound(from, to, pair);
    const bool divisible = motion > options.resolution && bisections < kMaxBisections;
    const auto lower_bound = [&] {
        return std::min({(c0.clearance + c1.clearance - motion) / 2, c0.clearance, c1.clearance});
    };
    if (lower_bound() >= result.upper_bound) return true;
    double reach = options.max_clearance;
    if (options.model == nullptr) { // the geometry of a model depends on the pose, so that no bound holds beyond it
        motion =
            std::min(motion, cell_.relative_motion_bound(pair, from.joints, from.cell_state, to.joints, to.cell_state));
        for (State* end : {&from, &to}) raise_bound(*end, pair);
        if (lower_bound() >= result.upper_bound) return true;
        // A clearance as large as the motion at one end excludes a collision. For a workpiece the rough bound suffices.
        if (!cell_.is_of_workpiece(pair)) reach = std::max(reach, motion);
    }
    for (State* end : {&from, &to})
        if (!end->bounds[pair].is_measured_up_to(reach)) measure(*end, pair, reach);
    const CellClearance &at0 = from.cell_state.clearances[pair], &at1 = to.cell_state.clearances[pair];
    CellClearance nearer_end = at1.clearance < at0.clearance ? at1 : at0;
    result.upper_bound = std::min(result.upper_bound, nearer_end.clearance);
    // Where an end collides, and below the resolution, the result is the clearance measured at the nearer end.
    if (nearer_end.clearance >= -options.tolerance && divisible) {
        double bound = lower_bound();
        if (bound < -options.tolerance)
            bound = cell_
                        .swept_ball_clearance(pair, from.joints, from.cell_state, to.joints, to.cell_state,
                                              nearer_end.clearance)
                        .value_or(bound);
        if (bound < -options.tolerance) return false;
        nearer_end.clearance = std::min(nearer_end.clearance, bound);
    }
    if (nearer_end.clearance < result.minimum.clearance) result.minimum = nearer_end;
    return true;
}

// Places the bodies half-way between two states. Clearances there are measured when they are needed.
void ClearanceTracker::place_midpoint(const State& from, const State& to, State& middle)
{
    middle.joints = (from.joints + to.joints) / 2;
    cell_.place_bodies(middle.joints, middle.cell_state);
    middle.bounds.resize(cell_.pairs().size());
    for (const std::size_t pair : middle.pairs) {
        middle.bounds[pair] = Bound();
        middle.cell_state.start_leaves[pair] = from.cell_state.start_leaves[pair];
    }
    ++midpoint_count_;
}

void ClearanceTracker::sweep(State& from, State& to, std::span<const std::size_t> pairs, std::size_t bisections,
                             Sweep& result)
{
    if (pairs.empty()) return;
    to.motion_bounds.assign(cell_.body_count(), core::kNaN);
    // The pair that probably has the minimum comes first: its clearance spares measuring others exactly.
    const bool is_step = &from == &previous_ && &to == &current_;
    const std::size_t nearest =
        is_step ? nearest_pair_
                : *std::ranges::min_element(pairs, {}, [&](std::size_t i) { return to.bounds[i].clearance; });
    // Upper bound for all bodies between two steps. It spares computing the motion bounds of most pairs.
    const double max_motion = is_step
                                  ? std::ranges::max(step_displacement_) + cell_.max_arc_excess(to.joints - from.joints)
                                  : core::kInfinity;
    State& middle = midpoints_[bisections];
    middle.pairs.clear();
    const auto sweep_or_bisect = [&](std::size_t pair) {
        if (!sweep_pair(from, to, pair, bisections, result)) middle.pairs.push_back(pair);
    };
    sweep_or_bisect(nearest);
    for (const std::size_t pair : pairs) {
        const double nearer_end = std::min(from.bounds[pair].clearance, to.bounds[pair].clearance);
        if (pair != nearest && nearer_end - max_motion < result.upper_bound) sweep_or_bisect(pair);
    }
    if (middle.pairs.empty()) return;
    place_midpoint(from, to, middle);
    sweep(from, middle, middle.pairs, bisections + 1, result);
    sweep(middle, to, middle.pairs, bisections + 1, result);
}

} // namespace fettle::robot
