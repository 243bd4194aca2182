// Copyright: the authors of fettle.  SPDX-License-Identifier: Apache-2.0 OR GPL-2.0-or-later
//
// A realtime component of LinuxCNC's HAL: holds the deflection of the head's spring, and so its force, by an external
// offset of Z, from where Z is commanded down to `lowest`. The loop is that of the dynamic virtual gantry.

#include "gantry/force_loop.h"
#include "realtime.h"

#include <algorithm>
#include <cmath>
#include <optional>

#pragma GCC visibility push(default) // LinuxCNC finds what describes the module by name
extern "C" {
MODULE_LICENSE("GPL");
}
#pragma GCC visibility pop

using namespace fettle;

namespace {

// The speed is limited so that Z can stop at its lowest position with this share of its acceleration.
constexpr double kBrakingShare = 0.5;
// Share of the desired deflection that counts as a contact: from then on the speed of the search is no limit.
constexpr double kContactShare = 0.1;

struct Pins {
    hal_bit_t *hold, *freeze;                          // in; hold: the offset controls the force; freeze: it stays
    hal_float_t *wanted, *seen;                        // in, desired and measured deflection, mm
    hal_float_t *z, *lowest, *applied;                 // in, position of Z, its lower bound, its current offset, mm
    hal_float_t *gain, *speed, *acceleration, *search; // in, 1/s, mm/s, mm/s², mm/s
    hal_float_t* offset;                               // out, mm
};

int component = -1;
Pins* pins = nullptr;
std::optional<gantry::ForceLoop> loop;
double velocity = 0; // mm/s

void step(void*, long period)
{
    if (*pins->freeze) return;
    if (!*pins->hold) {
        *pins->offset = 0;
        velocity = 0;
        loop.reset();
        return;
    }
    const double dt = static_cast<double>(period) * kNanosecond;
    const double acceleration = *pins->acceleration, speed = *pins->speed;
    if (!loop) loop.emplace(gantry::force_gains(*pins->gain), dt, speed, acceleration);
    const double min_offset = std::min(*pins->lowest - (*pins->z - *pins->applied), 0.0);
    const double offset = *pins->offset, distance = std::max(offset - min_offset, 0.0);
    const double max_down = *pins->seen > kContactShare * *pins->wanted ? speed : double(*pins->search);
    const double braking_speed = std::sqrt(2 * kBrakingShare * acceleration * distance);
    velocity = loop->step(*pins->wanted, *pins->seen, velocity, std::min(max_down, braking_speed));
    const double next = std::clamp(offset + velocity * dt, min_offset, 0.0);
    velocity = (next - offset) / dt;
    *pins->offset = next;
}

bool export_pins()
{
    const auto number = [](hal_pin_dir_t direction, hal_float_t** pin, const char* name) {
        return number_pin(component, direction, pin, std::string("fettle-press.") + name);
    };
    return flag_pin(component, HAL_IN, &pins->hold, "fettle-press.hold") &&
           flag_pin(component, HAL_IN, &pins->freeze, "fettle-press.freeze") &&
           number(HAL_IN, &pins->wanted, "wanted") && number(HAL_IN, &pins->seen, "seen") &&
           number(HAL_IN, &pins->z, "z") && number(HAL_IN, &pins->lowest, "lowest") &&
           number(HAL_IN, &pins->applied, "applied") && number(HAL_IN, &pins->gain, "gain") &&
           number(HAL_IN, &pins->speed, "speed") && number(HAL_IN, &pins->acceleration, "acceleration") &&
           number(HAL_IN, &pins->search, "search") && number(HAL_OUT, &pins->offset, "offset") &&
           hal_export_funct("fettle-press", step, nullptr, 1, 0, component) == 0;
}

} // namespace

extern "C" __attribute__((visibility("default"))) int rtapi_app_main(void)
{
    component = hal_init("fettle_press");
    if (component < 0) return component;
    pins = static_cast<Pins*>(hal_malloc(sizeof(Pins)));
    if (pins != nullptr && export_pins() && hal_ready(component) == 0) return 0;
    rtapi_print_msg(RTAPI_MSG_ERR, "fettle_press: no room in HAL\n");
    hal_exit(component);
    return -1;
}

extern "C" __attribute__((visibility("default"))) void rtapi_app_exit(void) { hal_exit(component); }
