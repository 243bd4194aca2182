// Copyright: the authors of fettle.  SPDX-License-Identifier: Apache-2.0 OR GPL-2.0-or-later
//
// A realtime component of LinuxCNC's HAL, for its simulation: the head over its stock, stepped by the servo thread, so
// that the transducer's reading belongs to the position of the drives, whatever the load of the computer. Loaded with
// stock=FILE (fettle-stock-linuxcnc); when it is unloaded the ground stock is in FILE.ground.

#include "core/error.h"
#include "gantry/simulated_head.h"
#include "realtime.h"

#include <fstream>
#include <memory>

#pragma GCC visibility push(default) // LinuxCNC finds what describes the module by name
extern "C" {
MODULE_LICENSE("GPL");
static char* stock = nullptr;
RTAPI_MP_STRING(stock, "file of the stock")
}
#pragma GCC visibility pop

using namespace fettle;

namespace {

struct Pins {
    hal_float_t *x, *y, *z, *plate_x, *plate_y, *plate_z, *plate_radius; // in, mm
    hal_bit_t *known, *probe, *new_wheel;     // in; until the position of the drives is known there is no contact
    hal_float_t *deflection, *force, *radius; // out, mm, N
};

// The positions are valid a period after the flag that homing has ended.
constexpr long kSettlingPeriods = 10;

int component = -1;
long known_periods = 0; // periods
Pins* pins = nullptr;
std::unique_ptr<gantry::SimulatedHead> head;

Eigen::Vector3d point(const hal_float_t* x, const hal_float_t* y, const hal_float_t* z)
{
    const double at[] = {*x, *y, *z}; // a copy that is not volatile
    return {at[0], at[1], at[2]};
}

void step(void*, long period)
{
    known_periods = *pins->known ? known_periods + 1 : 0;
    if (known_periods < kSettlingPeriods) return;
    if (*pins->new_wheel) head->renew_wheel();
    const double radius = *pins->plate_radius;
    head->step(point(pins->x, pins->y, pins->z), static_cast<double>(period) * kNanosecond,
               *pins->probe ? gantry::SimulatedHead::Tool::probe : gantry::SimulatedHead::Tool::wheel,
               {point(pins->plate_x, pins->plate_y, pins->plate_z), radius});
    *pins->deflection = head->deflection();
    *pins->force = head->force();
    *pins->radius = head->radius();
}

bool export_pins()
{
    const auto number = [](hal_pin_dir_t direction, hal_float_t** pin, const char* name) {
        return number_pin(component, direction, pin, std::string("fettle-head.") + name);
    };
    const auto flag = [](hal_bit_t** pin, const char* name) {
        return flag_pin(component, HAL_IN, pin, std::string("fettle-head.") + name);
    };
    return number(HAL_IN, &pins->x, "x") && number(HAL_IN, &pins->y, "y") && number(HAL_IN, &pins->z, "z") &&
           number(HAL_IN, &pins->plate_x, "plate-x") && number(HAL_IN, &pins->plate_y, "plate-y") &&
           number(HAL_IN, &pins->plate_z, "plate-z") && number(HAL_IN, &pins->plate_radius, "plate-radius") &&
           flag(&pins->known, "known") && flag(&pins->probe, "probe") && flag(&pins->new_wheel, "new-wheel") &&
           number(HAL_OUT, &pins->deflection, "deflection") && number(HAL_OUT, &pins->force, "force") &&
           number(HAL_OUT, &pins->radius, "radius") &&
           hal_export_funct("fettle-head", step, nullptr, 1, 0, component) == 0;
}

} // namespace

extern "C" __attribute__((visibility("default"))) int rtapi_app_main(void)
{
    component = hal_init("fettle_head");
    if (component < 0) return component;
    try {
        head = std::make_unique<gantry::SimulatedHead>(gantry::read_head(stock == nullptr ? "" : stock));
        pins = static_cast<Pins*>(hal_malloc(sizeof(Pins)));
        if (pins != nullptr && export_pins() && hal_ready(component) == 0) return 0;
        rtapi_print_msg(RTAPI_MSG_ERR, "fettle_head: no room in HAL\n");
    } catch (const std::exception& error) {
        rtapi_print_msg(RTAPI_MSG_ERR, "fettle_head: %s\n", error.what());
    }
    hal_exit(component);
    return -1;
}

extern "C" __attribute__((visibility("default"))) void rtapi_app_exit(void)
{
    hal_exit(component);
    std::ofstream out(std::string(stock) + ".ground", std::ios::binary);
    gantry::write_head(out, head->head());
}
