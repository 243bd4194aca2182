#include "strategy/layer_switching.h"

#include "core/text.h"

#include <algorithm>
#include <cmath>

namespace fettle {

namespace {
// Lines are read from a file: a step-over equal to their distance within rounding reaches the next one.
constexpr double kSameLine = 1e-6;
} // namespace

LayerSwitching::LayerSwitching(const std::vector<ToolPass>& passes, const Settings& settings)
    : passes_(passes), settings_(settings)
{
    levels_.push_back({});
}

Action LayerSwitching::first() { return start_covering(Event::start); }

Action LayerSwitching::next(const Measurement& measurement)
{
    ++counts_.steps;
    Level& level = levels_.back();
    level.most_force = std::max(level.most_force, measurement.force);
    if (counts_.steps > settings_.bounds.steps) return fail("steps " + std::to_string(settings_.bounds.steps));
    if (measurement.time > settings_.bounds.time) return fail("time " + to_short_text(settings_.bounds.time) + " s");

    if (cut_ended_) return end_cut();
    if (measurement.force > settings_.force_max) return go_up();
    if (layer() > 1) return go_on_above(measurement.force);
    return go_on_in_layer_1(measurement.remaining);
}

Action LayerSwitching::fail(const std::string& bound)
{
    const Level& level = levels_.back();
    failure_ = "bound reached: " + bound + "; in layer " + std::to_string(layer()) + ", pass " +
               std::to_string(level.at.pass + 1) + ", covering " + std::to_string(counts_.coverings + 1) + ", re-cut " +
               std::to_string(level.re_cuts);
    return act(Action::Kind::fail, Event::bound);
}

// Rule 1.
Action LayerSwitching::go_up()
{
    if (layer() >= settings_.bounds.layers) return fail("layers " + std::to_string(settings_.bounds.layers));
    const Level& left = levels_.back();
    levels_.push_back({left.at, left.direction, left.at, left.direction, true, along(left.at), 0, 0});
    ++counts_.raises;
    counts_.highest_layer = std::max(counts_.highest_layer, layer());
    return act(Action::Kind::lift, Event::up);
}

// Rule 2.
Action LayerSwitching::go_on_in_layer_1(double remaining)
{
    Level& level = levels_.back();
    if (!settings_.finish_passes)
        worst_remaining_ = std::max(worst_remaining_, remaining);
    else if (turn_back(remaining) && strokes_ > settings_.bounds.re_cuts)
        return fail("strokes of a pass " + std::to_string(settings_.bounds.re_cuts));
    const ToolPass& pass = passes_[level.at.pass];
    const int point = level.at.point + level.direction;
    if (point >= 0 && point < int(pass.along.size())) {
        const bool gap = interval_of(level.at.pass, point) != interval_of(level.at.pass, level.at.point);
        level.at.point = point;
        return act(gap ? Action::Kind::travel : Action::Kind::grind, Event::none);
    }
    if (level.at.pass + 1 < int(passes_.size())) {
        const int next = level.at.pass + 1;
        const Action action = step_over_to(next, level.direction > 0 ? int(passes_[next].along.size()) - 1 : 0, true);
        begin_pass();
        return action;
    }
    const bool within = worst_remaining_ <= settings_.remaining;
    if (!within && counts_.coverings + 1 >= settings_.bounds.coverings)
        return fail("coverings of layer 1 " + std::to_string(settings_.bounds.coverings));
    ++counts_.coverings;
    if (within) return act(Action::Kind::finish, Event::finished);
    return start_covering(Event::covering_done);
}

// Rule 3.
Action LayerSwitching::go_on_above(double force)
{
    Level& level = levels_.back();
    const bool in_range = force >= settings_.force_min;
    bool pass_over = false;
    if (in_range)
        level.met_metal = true;
    else
        pass_over = level.met_metal || std::abs(along(level.at) - level.pass_begun) >= settings_.step_over;

    const int point = level.at.point + level.direction;
    const bool inside = point >= 0 && point < int(passes_[level.at.pass].along.size()) &&
                        interval_of(level.at.pass, point) == interval_of(level.at.pass, level.at.point);
    if (!pass_over && inside) {
        level.at.point = point;
        return act(Action::Kind::grind, Event::none);
    }
    const int next = next_pass();
    if (level.met_metal && next < int(passes_.size()))
        return step_over_to(next, nearest_point(next, along(level.at)), false);
    cut_ended_ = true;
    return act(Action::Kind::stay, Event::cut_end);
}

// At the end of a stroke, where too much was left on it: back over that stretch and a point around it, to its farther
// end. Where nothing was: on to the nearer end of the pass.
bool LayerSwitching::turn_back(double remaining)
{
    const int here = levels_.back().at.point, last = last_point();
    const bool high = remaining > settings_.remaining;
    if (high) {
        high_first_ = std::min(high_first_, here);
        high_last_ = std::max(high_last_, here);
    }
    if (here != stroke_end_) return false;
    if (high_last_ < 0) {
        if (here != 0 && here != last) start_stroke(here > last - here ? last : 0);
        return false;
    }
    const int first = std::max(high_first_ - 1, 0), end = std::min(high_last_ + 1, last);
    start_stroke(std::abs(here - first) >= std::abs(end - here) ? first : end);
    if (high) high_first_ = high_last_ = here; // it is not on the new stroke
    ++strokes_;
    ++counts_.strokes;
    return true;
}

void LayerSwitching::begin_pass()
{
    strokes_ = 0;
    start_stroke(levels_.back().at.point == 0 ? last_point() : 0);
}

void LayerSwitching::start_stroke(int end)
{
    Level& level = levels_.back();
    stroke_end_ = end;
    if (end != level.at.point) level.direction = end > level.at.point ? +1 : -1;
    high_first_ = last_point() + 1;
    high_last_ = -1;
}

int LayerSwitching::last_point() const { return int(passes_[levels_.back().at.pass].along.size()) - 1; }

Action LayerSwitching::end_cut()
{
    cut_ended_ = false;
    Level& level = levels_.back();
    if (level.most_force > settings_.force_down) {
        if (level.re_cuts >= settings_.bounds.re_cuts)
            return fail("re-cuts " + std::to_string(settings_.bounds.re_cuts));
        ++level.re_cuts;
        ++counts_.re_cuts;
        ++counts_.passes;
        level.at = level.entered;
        level.direction = level.entry_direction;
        level.met_metal = false;
        level.pass_begun = along(level.at);
        level.most_force = 0;
        return act(Action::Kind::travel, Event::re_cut);
    }
    levels_.pop_back();
    return act(Action::Kind::travel, Event::down);
}

Action LayerSwitching::start_covering(Event event)
{
    const Place start{};
    levels_.back() = {start, +1, start, +1, true, along(start), 0, 0};
    worst_remaining_ = 0;
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
    level.pass_begun = along(level.at);
    ++counts_.passes;
    return act(Action::Kind::grind, Event::step_over);
}

// The farthest line within the step-over, but at least the next one.
int LayerSwitching::next_pass() const
{
    const int here = levels_.back().at.pass;
    const double reach = passes_[here].line + settings_.step_over * (1 + kSameLine);
    int next = here + 1;
    while (next + 1 < int(passes_.size()) && passes_[next + 1].line <= reach) ++next;
    return next;
}

int LayerSwitching::nearest_point(int pass, double along) const
{
    const std::vector<double>& places = passes_[pass].along;
    const auto after = std::lower_bound(places.begin(), places.end(), along);
    if (after == places.end()) return int(places.size()) - 1;
    if (after == places.begin()) return 0;
    return int(after - places.begin()) - (*after - along > along - *(after - 1) ? 1 : 0);
}

int LayerSwitching::interval_of(int pass, int point) const
{
    const std::vector<int>& starts = passes_[pass].starts;
    return int(std::upper_bound(starts.begin(), starts.end(), point) - starts.begin());
}

LayerSwitching::Settings strategy_settings(const Plan& plan)
{
    LayerSwitching::Settings settings;
    settings.force_min = plan.job.force.min;
    settings.force_down = plan.job.force.down;
    settings.force_max = plan.job.force.max;
    settings.step_over = plan.job.feed.step_over;
    settings.remaining = plan.job.tolerance * (1 - kLeftoverPerTolerance);
    settings.bounds = plan.bounds;
    return settings;
}

} // namespace fettle
