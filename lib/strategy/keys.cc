#include "strategy/keys.h"

#include <unistd.h>

namespace fettle::strategy {
namespace {

/// An arrow key counts as held for this time, longer than the period of its repeats (30 per second are usual).
constexpr double kKeyHoldTime = 0.1;   // s
constexpr double kTimeRounding = 1e-9; // s, of sums
constexpr std::string_view kArrow = "\033[";
constexpr char kStop = ' ', kEnd = 'q';
constexpr std::string_view kStopOrEnd = " q";

Eigen::Vector2d arrow_direction(char arrow)
{
    return {(arrow == 'C') - (arrow == 'D'), (arrow == 'A') - (arrow == 'B')};
}

Button button_of(char key)
{
    switch (key) {
    case 'r':
        return Button::record;
    case 'n':
        return Button::next;
    case 'b':
    case '\b':
    case '\x7f':
        return Button::back;
    case '\n':
    case '\r':
        return Button::start;
    case kStop:
        return Button::stop;
    case 'a':
        return Button::automatic;
    case 'm':
        return Button::manual;
    case '[':
        return Button::turn_left;
    case ']':
        return Button::turn_right;
    default:
        return Button::none;
    }
}

} // namespace

Keys::Keys(int terminal) : terminal_(terminal)
{
    ::tcgetattr(terminal_, &saved_settings_);
    termios now = saved_settings_;
    now.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    now.c_cc[VMIN] = now.c_cc[VTIME] = 0; // a read does not wait
    ::tcsetattr(terminal_, TCSANOW, &now);
}

Keys::~Keys() { ::tcsetattr(terminal_, TCSANOW, &saved_settings_); }

void Keys::update(double time, Stick& stick)
{
    read_terminal();
    if (is_closed_) stick.end = true;
    if (time >= release_time_ - kTimeRounding) stick.direction.setZero();
    while (!input_.empty() && stick.button == Button::none && !stick.end) {
        const char key = input_[0];
        const bool escape = key == kArrow[0];
        if (escape && input_.size() < kArrow.size() + 1) return; // the rest of the sequence is still to come
        if (key == kStop) stick.direction.setZero();
        const Button button = button_of(key);
        if ((button != Button::none || key == kEnd) && stick.direction.norm() > 0) return;
        if (key == 'u') stick.on_part = !stick.on_part;
        if (escape && input_.starts_with(kArrow)) {
            stick.direction = arrow_direction(input_[kArrow.size()]);
            release_time_ = time + kKeyHoldTime;
        }
        stick.button = button;
        stick.end = key == kEnd;
        input_.erase(0, escape ? kArrow.size() + 1 : 1);
    }
}

bool Keys::has_stop()
{
    read_terminal();
    return is_closed_ || input_.find_first_of(kStopOrEnd) != std::string::npos;
}

void Keys::discard()
{
    read_terminal();
    const bool ends = input_.find(kEnd) != std::string::npos;
    input_.assign(ends ? 1 : 0, kEnd);
}

void Keys::read_terminal()
{
    char buffer[64];
    ssize_t n = 0;
    while ((n = ::read(terminal_, buffer, sizeof buffer)) > 0) input_.append(buffer, n);
    is_closed_ = is_closed_ || n < 0;
}

} // namespace fettle::strategy
