#include "machining/nc_writer.h"

#include "core/fixed_text.h"
#include "units/units.h"

#include <cmath>
#include <ostream>

namespace fettle {

std::string NcWriter::number(double mm) const
{
    return inches_ ? to_fixed_text(mm / mm_per(Units::Length::in), 7) : to_fixed_text(mm, 5);
}

void NcWriter::set_inches(bool inches)
{
    if (inches != inches_) feed_ = 0;
    inches_ = inches;
}

void NcWriter::block(const std::string& motion, const Eigen::Vector3d& tip, double feed, const std::string& centre)
{
    constexpr double kSecondsPerMinute = 60;
    constexpr const char* kNames = "XYZ";
    std::string line;
    const auto say = [&line](const std::string& word) { line += (line.empty() ? "" : " ") + word; };
    if (motion != motion_ || !centre.empty()) say(motion);
    bool moves = !centre.empty();
    for (int k = 0; k < 3; ++k) {
        if (std::isnan(tip[k]) || (!std::isnan(at_[k]) && number(tip[k]) == number(at_[k]))) continue;
        say(kNames[k] + number(tip[k]));
        at_[k] = tip[k];
        moves = true;
    }
    if (!moves) return;
    motion_ = motion;
    line += centre;
    if (feed > 0 && feed != feed_) say("F" + number((feed_ = feed) * kSecondsPerMinute));
    out_ << line << '\n';
}

void NcWriter::go(const Eigen::Vector3d& tip, double feed) { block(feed == 0 ? "G0" : "G1", tip, feed, ""); }

void NcWriter::go(const CutterMove& move)
{
    if (move.sweep == 0) return go(move.to, move.feed);
    const Eigen::Vector2d centre = move.centre - move.from.head<2>();
    block(move.sweep > 0 ? "G3" : "G2", move.to, move.feed, " I" + number(centre.x()) + " J" + number(centre.y()));
}

} // namespace fettle
