#include "strategy/joystick.h"

#include <cmath>

namespace fettle {
namespace {

constexpr double kFullWay = 32767; // of an axis
/// A stick at rest does not stand quite in the middle.
constexpr double kRest = 0.1;

} // namespace

void hear(const js_event& event, Stick& stick)
{
    const int type = event.type & ~JS_EVENT_INIT;
    const double value = event.value / kFullWay;
    if (type == JS_EVENT_AXIS && event.number < 2)
        stick.way[event.number] = std::abs(value) < kRest ? 0 : event.number == 1 ? -value : value; // forth is less
    if (type == JS_EVENT_BUTTON && event.number == 0) stick.press = event.value == 0;
    if (event.type != JS_EVENT_BUTTON || event.value == 0) return; // how a button stands at the start is no push
    if (event.number == 1) stick.end = true;
    if (event.number == 2) stick.button = Button::record;
    if (event.number == 3) stick.button = Button::next;
}

} // namespace fettle
