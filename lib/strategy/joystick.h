#pragma once

#include "strategy/steering.h"

#include <linux/joystick.h>

namespace fettle {

/// What an event of a Linux joystick changes: axes 0 and 1 say the way, button 0 held: up, button 1: end, 2: record,
/// 3: next.
void hear(const js_event& event, Stick& stick);

} // namespace fettle
