#include "strategy/layer_switching.h"

#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fettle::strategy {
namespace {

/// Tolerance of the distances between lines, which are read from a file, relative to the step-over.
constexpr double kRelativeLineTolerance = 1e-6;

} // namespace

LayerSwitching::LayerSwitching(const std::vector<plan::ToolPass>& passes, const Settings& settings,
                               ForcePredictions predictions)
    : passes_(passes), settings_(settings), predictions_(std::move(predictions)),
      remaining_(passes.size(), std::numeric_limits<double>::infinity())
{
    levels_.push_back({});
}

Action LayerSwitching::first()
{
    roughing_ = has_close_lines();
    return start_covering(Event::start);
}

Action LayerSwitching::next(const Measurement& measurement)
{
    ++counts_.steps;
    Level& level = levels_.back();
    level.max_force = std::max(level.max_force, measurement.force);
    if (counts_.steps > settings_.bounds.steps) return fail("steps " + std::to_string(settings_.bounds.steps));
    if (measurement.time > settings_.bounds.time)
        return fail("time " + core::to_short_text(settings_.bounds.time) + " s");

    if (cut_ended_) return end_cut();
    if (measurement.force > settings_.force_max) return raise_layer();
    if (layer() > 1) return advance_above_layer_1(measurement.force);
    return advance_in_layer_1(measurement.remaining);
}

Action LayerSwitching::fail(const std::string& limit)
{
    const Level& level = levels_.back();
    failure_ = "limit reached: " + limit + "; in layer " + std::to_string(layer()) + ", pass " +
               std::to_string(level.at.pass + 1) + ", covering " + std::to_string(counts_.coverings + 1) + ", re-cut " +
               std::to_string(level.re_cuts);
    return act(Action::Kind::fail, Event::limit_reached);
}

/// Implements rule 1 of the class.
Action LayerSwitching::raise_layer()
{
    if (layer() >= settings_.bounds.layers)
        return fail("layers " + std::to_string(settings_.bounds.layers) +
                    (settings_.ends_at_safe_height ? ": the next one is above the safe height" : ""));
    levels_.push_back(level_from(levels_.back().at, levels_.back().direction, true, 0));
    ++counts_.raises;
    counts_.highest_layer = std::max(counts_.highest_layer, layer());
    return act(Action::Kind::lift, Event::up);
}

/// Implements rule 2.
Action LayerSwitching::advance_in_layer_1(double remaining)
{
    Level& level = levels_.back();
    if (!roughing_ && !settings_.finish_passes)
        remaining_[level.at.pass] = std::max(remaining_[level.at.pass], remaining);
    if (!roughing_ && settings_.finish_passes && turn_back(remaining) && strokes_ > settings_.bounds.re_cuts)
        return fail("strokes of a pass " + std::to_string(settings_.bounds.re_cuts));
    const int point = level.at.point + level.direction;
    if (point >= 0 && point <= last_point()) {
        const bool gap = interval_of(level.at.pass, point) != interval_of(level.at.pass, level.at.point);
        level.at.point = point;
        return act(gap ? Action::Kind::travel : Action::Kind::grind, Event::none);
    }
    const int next = roughing_ ? farthest_pass(level.at.pass) : unfinished_pass(level.at.pass + 1);
    if (next >= int(passes_.size())) return end_covering();
    const Action action = step_over_to(next, level.direction > 0 ? last_point(next) : 0, true);
    begin_pass();
    return action;
}

/// Finishes, or starts the next covering of layer 1.
Action LayerSwitching::end_covering()
{
    if (roughing_) {
        roughing_ = false;
        return start_covering(Event::roughed);
    }
    const bool within = *std::max_element(remaining_.begin(), remaining_.end()) <= settings_.max_remaining;
    if (!within && counts_.coverings + 1 >= settings_.bounds.coverings)
        return fail("coverings of layer 1 " + std::to_string(settings_.bounds.coverings));
    ++counts_.coverings;
    if (within) return act(Action::Kind::finish, Event::finished);
    return start_covering(Event::covering_done);
}

/// The first pass from `first` on that the covering of layer 1 grinds. There is one at the start of a covering: the one
/// before it left a pass unfinished, and roughing finishes none.
int LayerSwitching::unfinished_pass(int first) const
{
    const auto is_finished = [&](int pass) { return remaining_[pass] <= settings_.max_remaining; };
    while (settings_.skip_finished_passes && first < int(passes_.size()) && is_finished(first)) ++first;
    return first;
}

/// Implements rule 3.
Action LayerSwitching::advance_above_layer_1(double force)
{
    Level& level = levels_.back();
    level.cut.push_back(level.at);
    const bool in_range = force >= settings_.force_min;
    const bool pass_ended =
        !in_range && (level.met_metal || std::abs(along(level.at) - level.pass_start) >= settings_.step_over ||
                      starts_below_force_min(level.at, level.direction, level.pass_start));
    level.met_metal = level.met_metal || in_range;

    const int point = level.at.point + level.direction;
    const bool inside = point >= 0 && point <= last_point() &&
                        interval_of(level.at.pass, point) == interval_of(level.at.pass, level.at.point);
    if (!pass_ended && inside) {
        level.at.point = point;
        return act(Action::Kind::grind, Event::none);
    }
    const int next = farthest_pass(level.at.pass);
    if (level.met_metal && next < int(passes_.size())) {
        const PathIndex start = {next, nearest_point(next, along(level.at))};
        if (!starts_below_force_min(start, -level.direction, along(start)))
            return step_over_to(start.pass, start.point, false);
    }
    cut_ended_ = true;
    return act(Action::Kind::stay, Event::cut_end);
}

