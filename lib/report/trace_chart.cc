#include "report/charts.h"
#include "report/figures.h"
#include "report/svg.h"
#include "strategy/layer_switching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fettle {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
using svg::Anchor;
using svg::coordinate;

constexpr double kWidth = 720, kLeft = 52, kRight = 646;
constexpr double kForceTop = 46, kForceBottom = 196, kGap = 30, kFeedHeight = 44;
constexpr double kLeast = 1e-9; // of an axis that would have no length
constexpr double kPerLayer = 12, kLeastLayers = 34, kMostLayers = 110;

/// A line that may have far more points than the drawing has columns: of each column half a pixel wide it keeps the
/// first, least, most and last value, so that no peak is lost.
class ThinnedLine {
  public:
    ThinnedLine(const svg::Axis& x, const svg::Axis& y) : x_(x), y_(y) {}

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
        double before = kNone;
        for (const double value : values_) {
            if (value == before) continue;
            path_ += (up_ ? "M" : "L") + coordinate(x_(at_)) + " " + coordinate(y_(value));
            up_ = false;
            before = value;
        }
        values_.fill(kNone);
    }

    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    svg::Axis x_, y_;
    std::string path_;
    std::array<double, 4> values_ = {kNone, kNone, kNone, kNone};
    double column_ = kNone, at_ = 0;
    bool up_ = true;
};

/// A value that holds from one row to the next, as steps.
std::string steps(const Eigen::VectorXd& t, const Eigen::VectorXd& values, const svg::Axis& x, const svg::Axis& y)
{
    ThinnedLine line(x, y);
    for (Index i = 0; i < t.size(); ++i) {
        if (!std::isfinite(values[i])) {
            line.lift();
            continue;
        }
        line.add(i == 0 ? 0 : t[i - 1], values[i]); // a row tells of the move that ends there
        line.add(t[i], values[i]);
    }
    return std::move(line).path();
}

/// What is marked above the chart: one sign each.
struct Sign {
    Event event;
    const char* name;
    const char* path; ///< about (0, 0)
    const char* style;
    double y; ///< of its row
};
constexpr std::array<Sign, 5> kSigns = {{{Event::touch_off, "wheel measured", "M-4 -4H4L0 4Z", "sign-blue", 8},
                                         {Event::wheel_change, "new wheel", "M-4 -4H4V4H-4Z", "sign-purple", 8},
                                         {Event::re_cut, "re-cut", "M0 -5L4 0L0 5L-4 0Z", "sign-orange", 21},
                                         {Event::covering_done, "covering done", "M-4 4H4L0 -4Z", "sign-green", 21},
                                         {Event::bound, "a bound reached", "M-4 -4L4 4M4 -4L-4 4", "sign-cross", 21}}};

Html sign(const Sign& s, const Vector2d& at)
{
    return lone_element("path", {{"d", s.path},
                                 {"class", s.style},
                                 {"transform", "translate(" + coordinate(at.x()) + " " + coordinate(at.y()) + ")"}});
}

/// The signs in their strip, and the key of those that occur.
Html signs(const Eigen::VectorXd& t, const Eigen::VectorXd& events, const svg::Axis& x, double key_y)
{
    Html html;
    double key_x = kLeft;
    for (const Sign& s : kSigns) {
        double last = -1;
        for (Index i = 0; i < t.size(); ++i) {
            const double at = x(t[i]);
            if (events[i] != static_cast<int>(s.event) || at - last < 1) continue; // one is seen, not all on top of it
            html += sign(s, {at, s.y});
            last = at;
        }
        if (last < 0) continue;
        html += sign(s, {key_x + 4, key_y - 4}) + svg::text({key_x + 14, key_y}, s.name);
        constexpr double kLetter = 6.6, kApart = 34;
        key_x += kLetter * double(std::string(s.name).size()) + kApart;
    }
    html += svg::box({key_x, key_y - 9}, {10, 10}, "idle") +
            svg::text({key_x + 15, key_y}, "travel and service: not grinding");
    return html;
}

