// Copyright: the authors of fettle.  SPDX-License-Identifier: Apache-2.0 OR GPL-2.0-or-later
//
// What the realtime components share: the pins of LinuxCNC's HAL.
#pragma once

#include <string>

#pragma GCC visibility push(default)
extern "C" {
#include <hal.h>
#include <rtapi.h>
#include <rtapi_app.h>
}
#pragma GCC visibility pop

namespace fettle {

inline constexpr double kNanosecond = 1e-9; // s

inline bool number_pin(int component, hal_pin_dir_t direction, hal_float_t** pin, const std::string& name)
{
    return hal_pin_float_newf(direction, pin, component, "%s", name.c_str()) == 0;
}

inline bool flag_pin(int component, hal_pin_dir_t direction, hal_bit_t** pin, const std::string& name)
{
    return hal_pin_bit_newf(direction, pin, component, "%s", name.c_str()) == 0;
}

} // namespace fettle