/// Whether the force is expected to stay below F_min on the rest of a pass's first stretch, which would end the cut.
bool LayerSwitching::starts_below_force_min(const PathIndex& from, int direction, double pass_start) const
{
    if (!predictions_.expected) return false;
    const int interval = interval_of(from.pass, from.point);
    std::vector<PathIndex> stretch;
    for (PathIndex at = from; at.point >= 0 && at.point <= last_point(at.pass); at.point += direction) {
        if (interval_of(at.pass, at.point) != interval) break;
        stretch.push_back(at);
        if (std::abs(along(at) - pass_start) >= settings_.step_over) break;
    }
    return stretch.size() > 1 && predictions_.expected(stretch, layer()) < settings_.force_min;
}

/// At the end of a stroke that left too much, starts a stroke back over the stretch where it did, plus a point on
/// either side, towards its farther end. If nothing is left, continues to the nearer end of the pass.
/// @return  whether a stroke is repeated
bool LayerSwitching::turn_back(double remaining)
{
    const int here = levels_.back().at.point, last = last_point();
    const bool high = remaining > settings_.max_remaining;
    if (high) {
        first_high_ = std::min(first_high_, here);
        last_high_ = std::max(last_high_, here);
    }
    if (here != stroke_end_) return false;
    if (last_high_ < 0) {
        if (here != 0 && here != last) start_stroke(here > last - here ? last : 0);
        return false;
    }
    const int first = std::max(first_high_ - 1, 0), end = std::min(last_high_ + 1, last);
    start_stroke(std::abs(here - first) >= std::abs(end - here) ? first : end);
    if (high) first_high_ = last_high_ = here; // the new stroke does not visit this point
    ++strokes_;
    ++counts_.strokes;
    return true;
}

void LayerSwitching::begin_pass()
{
    if (!roughing_) remaining_[levels_.back().at.pass] = 0;
    strokes_ = 0;
    start_stroke(levels_.back().at.point == 0 ? last_point() : 0);
}

void LayerSwitching::start_stroke(int end)
{
    Level& level = levels_.back();
    stroke_end_ = end;
    if (end != level.at.point) level.direction = end > level.at.point ? +1 : -1;
    first_high_ = last_point() + 1;
    last_high_ = -1;
}

Action LayerSwitching::end_cut()
{
    cut_ended_ = false;
    Level& level = levels_.back();
    if (needs_re_cut(level)) {
        if (level.re_cuts >= settings_.bounds.re_cuts)
            return fail("re-cuts " + std::to_string(settings_.bounds.re_cuts));
        ++counts_.re_cuts;
        ++counts_.passes;
        level = level_from(level.entered, level.entry_direction, false, level.re_cuts + 1);
        return act(Action::Kind::travel, Event::re_cut);
    }
    if (level.max_force > settings_.force_down) ++counts_.skipped_re_cuts;
    levels_.pop_back();
    return act(Action::Kind::travel, Event::down);
}

bool LayerSwitching::needs_re_cut(const Level& level) const
{
    return level.max_force > settings_.force_down &&
           !(predictions_.upper_bound && predictions_.upper_bound(level.cut, layer()) <= settings_.force_down);
}

Action LayerSwitching::start_covering(Event event)
{
    levels_.back() = level_from({unfinished_pass(0), 0}, +1, true, 0);
    begin_pass();
    ++counts_.passes;
    return act(Action::Kind::travel, event);
}

Action LayerSwitching::step_over_to(int pass, int point, bool met_metal)
{
    Level& level = levels_.back();
    level.at = {pass, point};
    level.direction = -level.direction;
    level.met_metal = met_metal;
    level.pass_start = along(level.at);
    ++counts_.passes;
    return act(Action::Kind::grind, Event::step_over);
}

bool LayerSwitching::has_close_lines() const
{
    for (int pass = 0; pass < int(passes_.size()); ++pass)
        if (farthest_pass(pass) > pass + 1) return true;
    return false;
}

/// The farthest line within the step-over, but at least the next one.
int LayerSwitching::farthest_pass(int here) const
{
    const double reach = passes_[here].line + settings_.step_over * (1 + kRelativeLineTolerance);
    int next = here + 1;
    while (next + 1 < int(passes_.size()) && passes_[next + 1].line <= reach) ++next;
    return next;
}

int LayerSwitching::nearest_point(int pass, double along) const
{
    const std::vector<double>& points = passes_[pass].along;
    const auto after = std::lower_bound(points.begin(), points.end(), along);
    if (after == points.end()) return int(points.size()) - 1;
    if (after == points.begin()) return 0;
    return int(after - points.begin()) - (*after - along > along - *(after - 1) ? 1 : 0);
}

int LayerSwitching::interval_of(int pass, int point) const
{
    const std::vector<int>& starts = passes_[pass].starts;
    return int(std::upper_bound(starts.begin(), starts.end(), point) - starts.begin());
}

LayerSwitching::Settings strategy_settings(const plan::Plan& plan)
{
    // The plan's bound follows from the lowest point of the surface; the start is not below that.
    const double layer_above = plan.start.z() + plan.layers.distance * plan.bounds.layers;
    return {.force_min = plan.job.force.min,
            .force_down = plan.job.force.down,
            .force_max = plan.job.force.max,
            .step_over = plan.job.feed.step_over,
            .max_remaining = plan.job.tolerance * (1 - plan::kScallopPerTolerance),
            .ends_at_safe_height = layer_above > plan.job.safe_height,
            .bounds = plan.bounds};
}

} // namespace fettle::strategy
