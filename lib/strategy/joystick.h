#pragma once

#include "strategy/steering.h"

#include <linux/joystick.h>

namespace fettle::strategy {

/// Applies an event of a Linux joystick: axes 0 and 1 set the direction; button 0 held: up, button 1: end, 2: record,
/// 3: next, 4: stop, 5: start, 6: automatic, 7: manual, 8: back, 9 and 10: turn the head left and right.
void apply_event(const js_event& event, Stick& stick);

} // namespace fettle::strategy
