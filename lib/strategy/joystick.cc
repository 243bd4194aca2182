#include "strategy/joystick.h"

#include <cmath>

namespace fettle::strategy {
namespace {

constexpr double kFullDeflection = 32767; // value of an axis
/// A released stick does not return exactly to its centre.
constexpr double kDeadZone = 0.1; // of the full deflection

} // namespace

void apply_event(const js_event& event, Stick& stick)
{
    const int type = event.type & ~JS_EVENT_INIT;
    if (type == JS_EVENT_AXIS && event.number < 2) {
        const double value = (event.number == 1 ? -event.value : event.value) / kFullDeflection; // axis 1: backwards
        stick.direction[event.number] = std::abs(value) < kDeadZone ? 0 : value;
    }
    if (type == JS_EVENT_BUTTON && event.number == 0) stick.on_part = event.value == 0;
    if (event.type != JS_EVENT_BUTTON || event.value == 0) return; // the state of a button at the start is not a push
    if (event.number == 1) stick.end = true;
    if (event.number == 2) stick.button = Button::record;
    if (event.number == 3) stick.button = Button::next;
}

} // namespace fettle::strategy
