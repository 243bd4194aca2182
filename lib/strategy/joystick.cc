#include "strategy/joystick.h"

#include <array>
#include <cmath>

namespace fettle::strategy {
namespace {

constexpr double kFullDeflection = 32767; // value of an axis
/// A released stick does not return exactly to its centre.
constexpr double kDeadZone = 0.1; // of the full deflection
/// The buttons from kFirstButton on.
constexpr int kFirstButton = 2;
constexpr std::array kButtons = {Button::record, Button::next, Button::stop,      Button::start,     Button::automatic,
                                 Button::manual, Button::back, Button::turn_left, Button::turn_right};

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
    if (event.number >= kFirstButton && event.number < kFirstButton + int(kButtons.size()))
        stick.button = kButtons[event.number - kFirstButton];
}

} // namespace fettle::strategy
