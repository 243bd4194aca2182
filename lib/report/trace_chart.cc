#include "core/constants.h"
#include "core/text.h"
#include "draw/figures.h"
#include "draw/svg.h"
#include "report/charts.h"
#include "strategy/layer_switching.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fettle::report {
namespace {

using draw::svg::Anchor;
using draw::svg::coordinate;
using Eigen::Index;
using Eigen::Vector2d;

constexpr double kWidth = 720, kLeft = 52, kRight = 646;
constexpr double kForceTop = 46, kForceBottom = 196, kGap = 30, kFeedHeight = 44;
// About so many labels: a step is up to 2.5 times as long as that asks for, so that with three one lies above 0.
constexpr int kFeedTicks = 3;
constexpr double kMinAxisLength = 1e-9; // instead of 0
constexpr double kPixelsPerLayer = 12, kMinLayerHeight = 34, kMaxLayerHeight = 110;

/// Polyline with far more points than the drawing has pixels: for each column of half a pixel it keeps the first,
/// minimum, maximum and last value, so that no peak is lost.
class ThinnedLine {
  public:
    ThinnedLine(const draw::svg::Axis& x, const draw::svg::Axis& y) : x_(x), y_(y) {}

    void add(double at, double value)
    {
        const double column = std::floor(2 * x_(at));
        if (column != column_) flush();
        column_ = column;
        if (values_[0] != values_[0]) values_ = {value, value, value, value};
        values_[1] = std::min(values_[1], value);
        values_[2] = std::max(values_[2], value);
        values_[3] = value;
        at_ = at;
    }
    /// Ends the current stroke; the next point starts a new one.
    void lift()
    {
        flush();
        up_ = true;
    }
    std::string path() &&
    {
        flush();
        return std::move(path_);
    }

  private:
    void flush()
    {
        if (values_[0] != values_[0]) return;
        double before = core::kNaN;
        for (const double value : values_) {
            if (value == before) continue;
            path_ += (up_ ? "M" : "L") + coordinate(x_(at_)) + " " + coordinate(y_(value));
            up_ = false;
            before = value;
        }
        values_.fill(core::kNaN);
    }

    draw::svg::Axis x_, y_;
    std::string path_;
    std::array<double, 4> values_ = {core::kNaN, core::kNaN, core::kNaN, core::kNaN};
    double column_ = core::kNaN, at_ = 0;
    bool up_ = true;
};

/// Path of a value that is constant from one row of the trace to the next, as steps.
std::string steps(const Eigen::VectorXd& t, const Eigen::VectorXd& values, const draw::svg::Axis& x,
                  const draw::svg::Axis& y)
{
    ThinnedLine line(x, y);
    for (Index i = 0; i < t.size(); ++i) {
        if (!std::isfinite(values[i])) {
            line.lift();
            continue;
        }
        line.add(i == 0 ? 0 : t[i - 1], values[i]); // a row describes the move that ends at its time
        line.add(t[i], values[i]);
    }
    return std::move(line).path();
}

/// A marker above the chart for an event.
struct Sign {
    strategy::Event event;
    const char* name;
    const char* path; ///< about (0, 0)
    const char* style;
    double y; ///< of its row, pixels
};
constexpr std::array<Sign, 6> kSigns = {
    {{strategy::Event::touch_off, "wheel measured", "M-4 -4H4L0 4Z", "sign-blue", 8},
     {strategy::Event::wheel_change, "new wheel", "M-4 -4H4V4H-4Z", "sign-purple", 8},
     {strategy::Event::re_cut, "re-cut", "M0 -5L4 0L0 5L-4 0Z", "sign-orange", 21},
     {strategy::Event::covering_done, "covering done", "M-4 4H4L0 -4Z", "sign-green", 21},
     {strategy::Event::roughed, "layer 1 roughed", "M-4 -4H4L0 4Z", "sign-green", 21},
     {strategy::Event::limit_reached, "limit reached", "M-4 -4L4 4M4 -4L-4 4", "sign-cross", 21}}};

draw::Html sign(const Sign& s, const Vector2d& at)
{
    return draw::empty_element("path",
                               {{"d", s.path},
                                {"class", s.style},
                                {"transform", "translate(" + coordinate(at.x()) + " " + coordinate(at.y()) + ")"}});
}

/// The markers of the events, and a key of those that occur.
draw::Html signs(const Eigen::VectorXd& t, const Eigen::VectorXd& events, const draw::svg::Axis& x, double key_y)
{
    draw::Html html;
    double key_x = kLeft;
    for (const Sign& s : kSigns) {
        double last = -1;
        for (Index i = 0; i < t.size(); ++i) {
            const double at = x(t[i]);
            if (events[i] != static_cast<int>(s.event) || at - last < 1) continue; // markers within a pixel overlap
            html += sign(s, {at, s.y});
            last = at;
        }
        if (last < 0) continue;
        html += sign(s, {key_x + 4, key_y - 4}) + draw::svg::text({key_x + 14, key_y}, s.name);
        constexpr double kLetterWidth = 6.6, kGapWidth = 34;
        key_x += kLetterWidth * double(std::string(s.name).size()) + kGapWidth;
    }
    html += draw::svg::box({key_x, key_y - 9}, {10, 10}, "idle") +
            draw::svg::text({key_x + 15, key_y}, "travel and service: not grinding");
    return html;
}

/// The times without grinding, as pale columns.
draw::Html idle_times(const Eigen::VectorXd& t, const Eigen::VectorXd& feed, const draw::svg::Axis& x, double bottom)
{
    constexpr double kMinWidth = 0.7; // pixels
    draw::Html html;
    for (Index i = 0; i < t.size(); ++i) {
        if (feed[i] > 0) continue;
        const double from = i == 0 ? 0 : t[i - 1];
        Index last = i;
        while (last + 1 < t.size() && !(feed[last + 1] > 0)) ++last;
        if (x(t[last]) - x(from) > kMinWidth)
            html += draw::svg::box({x(from), kForceTop}, {x(t[last]) - x(from), bottom - kForceTop}, "idle");
        i = last;
    }
    return html;
}

draw::Html force_panel(const Eigen::VectorXd& t, const Eigen::VectorXd& force, const Eigen::VectorXd& feed,
                       const draw::svg::Axis& x, const std::optional<job::Job>& job, const units::Units& units)
{
    double max_force = job ? job->force.max : kMinAxisLength;
    for (const double f : force) max_force = std::isfinite(f) ? std::max(max_force, f) : max_force;
    max_force /= units.newton();
    const draw::svg::Axis y = {0, 1.08 * max_force, kForceBottom, kForceTop};
    draw::Html html = draw::svg::ticks_left(y, x.begin, x.end, 5);
    html +=
        draw::svg::text({x.begin, kForceTop - 6}, "force, " + units::to_string(units.force), Anchor::start, "panel");
    ThinnedLine line(x, y);
    for (Index i = 0; i < t.size(); ++i) {
        if (feed[i] > 0 && std::isfinite(force[i]))
            line.add(t[i], force[i] / units.newton());
        else
            line.lift();
    }
    html += draw::svg::path(std::move(line).path(), "force");
    if (!job) return html;
    for (const auto& [name, value] :
         {std::pair{"F_max", job->force.max}, {"F_down", job->force.down}, {"F_min", job->force.min}}) {
        const double at = y(value / units.newton());
        html += draw::svg::line({x.begin, at}, {x.end, at}, "limit");
        html +=
            draw::svg::text({x.end + 6, at + 4}, std::string(name) + " " + draw::short_text(value / units.newton()));
    }
    return html;
}

} // namespace

