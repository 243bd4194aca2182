#include "strategy/keys.h"

#include <unistd.h>

namespace fettle::strategy {
namespace {

/// An arrow key counts as held for this time, longer than the period of its repeats (30 per second are usual).
constexpr double kKeyHoldTime = 0.1;   // s
constexpr double kTimeRounding = 1e-9; // s, of sums
constexpr std::string_view kArrow = "\033[";

Eigen::Vector2d arrow_direction(char arrow)
{
    return {(arrow == 'C') - (arrow == 'D'), (arrow == 'A') - (arrow == 'B')};
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
    read_terminal(stick);
    if (time >= release_time_ - kTimeRounding) stick.direction.setZero();
    while (!input_.empty() && stick.button == Button::none && !stick.end) {
        const char key = input_[0];
        const bool escape = key == kArrow[0];
        if (escape && input_.size() < kArrow.size() + 1) return; // the rest of the sequence is still to come
        if ((key == 'r' || key == 'n' || key == 'q') && stick.direction.norm() > 0) return;
        if (key == ' ') stick.direction.setZero();
        if (key == 'u') stick.on_part = !stick.on_part;
        if (escape && input_.starts_with(kArrow)) {
            stick.direction = arrow_direction(input_[kArrow.size()]);
            release_time_ = time + kKeyHoldTime;
        }
        stick.button = key == 'r' ? Button::record : key == 'n' ? Button::next : Button::none;
        stick.end = key == 'q';
        input_.erase(0, escape ? kArrow.size() + 1 : 1);
    }
}

void Keys::read_terminal(Stick& stick)
{
    char buffer[64];
    ssize_t n = 0;
    while ((n = ::read(terminal_, buffer, sizeof buffer)) > 0) input_.append(buffer, n);
    if (n < 0) stick.end = true; // the terminal is gone
}

} // namespace fettle::strategy