/// Where the wheel does not grind, as pale columns.
Html idle_times(const Eigen::VectorXd& t, const Eigen::VectorXd& feed, const svg::Axis& x, double bottom)
{
    constexpr double kSeen = 0.7; // pixels
    Html html;
    for (Index i = 0; i < t.size(); ++i) {
        if (feed[i] > 0) continue;
        const double from = i == 0 ? 0 : t[i - 1];
        Index last = i;
        while (last + 1 < t.size() && !(feed[last + 1] > 0)) ++last;
        if (x(t[last]) - x(from) > kSeen)
            html += svg::box({x(from), kForceTop}, {x(t[last]) - x(from), bottom - kForceTop}, "idle");
        i = last;
    }
    return html;
}

Html force_panel(const Eigen::VectorXd& t, const Eigen::VectorXd& force, const Eigen::VectorXd& feed,
                 const svg::Axis& x, const std::optional<Job>& job, const Units& units)
{
    double most = job ? job->force.max : kLeast;
    for (const double f : force) most = std::isfinite(f) ? std::max(most, f) : most;
    most /= units.newton();
    const svg::Axis y = {0, 1.08 * most, kForceBottom, kForceTop};
    Html html = svg::ticks_left(y, x.begin, x.end, 5);
    html += svg::text({x.begin, kForceTop - 6}, "force, " + to_string(units.force), Anchor::start, "panel");
    ThinnedLine line(x, y);
    for (Index i = 0; i < t.size(); ++i) {
        if (feed[i] > 0 && std::isfinite(force[i]))
            line.add(t[i], force[i] / units.newton());
        else
            line.lift();
    }
    html += svg::path(std::move(line).path(), "force");
    if (!job) return html;
    for (const auto& [name, value] :
         {std::pair{"F_max", job->force.max}, {"F_down", job->force.down}, {"F_min", job->force.min}}) {
        const double at = y(value / units.newton());
        html += svg::line({x.begin, at}, {x.end, at}, "limit");
        html += svg::text({x.end + 6, at + 4}, std::string(name) + " " + short_text(value / units.newton()));
    }
    return html;
}

} // namespace

Html trace_chart(const Cloud& trace, const std::optional<Job>& job, const Units& units)
{
    const Eigen::VectorXd t = field(trace, "t"), force = field(trace, "force"), feed = field(trace, "feed");
    const Eigen::VectorXd layer = field(trace, "layer"), events = field(trace, "event");
    if (t.size() == 0) return {};
    constexpr double kInMinutes = 600; // s
    const double unit = t.maxCoeff() > kInMinutes ? 60 : 1;
    const Eigen::VectorXd time = t / unit;
    const svg::Axis x = {0, std::max(time.maxCoeff(), kLeast), kLeft, kRight};

    double fastest = kLeast;
    for (const double f : feed) fastest = std::isfinite(f) ? std::max(fastest, f) : fastest;
    const double layers = std::max(1.0, layer.maxCoeff());
    const double layer_top = kForceBottom + kGap;
    const double layer_bottom = layer_top + std::clamp(kPerLayer * layers, kLeastLayers, kMostLayers);
    const double feed_top = layer_bottom + kGap, bottom = feed_top + kFeedHeight;
    const svg::Axis layer_y = {0.5, layers + 0.5, layer_bottom, layer_top};
    const svg::Axis feed_y = {0, 1.15 * fastest / units.mm(), bottom, feed_top};

    Html html = idle_times(time, feed, x, bottom);
    html += svg::ticks_below(x, kForceTop, bottom, 9);
    html += force_panel(time, force, feed, x, job, units);
    html += svg::ticks_left(layer_y, x.begin, x.end, static_cast<int>(std::min(4.0, layers)));
    html += svg::text({x.begin, layer_top - 6}, "layer", Anchor::start, "panel");
    html += svg::path(steps(time, layer, x, layer_y), "layer");
    html += svg::ticks_left(feed_y, x.begin, x.end, 2);
    html += svg::text({x.begin, feed_top - 6}, "feed, " + to_string(units.length) + "/s", Anchor::start, "panel");
    html += svg::path(steps(time, feed / units.mm(), x, feed_y), "feed");
    html += svg::text({kRight + 6, bottom + 15}, unit > 1 ? "min" : "s");
    html += signs(time, events, x, bottom + 38);
    return svg::drawing(kWidth, bottom + 46, "force, layer and feed against time", html);
}

} // namespace fettle
