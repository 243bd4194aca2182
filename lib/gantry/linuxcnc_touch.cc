// Touches of LinuxCNC's gantry: of the calibration plate with the wheel, and of the part with the probe.

#include "gantry/linuxcnc.h"
#include "gantry/linuxcnc_words.h"

#include <cmath>

namespace fettle::gantry {
namespace {

/// Speeds of the search for the surface, and of the touch that is measured: 0.0005 mm in a period of the servo thread.
constexpr double kSearchSpeed = 10, kTouchSpeed = 0.5; // mm/s
constexpr double kRetract = 0.5;                       // after the first touch, mm
constexpr double kPlateClearance = 3;                  // start of the search above P0, more than the wheel's wear, mm

} // namespace

double LinuxcncGantry::touch_off()
{
    finish_motion();
    update_status();
    const Eigen::Vector2d xy = status_.commanded.head<2>();
    travel_over(plate_.head<2>(), job_.safe_height);
    run("G0" + word("Z", plate_.z() + kPlateClearance));
    const double z = touch_down(plate_.z() - new_radius_);
    if (std::isnan(z)) throw GantryFault("the calibration plate was not found at its position");
    measured_radius_ = z + new_radius_ - plate_.z();
    travel_over(xy, job_.safe_height);
    return measured_radius_;
}

double LinuxcncGantry::probe(const Eigen::Vector2d& xy, double lowest)
{
    finish_motion();
    travel_over(xy, job_.safe_height);
    link_.set_tip(true);
    const auto end = [&] {
        raise_to(job_.safe_height);
        link_.set_tip(false);
        update_status();
    };
    try {
        const double z = touch_down(lowest);
        end();
        return z;
    } catch (const Interrupted&) {
        end();
        throw;
    }
}

/// Searches for a contact downwards; then touches again, slowly. @return  z of the machine; NaN: no contact
double LinuxcncGantry::touch_down(double lowest)
{
    link_.set_touch(true);
    run("G61 G38.3" + word("Z", lowest) + feed_word(kSearchSpeed));
    blending_ = false;
    double z = link_.touched();
    link_.set_touch(false);
    if (std::isnan(z)) return z;
    run("G0" + word("Z", z + kRetract));
    link_.set_touch(true);
    run("G38.2" + word("Z", z - kRetract) + feed_word(kTouchSpeed));
    z = link_.touched() + touch_deflection_;
    link_.set_touch(false);
    return z;
}

} // namespace fettle::gantry
