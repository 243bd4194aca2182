#include "machining/nc_writer.h"

#include "core/fixed_text.h"
#include "units/units.h"

#include <cmath>
#include <ostream>

namespace fettle::machining {

std::string NcWriter::number(double mm) const
{
    return inches_ ? core::to_fixed_text(mm / units::mm_per(units::Units::Length::in), 7) : core::to_fixed_text(mm, 5);
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
    const auto append = [&line](const std::string& word) { line += (line.empty() ? "" : " ") + word; };
    if (motion != motion_ || !centre.empty()) append(motion);
    bool moves = !centre.empty();
    for (int k = 0; k < 3; ++k) {
        if (std::isnan(tip[k]) || (!std::isnan(at_[k]) && number(tip[k]) == number(at_[k]))) continue;
        append(kNames[k] + number(tip[k]));
        at_[k] = tip[k];
        moves = true;
    }
    if (!moves) return;
    motion_ = motion;
    line += centre;
    if (feed > 0 && feed != feed_) append("F" + number((feed_ = feed) * kSecondsPerMinute));
    out_ << line << '\n';
}

void NcWriter::move_to(const Eigen::Vector3d& tip, double feed) { block(feed == 0 ? "G0" : "G1", tip, feed, ""); }

void NcWriter::move_to(const CutterMove& move)
{
    if (move.sweep_angle == 0) return move_to(move.to, move.feed);
    const Eigen::Vector2d centre = move.centre - move.from.head<2>();
    block(move.sweep_angle > 0 ? "G3" : "G2", move.to, move.feed,
          " I" + number(centre.x()) + " J" + number(centre.y()));
}

} // namespace fettle::machining