draw::Html trace_chart(const cloud::Cloud& trace, const std::optional<job::Job>& job, const units::Units& units)
{
    const Eigen::VectorXd t = cloud::field(trace, "t"), force = cloud::field(trace, "force"),
                          feed = cloud::field(trace, "feed");
    const Eigen::VectorXd layer = cloud::field(trace, "layer"), events = cloud::field(trace, "event");
    if (t.size() == 0) return {};
    constexpr double kMaxSeconds = 600; // longer times are shown in minutes
    const double unit = t.maxCoeff() > kMaxSeconds ? 60 : 1;
    const Eigen::VectorXd time = t / unit;
    const draw::svg::Axis x = {0, std::max(time.maxCoeff(), kMinAxisLength), kLeft, kRight};

    double max_feed = kMinAxisLength;
    for (const double f : feed) max_feed = std::isfinite(f) ? std::max(max_feed, f) : max_feed;
    const double layers = std::max(1.0, layer.maxCoeff());
    const double layer_top = kForceBottom + kGap;
    const double layer_bottom = layer_top + std::clamp(kPixelsPerLayer * layers, kMinLayerHeight, kMaxLayerHeight);
    const double feed_top = layer_bottom + kGap, bottom = feed_top + kFeedHeight;
    const draw::svg::Axis layer_y = {0.5, layers + 0.5, layer_bottom, layer_top};
    const draw::svg::Axis feed_y = {0, 1.15 * max_feed / units.mm(), bottom, feed_top};

    draw::Html html = idle_times(time, feed, x, bottom);
    html += draw::svg::ticks_below(x, kForceTop, bottom, 9);
    html += force_panel(time, force, feed, x, job, units);
    html += draw::svg::ticks_left(layer_y, x.begin, x.end, static_cast<int>(std::min(4.0, layers)));
    html += draw::svg::text({x.begin, layer_top - 6}, "layer", Anchor::start, "panel");
    html += draw::svg::path(steps(time, layer, x, layer_y), "layer");
    html += draw::svg::ticks_left(feed_y, x.begin, x.end, kFeedTicks);
    html += draw::svg::text({x.begin, feed_top - 6}, "feed, " + units::to_string(units.length) + "/s", Anchor::start,
                            "panel");
    html += draw::svg::path(steps(time, feed / units.mm(), x, feed_y), "feed");
    html += draw::svg::text({kRight + 6, bottom + 15}, unit > 1 ? "min" : "s");
    // Where a page plays the run (section_grinding.cc), its script moves the cursor along this box.
    html += draw::empty_element("rect", {{"class", "time-axis"},
                                         {"x", coordinate(x.begin)},
                                         {"y", coordinate(kForceTop)},
                                         {"width", coordinate(x.end - x.begin)},
                                         {"height", coordinate(bottom - kForceTop)},
                                         {"data-seconds", core::to_text(x.max * unit)}});
    html += draw::svg::line({x.begin, kForceTop}, {x.begin, bottom}, "cursor");
    html += signs(time, events, x, bottom + 38);
    return draw::svg::drawing(kWidth, bottom + 46, "force, layer and feed against time", html);
}

} // namespace fettle::report
